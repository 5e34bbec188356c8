//! Picture sets: IWADs.

use super::{Target, assert_presentable, nothing_to_repair};
use hasard_engine::assets::{Assets, Image};
use hasard_engine::map::TextureName;
use hasard_engine::wad::{self, Lump, WadKind};

/// Picture sets.
pub const IWAD: Target = Target {
    name: "iwad",
    samples: || vec![sample()],
    words: &[
        "F_START", "F_END", "S_START", "S_END", "P_START", "P_END", "PNAMES", "TEXTURE1",
        "TEXTURE2", "PLAYPAL", "COLORMAP", "POSSA1D1", "TROOA1", "STBAR", "SKY1", "LAVA1",
    ],
    repair: nothing_to_repair,
    run: |bytes| match Assets::from_iwad(bytes) {
        Ok(set) => {
            use_pictures(&set);
            true
        }
        Err(error) => {
            assert_presentable(&error.to_string());
            false
        }
    },
    // What the loader's own budget allows: 2^27 pixels with their masks, and the embedded set.
    memory: 320 << 20,
};

pub(super) fn use_pictures(set: &Assets) {
    let sound = |image: &Image| {
        let size = usize::from(image.width) * usize::from(image.height);
        image.pixels.len() == size && image.mask.as_ref().is_none_or(|mask| mask.len() == size)
    };
    assert!(set.images.iter().all(sound), "a picture has not the pixels of its size");
    let count = set.images.len() as u32;
    let exists = |first: u32, frames: u8| {
        first.checked_add(u32::from(frames)).is_some_and(|end| end <= count)
    };
    assert!(
        set.textures
            .values()
            .chain(&set.fallbacks)
            .all(|entry| exists(entry.first, entry.frames) && entry.frames > 0)
    );
    assert!(set.textures.values().all(|entry| entry.tics > 0), "an animation without time");
    assert!(set.graphics.values().all(|&image| image < count), "a graphic that does not exist");
    let frames = set.sprites.iter().flat_map(|sprite| &sprite.frames);
    assert!(
        frames.flat_map(|frame| frame.images).all(|image| image < count || image == u32::MAX),
        "a sprite that does not exist"
    );
}

/// The bytes of a picture, each column one run of `rows` opaque pixels.
fn picture(width: u16, rows: u8) -> Vec<u8> {
    let mut out: Vec<u8> =
        [width, u16::from(rows) + 1, 3, 7].into_iter().flat_map(u16::to_le_bytes).collect();
    let first = 8 + 4 * u32::from(width);
    out.extend(
        (0..u32::from(width))
            .flat_map(|column| (first + column * (u32::from(rows) + 5)).to_le_bytes()),
    );
    for column in 0..width {
        out.extend([1, rows, 0]);
        out.extend((0..rows).map(|row| row.wrapping_add(column as u8)));
        out.extend([0, 255]);
    }
    out
}

/// A list of two wall textures, one of two patches.
fn texture_list() -> Vec<u8> {
    let mut out: Vec<u8> =
        [2u32, 12, 12 + 22 + 20].into_iter().flat_map(u32::to_le_bytes).collect();
    for (name, patches) in [("WALL", &[[0i16, 0, 0], [2, -1, 1]][..]), ("FENCE", &[[1, 1, 1]])] {
        out.extend(TextureName::new(name).0);
        out.extend([0; 4]);
        out.extend([4u16, 4, 0, 0, patches.len() as u16].into_iter().flat_map(u16::to_le_bytes));
        for &[x, y, patch] in patches {
            out.extend([x, y, patch, 1, 0].into_iter().flat_map(i16::to_le_bytes));
        }
    }
    out
}

/// A very small IWAD with one of everything.
pub(super) fn sample() -> Vec<u8> {
    let mut patch_names = 2u32.to_le_bytes().to_vec();
    patch_names.extend(["BRICK", "BARS"].into_iter().flat_map(|name| TextureName::new(name).0));
    let lumps: [(&str, Vec<u8>); 18] = [
        ("PLAYPAL", (0..768).map(|i| i as u8).collect()),
        ("COLORMAP", (0..32 * 256).map(|i| (i / 256) as u8 ^ i as u8).collect()),
        ("PNAMES", patch_names),
        ("TEXTURE1", texture_list()),
        ("STBAR", picture(8, 3)),
        ("P_START", vec![]),
        ("BRICK", picture(2, 4)),
        ("BARS", picture(1, 2)),
        ("P_END", vec![]),
        ("F_START", vec![]),
        ("LAVA1", vec![1; 4096]),
        ("LAVA2", vec![2; 4096]),
        ("F_END", vec![]),
        ("S_START", vec![]),
        ("BON1A0", picture(3, 3)),
        ("POSSA2A8", picture(3, 3)),
        ("POSSB5", picture(3, 3)),
        ("S_END", vec![]),
    ];
    let lumps: Vec<Lump<'_>> =
        lumps.iter().map(|(name, bytes)| Lump { name: TextureName::new(name), bytes }).collect();
    wad::write(WadKind::Iwad, &lumps)
}
