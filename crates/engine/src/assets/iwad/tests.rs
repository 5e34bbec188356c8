use super::IwadError;
use crate::assets::{Assets, sprite_index};
use crate::map::TextureName;
use crate::math::Rng;
use crate::mutation::{iterations, mutated};
use crate::wad::{self, Lump, WadKind};

/// A picture of one opaque run a column, `rows` high, that begins `skip` rows down.
pub(super) fn picture(width: u16, height: u16, skip: u8, rows: u8, colour: u8) -> Vec<u8> {
    let mut out = Vec::new();
    for value in [width, height, 3, 7] {
        out.extend(value.to_le_bytes());
    }
    let first = 8 + 4 * u32::from(width);
    for column in 0..u32::from(width) {
        out.extend((first + column * (u32::from(rows) + 5)).to_le_bytes());
    }
    for column in 0..width {
        out.extend([skip, rows, 0]);
        out.extend((0..rows).map(|row| colour.wrapping_add(column as u8).wrapping_add(row)));
        out.extend([0, 255]);
    }
    out
}

/// A wall texture: name, width, height, and patches (x, y, number).
type Texture<'a> = (&'a str, u16, u16, &'a [(i16, i16, i16)]);

fn texture_list(textures: &[Texture<'_>]) -> Vec<u8> {
    let mut out = (textures.len() as u32).to_le_bytes().to_vec();
    let mut start = 4 + 4 * textures.len();
    for (_, _, _, patches) in textures {
        out.extend((start as u32).to_le_bytes());
        start += 22 + 10 * patches.len();
    }
    for (name, width, height, patches) in textures {
        out.extend(TextureName::new(name).0);
        out.extend([0; 4]);
        out.extend(width.to_le_bytes());
        out.extend(height.to_le_bytes());
        out.extend([0; 4]);
        out.extend((patches.len() as u16).to_le_bytes());
        for (x, y, patch) in *patches {
            for value in [*x, *y, *patch, 1, 0] {
                out.extend(value.to_le_bytes());
            }
        }
    }
    out
}

/// The lumps of a very small IWAD with one of everything.
pub(super) fn lumps() -> Vec<(&'static str, Vec<u8>)> {
    let palette: Vec<u8> = (0..256).flat_map(|i| [i as u8, 255 - i as u8, 7]).collect();
    let light: Vec<u8> = (0..34 * 256).map(|i| (i / 256) as u8 ^ (i % 256) as u8).collect();
    let mut patch_names = 3u32.to_le_bytes().to_vec();
    for name in ["BRICK", "MISSING", "bars"] {
        patch_names.extend(TextureName::new(name).0);
    }
    let textures: [Texture<'_>; 3] = [
        ("WALL", 4, 4, &[(0, 0, 0), (2, 0, 0), (3, -1, 2)]),
        ("FENCE", 4, 4, &[(1, 1, 2)]),
        ("HOLES", 2, 2, &[(0, 0, 1), (0, 0, -1)]),
    ];
    let flat =
        |colour: u8| (0..4096).map(|i| if i == 64 { 9 } else { colour }).collect::<Vec<u8>>();
    vec![
        ("PLAYPAL", palette),
        ("COLORMAP", light),
        ("PNAMES", patch_names),
        ("TEXTURE1", texture_list(&textures)),
        ("STBAR", picture(8, 3, 0, 3, 20)),
        ("STFST00", picture(2, 2, 0, 2, 30)),
        ("P_START", vec![]),
        ("BRICK", picture(2, 4, 0, 4, 40)),
        ("BARS", picture(1, 4, 1, 2, 50)),
        ("P_END", vec![]),
        ("F_START", vec![]),
        ("LAVA1", flat(1)),
        ("LAVA2", flat(2)),
        ("LAVA3", flat(3)),
        ("LAVA4", flat(4)),
        ("F_END", vec![]),
        ("S_START", vec![]),
        ("BON1A0", picture(3, 3, 0, 3, 60)),
        ("POSSA1", picture(3, 3, 0, 3, 61)),
        ("POSSA2A8", picture(3, 3, 0, 3, 62)),
        ("POSSB5", picture(3, 3, 0, 3, 63)),
        ("XYZZA0", b"no picture".to_vec()),
        ("S_END", vec![]),
    ]
}

pub(super) fn iwad(lumps: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let lumps: Vec<Lump> =
        lumps.iter().map(|(name, bytes)| Lump { name: TextureName::new(name), bytes }).collect();
    wad::write(WadKind::Iwad, &lumps)
}

#[test]
fn a_small_iwad_is_read_in_all_its_parts() {
    let set = Assets::from_iwad(&iwad(&lumps())).unwrap();
    assert_eq!((set.palette[5], set.light_tables[3][8]), ([5, 250, 7], 3 ^ 8));
    let texture = |name: &str| set.textures[&TextureName::new(name)];
    let image = |name: &str| &set.images[texture(name).first as usize];

    let wall = image("WALL");
    assert_eq!((wall.width, wall.height, wall.mask.is_none()), (4, 4, true));
    // Column 2 is the second brick's first; the bar, a row up, covers column 3 in part.
    assert_eq!(&wall.pixels[8..16], [40, 41, 42, 43, 50, 51, 43, 44]);
    let fence = image("FENCE");
    assert_eq!(&fence.pixels[4..8], [0, 0, 50, 51]);
    assert_eq!(fence.mask.as_ref().unwrap()[4..8], [0, 0, 1, 1]);
    assert!(image("HOLES").mask.as_ref().unwrap().iter().all(|&opaque| opaque == 0));

    // Flats are stored by rows: the odd pixel is the first of row 1.
    assert_eq!(
        (image("LAVA1").pixels[0], image("LAVA1").pixels[1], image("LAVA1").pixels[64]),
        (1, 9, 1)
    );
    let lava = texture("LAVA3");
    assert_eq!((lava, lava.frames), (texture("LAVA1"), 4));
    assert_eq!(set.images[lava.first as usize + 3].pixels[0], 4);

    let sprite = |name: &str| &set.sprites[usize::from(sprite_index(name).unwrap())];
    let bonus = sprite("BON1").frames[0];
    assert!(
        bonus.images.iter().all(|&image| image == bonus.images[0]) && bonus.mirrored == [false; 8]
    );
    let anchor = &set.images[bonus.images[0] as usize];
    assert_eq!((anchor.offset_x, anchor.offset_y, anchor.mask.is_none()), (3, 7, true));
    let zombie = sprite("POSS");
    assert_eq!(zombie.frames[0].images[1], zombie.frames[0].images[7]);
    assert_eq!(zombie.frames[0].mirrored, [false, false, false, false, false, false, false, true]);
    assert_eq!((zombie.frames[0].images[2], zombie.frames[1].images[0]), (u32::MAX, u32::MAX));
    assert_eq!(set.images[zombie.frames[1].images[4] as usize].pixels[0], 63);
    // What is missing comes from the embedded set, in this palette's colours.
    let embedded = Assets::embedded();
    let index = usize::from(sprite_index("PIST").unwrap());
    let (own, original) =
        (set.sprites[index].frames[0].images[0], embedded.sprites[index].frames[0].images[0]);
    let (own, original) = (&set.images[own as usize], &embedded.images[original as usize]);
    assert_eq!(
        (own.width, own.height, &own.mask),
        (original.width, original.height, &original.mask)
    );
    let middle = own.pixels.len() / 2;
    let distance = |colour: [u8; 3]| -> i32 {
        let wanted = embedded.palette[usize::from(original.pixels[middle])];
        colour.iter().zip(wanted).map(|(&a, b)| (i32::from(a) - i32::from(b)).pow(2)).sum()
    };
    let found = distance(set.palette[usize::from(own.pixels[middle])]);
    assert!(set.palette.iter().all(|&colour| distance(colour) >= found));

    assert_eq!(set.images[set.graphics[&TextureName::new("STBAR")] as usize].width, 8);
    assert!(!set.fallbacks.is_empty());
}

#[test]
fn tall_pictures_count_on_from_the_run_before() {
    let mut bytes = Vec::new();
    for value in [1u16, 500, 0, 0] {
        bytes.extend(value.to_le_bytes());
    }
    bytes.extend(12u32.to_le_bytes());
    bytes.extend([250, 1, 0, 5, 0, 200, 1, 0, 6, 0, 255]);
    let mut all = lumps();
    all.push(("STBAR", bytes));
    let set = Assets::from_iwad(&iwad(&all)).unwrap();
    let image = &set.images[set.graphics[&TextureName::new("STBAR")] as usize];
    assert_eq!((image.pixels[250], image.pixels[450]), (5, 6));
    assert_eq!(image.mask.as_ref().unwrap().iter().filter(|&&opaque| opaque == 1).count(), 2);
}

#[test]
fn what_is_missing_or_broken_is_named() {
    let spoiled = |name: &str, change: &dyn Fn(&mut Vec<u8>)| {
        let mut all = lumps();
        change(&mut all.iter_mut().find(|(other, _)| *other == name).unwrap().1);
        Assets::from_iwad(&iwad(&all)).map(|_| ()).unwrap_err()
    };
    let name = TextureName::new;
    for lump in ["PLAYPAL", "COLORMAP", "PNAMES", "TEXTURE1"] {
        let mut all = lumps();
        all.retain(|(other, _)| *other != lump);
        assert_eq!(Assets::from_iwad(&iwad(&all)).map(|_| ()), Err(IwadError::Missing { lump }));
        assert!(matches!(
            spoiled(lump, &|bytes| bytes.truncate(3)),
            IwadError::TooShort { length: 3, .. }
        ));
    }
    let large =
        |at: usize| move |bytes: &mut Vec<u8>| bytes[at..at + 2].copy_from_slice(&[0xff, 0x7f]);
    let broken = |lump: &str, change: &dyn Fn(&mut Vec<u8>)| match spoiled(lump, change) {
        IwadError::Picture { lump, .. } => lump,
        other => panic!("{lump}: {other}"),
    };
    assert_eq!(broken("PNAMES", &large(2)), name("PNAMES"));
    assert_eq!(broken("TEXTURE1", &large(2)), name("TEXTURE1"));
    assert_eq!(broken("TEXTURE1", &large(4)), name("TEXTURE1"));
    assert_eq!(broken("TEXTURE1", &large(16 + 12)), name("WALL"));
    assert_eq!(broken("TEXTURE1", &large(16 + 20)), name("WALL"));
    assert_eq!(broken("BRICK", &large(0)), name("BRICK"));
    assert_eq!(broken("BRICK", &large(8)), name("BRICK"));
    assert_eq!(broken("BRICK", &|bytes| bytes.truncate(30)), name("BRICK"));
    assert_eq!(
        broken("BON1A0", &|bytes| bytes.splice(..4, *b"\x89PNG").for_each(drop)),
        name("BON1A0"),
        "a broken PNG"
    );
    assert!(matches!(
        spoiled("LAVA2", &|bytes| bytes.truncate(4095)),
        IwadError::TooShort { length: 4095, .. }
    ));
    assert!(matches!(Assets::from_iwad(b"nothing"), Err(IwadError::Wad(_))));
}

/// A texture as large as they come, many times over.
#[test]
fn hostile_sizes_are_refused_before_memory_is_gone() {
    let patches = [(0, 0, 0); 4];
    let many: Vec<Texture<'_>> = vec![("HUGE", 4096, 4096, &patches); 40];
    let mut all = lumps();
    all.iter_mut().find(|(name, _)| *name == "TEXTURE1").unwrap().1 = texture_list(&many);
    assert_eq!(Assets::from_iwad(&iwad(&all)).map(|_| ()), Err(IwadError::TooLarge));

    let patches = vec![(0, 0, 0); 60_000];
    let mut all = lumps();
    all.iter_mut().find(|(name, _)| *name == "TEXTURE1").unwrap().1 =
        texture_list(&[("SLOW", 4096, 256, &patches)]);
    all.iter_mut().find(|(name, _)| *name == "BRICK").unwrap().1 = picture(2048, 250, 0, 250, 0);
    assert_eq!(Assets::from_iwad(&iwad(&all)).map(|_| ()), Err(IwadError::TooLarge));
}

#[test]
fn mutated_iwads_never_panic() {
    // Palette and light tables are most of the bytes and hold nothing to trip over.
    let (bytes, mut rng) = (iwad(&lumps()), Rng::new(0xF2));
    let tables = 768 + 34 * 256;
    let mut read = 0;
    for _ in 0..iterations(400) {
        let (head, tail) = bytes.split_at(12 + tables);
        let mut spoiled = head.to_vec();
        spoiled.extend(mutated(&mut rng, tail));
        read += u32::from(Assets::from_iwad(&spoiled).is_ok());
    }
    assert!(read > 5, "the mutations must not all be caught: {read} read");
}

/// Run with `cargo test --release -p hasard-engine freedoom -- --ignored` where Debian's package is
/// installed.
#[test]
#[ignore = "needs Debian's package `freedoom`"]
fn freedoom_is_read() {
    for file in ["freedoom1.wad", "freedoom2.wad"] {
        let bytes = std::fs::read(format!("/usr/share/games/doom/{file}"))
            .expect("the package is installed");
        let started = std::time::Instant::now();
        let set = Assets::from_iwad(&bytes).unwrap_or_else(|error| panic!("{file}: {error}"));
        let pixels: usize = set.images.iter().map(|image| image.pixels.len()).sum();
        println!("{file}: {} pictures, {pixels} pixels, {:?}", set.images.len(), started.elapsed());
        for name in ["LAVA1", "FLAT5", "BIGBRIK1", "MIDBARS3", "SKY1"] {
            assert!(set.textures.contains_key(&TextureName::new(name)), "{file}: {name}");
        }
        assert_eq!(set.textures[&TextureName::new("NUKAGE2")].frames, 3);
        for (name, sprite) in crate::assets::SPRITE_NAMES.iter().zip(&set.sprites) {
            assert!(!sprite.frames.is_empty(), "{file}: {name}");
        }
        for name in [
            "STBAR", "STARMS", "STTNUM0", "STTPRCNT", "STGNUM2", "STYSNUM9", "STFST00", "STFDEAD0",
            "STKEYS0",
        ] {
            assert!(set.graphics.contains_key(&TextureName::new(name)), "{file}: {name}");
        }
    }
}
