//! Level files: a map with the pictures that it brings, laid over an IWAD.

use super::{Target, assert_presentable, maps, pictures};
use hasard_engine::assets::Assets;
use hasard_engine::map::{TextureName, udmf};
use hasard_engine::wad::{self, Lump, Wad, WadKind};

/// Level files as `--maps` reads them.
pub const LEVEL: Target = Target {
    name: "level",
    samples: || vec![sample()],
    words: &[
        "TX_START",
        "FF_START",
        "HI_START",
        "PP_START",
        "SS_START",
        "TX_END",
        "F_END",
        "TEXTURES",
        "ANIMDEFS",
        "MAPINFO",
        "Texture \"WALL\", 9, 9 {",
        "Patch BRICK, 1, -1 {",
        "FlipX",
        "texture WALL pic FENCE tics 1",
        "flat LAVA1 range LAVA2 tics 9",
        "warp2 flat LAVA1",
        "PNG",
        "IHDR",
        "IDAT",
        "PLTE",
        "tRNS",
        "grAb",
        "IEND",
    ],
    repair: checksums,
    run,
    // What the loader's own budget allows, with the embedded set and a PNG on the way.
    memory: 448 << 20,
};

fn run(bytes: &[u8]) -> bool {
    let wad = match Wad::read(bytes) {
        Ok(wad) => wad,
        Err(error) => {
            assert_presentable(&error.to_string());
            return false;
        }
    };
    let text = wad.map_text("MAP01");
    let played = text.as_ref().is_ok_and(|text| maps::read_text(text));
    let source = text.ok().and_then(|text| udmf::read(text).ok());
    if let Some(source) = &source {
        assert!(
            source.left_out().iter().all(|part| part.len() < 2000),
            "a part of the line without bound"
        );
    }
    let textures = source.map(|source| source.textures());
    let wanted =
        |name: TextureName| textures.as_ref().is_none_or(|textures| textures.contains(&name));
    match Assets::from_wads(&pictures::sample(), &[bytes], &wanted) {
        Ok(set) => {
            pictures::use_pictures(&set);
            set.left_out.iter().for_each(|part| assert_presentable(part));
            played
        }
        Err(error) => {
            assert_presentable(&error.to_string());
            false
        }
    }
}

/// A small map that brings one picture of each kind.
fn sample() -> Vec<u8> {
    let map = wad::write_map("MAP01", &maps::room());
    let map = Wad::read(&map).expect("our own writing");
    let textures = b"WallTexture STEP, 4, 4 { Patch BRICK, 0, 0 { FlipX } Patch STONE, 2, 1 }";
    let animations =
        b"texture STONE pic STONE tics 2 pic BRICK2 tics 2 flat FLAT5 range FLAT6 tics 3";
    let more: [(&str, &[u8]); 14] = [
        ("TEXTURES", textures),
        ("ANIMDEFS", animations),
        ("MAPINFO", b"map MAP01 \"a\" { sky1 = \"STONE\" }"),
        ("TX_START", b""),
        ("STONE", &PICTURE),
        ("BRICK2", &PICTURE),
        ("TX_END", b""),
        ("FF_START", b""),
        ("FLAT5", &PICTURE),
        ("FLAT6", &[7; 4096]),
        ("F_END", b""),
        ("SS_START", b""),
        ("FTOPA0", &PICTURE),
        ("SS_END", b""),
    ];
    let more = more.into_iter().map(|(name, bytes)| Lump { name: TextureName::new(name), bytes });
    let lumps: Vec<Lump<'_>> = map.lumps.iter().copied().chain(more).collect();
    wad::write(WadKind::Pwad, &lumps)
}

/// A PNG of 4 x 4 with alpha and an anchor.
const PICTURE: [u8; 132] = [
    137, 80, 78, 71, 13, 10, 26, 10, 0, 0, 0, 13, 73, 72, 68, 82, 0, 0, 0, 4, 0, 0, 0, 4, 8, 6, 0,
    0, 0, 169, 241, 158, 126, 0, 0, 0, 8, 103, 114, 65, 98, 0, 0, 0, 2, 255, 255, 255, 253, 200,
    201, 127, 201, 0, 0, 0, 55, 73, 68, 65, 84, 120, 156, 21, 139, 65, 17, 0, 49, 16, 194, 34, 167,
    34, 42, 98, 229, 32, 108, 69, 224, 170, 151, 123, 100, 96, 50, 0, 148, 75, 95, 100, 237, 112,
    250, 174, 228, 148, 53, 97, 20, 83, 98, 238, 252, 34, 94, 226, 66, 214, 254, 1, 232, 28, 31,
    215, 238, 55, 14, 215, 0, 0, 0, 0, 73, 69, 78, 68, 174, 66, 96, 130,
];

/// Makes the checksums of every PNG's chunks fit again.
fn checksums(mut bytes: Vec<u8>) -> Vec<u8> {
    let mut at = 0;
    while let Some(start) =
        bytes.get(at..).and_then(|rest| rest.windows(4).position(|four| four == b"\x89PNG"))
    {
        at += start + 8;
        while let Some(length) = bytes
            .get(at..at + 4)
            .map(|four| u32::from_be_bytes([four[0], four[1], four[2], four[3]]) as usize)
        {
            let Some(end) = at
                .checked_add(8)
                .and_then(|from| from.checked_add(length))
                .filter(|end| end + 4 <= bytes.len())
            else {
                break;
            };
            let mut sum = flate2::Crc::new();
            sum.update(&bytes[at + 4..end]);
            bytes[end..end + 4].copy_from_slice(&sum.sum().to_be_bytes());
            at = end + 4;
            if bytes[end - length - 4..].starts_with(b"IEND") {
                break;
            }
        }
    }
    bytes
}
