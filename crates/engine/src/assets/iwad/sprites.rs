//! Sprites: lumps whose names give frame and rotation, some for a second rotation mirrored.

use super::reader::Reader;
use super::{IwadError, Sections, push};
use crate::assets::{Assets, SPRITE_NAMES, Sprite, SpriteFrame};

/// Most frames of a sprite: the letters from `A` to `]`.
const FRAME_LIMIT: usize = 29;

/// A frame without pictures.
const EMPTY: SpriteFrame = SpriteFrame { images: [u32::MAX; 8], mirrored: [false; 8] };

/// Adds the sprites of [`SPRITE_NAMES`].
pub(super) fn load(
    set: &mut Assets,
    sections: &Sections<'_>,
    reader: &mut Reader,
) -> Result<(), IwadError> {
    let mut sprites = vec![Sprite::default(); SPRITE_NAMES.len()];
    for lump in &sections.sprites {
        let name = lump.name.as_str();
        let wanted =
            name.get(..4).and_then(|name| SPRITE_NAMES.iter().position(|&other| other == name));
        let Some(sprite) = wanted else { continue };
        let views: Vec<(usize, u8)> =
            name.as_bytes()[4..].chunks_exact(2).filter_map(view).collect();
        if views.is_empty() {
            continue;
        }
        let image = reader.picture(lump)?;
        let index = push(set, image);
        for (i, &(frame, rotation)) in views.iter().enumerate() {
            let frames = &mut sprites[sprite].frames;
            if frames.len() <= frame {
                frames.resize(frame + 1, EMPTY);
            }
            let frame = &mut frames[frame];
            let sides =
                if rotation == 0 { 0..8 } else { usize::from(rotation) - 1..usize::from(rotation) };
            for side in sides {
                frame.images[side] = index;
                frame.mirrored[side] = i > 0;
            }
        }
    }
    set.sprites = sprites;
    Ok(())
}

/// The frame and rotation that two characters of a name give; rotation 0 is every side.
fn view(pair: &[u8]) -> Option<(usize, u8)> {
    let frame = usize::from(pair[0].checked_sub(b'A')?);
    let rotation = pair[1].checked_sub(b'0')?;
    (frame < FRAME_LIMIT && rotation <= 8).then_some((frame, rotation))
}
