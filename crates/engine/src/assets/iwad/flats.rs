//! Flats: raw squares of 64 x 64 for floors and ceilings, or pictures of any size.

use super::reader::Reader;
use super::{IwadError, Sections, Wanted, png, push, still};
use crate::assets::{Assets, Image};
use crate::map::TextureName;

/// Side of a flat.
const SIDE: usize = 64;

/// Adds every flat and gives their names in file order, for animations.
pub(super) fn load(
    set: &mut Assets,
    sections: &Sections<'_>,
    wanted: Wanted<'_>,
    reader: &mut Reader,
) -> Result<Vec<TextureName>, IwadError> {
    let mut names = Vec::new();
    for lump in &sections.flats {
        if png::is_png(lump.bytes) {
            if wanted(lump.name) {
                let image = reader.picture(lump)?;
                let index = push(set, Image { offset_x: 0, offset_y: 0, ..image });
                set.textures.insert(lump.name, still(index));
                names.push(lump.name);
            }
            continue;
        }
        if lump.bytes.len() < SIDE * SIDE {
            return Err(IwadError::TooShort {
                lump: lump.name,
                least: SIDE * SIDE,
                length: lump.bytes.len(),
            });
        }
        reader.budget.keep(SIDE * SIDE)?;
        // Stored row by row.
        let pixels = (0..SIDE * SIDE).map(|i| lump.bytes[i % SIDE * SIDE + i / SIDE]).collect();
        let side = SIDE as u16;
        let index = push(
            set,
            Image { width: side, height: side, offset_x: 0, offset_y: 0, pixels, mask: None },
        );
        set.textures.insert(lump.name, still(index));
        names.push(lump.name);
    }
    Ok(names)
}
