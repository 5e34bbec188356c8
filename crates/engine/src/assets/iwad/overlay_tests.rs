//! Files laid over an IWAD: what replaces what, PNGs, composed and animated textures.

use super::tests::{iwad, lumps, picture};
use super::{IwadError, png};
use crate::assets::{Assets, Image, sprite_index};
use crate::map::TextureName;
use crate::math::Rng;
use crate::mutation::{iterations, mutated};
use crate::wad::{self, Lump, WadKind};

/// A PNG of 8-bit samples; with `anchor`, sprite offsets as editors write them.
fn png_file(
    width: u32,
    height: u32,
    kind: ::png::ColorType,
    samples: &[u8],
    anchor: Option<[i32; 2]>,
) -> Vec<u8> {
    let mut out = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut out, width, height);
    encoder.set_color(kind);
    encoder.set_depth(::png::BitDepth::Eight);
    let mut writer = encoder.write_header().unwrap();
    if let Some(anchor) = anchor {
        let bytes: Vec<u8> = anchor.iter().flat_map(|side| side.to_be_bytes()).collect();
        writer.write_chunk(::png::chunk::ChunkType(*b"grAb"), &bytes).unwrap();
    }
    writer.write_image_data(samples).unwrap();
    writer.finish().unwrap();
    out
}

/// A grey PNG of 2 x 2.
fn grey(level: u8) -> Vec<u8> {
    png_file(2, 2, ::png::ColorType::Grayscale, &[level; 4], None)
}

fn addition() -> Vec<(&'static str, Vec<u8>)> {
    let textures = br#"
        WallTexture "COMPOSED", 3, 4 { Patch "BRICK", 1, 0 { FlipX FlipY } Patch "PNGWALL", 0, 2 }
        Texture TINTED, 2, 2 { Patch BRICK, 0, 0 { Blend "ff0000" } } // not drawn
        Texture UNWANTED, 4095, 4095 { Patch BRICK, 0, 0 }"#;
    let animations = b"texture FLASH pic FLASH tics 1.5 pic PNGWALL tics 2\nwarp2 flat LAVA1\n flat GRASS1 range GRASS3 tics 4";
    vec![
        (
            "MAPINFO",
            b"map MAP02 \"x\" { sky1 = \"NO\" } map MAP01 \"y\" { sky1 = \"WALL\", 0.5 }".to_vec(),
        ),
        ("TEXTURES", textures.to_vec()),
        ("ANIMDEFS", animations.to_vec()),
        ("PP_START", vec![]),
        ("BRICK", picture(2, 4, 0, 4, 90)),
        ("PP_END", vec![]),
        ("TX_START", vec![]),
        ("PNGWALL", grey(0)),
        ("FLASH", picture(2, 2, 0, 2, 70)),
        ("UNWANTED", b"neither of any format nor needed".to_vec()),
        ("TX_END", vec![]),
        ("FF_START", vec![]),
        ("LAVA2", grey(255)),
        ("GRASS1", grey(1)),
        ("GRASS2", grey(2)),
        ("GRASS3", grey(3)),
        ("F_END", vec![]),
        ("SS_START", vec![]),
        (
            "FTOPA0",
            png_file(1, 2, ::png::ColorType::Rgba, &[9, 9, 9, 255, 9, 9, 9, 127], Some([5, -6])),
        ),
        ("SS_END", vec![]),
        ("HI_START", vec![]),
        ("WALL", grey(0)),
    ]
}

fn pwad(lumps: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let lumps: Vec<Lump> =
        lumps.iter().map(|(name, bytes)| Lump { name: TextureName::new(name), bytes }).collect();
    wad::write(WadKind::Pwad, &lumps)
}

fn wanted(name: TextureName) -> bool {
    ["WALL", "COMPOSED", "TINTED", "FLASH", "LAVA1", "GRASS2"].contains(&name.as_str())
}

fn overlaid(addition: &[(&str, Vec<u8>)]) -> Result<Assets, IwadError> {
    Assets::from_wads(&iwad(&lumps()), &[&pwad(addition)], &wanted)
}

#[test]
fn what_lies_over_an_iwad_counts_before_it() {
    let set = overlaid(&addition()).unwrap();
    let entry = |name: &str| set.textures[&TextureName::new(name)];
    let image = |name: &str| -> &Image { &set.images[entry(name).first as usize] };
    // The IWAD's wall is built of the addition's brick.
    assert_eq!(image("WALL").pixels[..4], [90, 91, 92, 93]);
    // Greys are far from this palette's line of colours; whatever is nearest, it is no hole.
    let black = png_nearest(&set, [0; 3]);
    assert_eq!(image("PNGWALL").pixels.as_ref(), [black; 4]);
    // Column 0 shows the PNG alone, 1 and 2 the brick turned over both ways, the PNG over its lower
    // half in column 1.
    let composed = image("COMPOSED");
    assert_eq!((composed.width, composed.height), (3, 4));
    assert_eq!(composed.mask.as_ref().unwrap()[..4], [0, 0, 1, 1]);
    assert_eq!(composed.pixels[4..12], [94, 93, black, black, 93, 92, 91, 90]);
    assert!(
        !set.textures.contains_key(&TextureName::new("TINTED"))
            && !set.textures.contains_key(&TextureName::new("UNWANTED"))
    );
    // An animation of two lumps that do not lie in a row shows both.
    let flash = entry("FLASH");
    assert_eq!((flash.frames, flash.tics), (2, 1));
    assert_eq!(set.images[flash.first as usize].pixels[0], 70);
    assert_eq!(set.images[flash.first as usize + 1].pixels[0], black);
    // A wanted frame brings the others of its run along; one that is replaced takes its place in a
    // classic one.
    assert_eq!(
        (entry("GRASS1").frames, entry("GRASS1").tics, entry("GRASS3")),
        (3, 4, entry("GRASS1"))
    );
    assert_eq!((entry("LAVA1").frames, entry("LAVA1")), (4, entry("LAVA4")));
    let lava_2 = &set.images[entry("LAVA1").first as usize + 1];
    assert_eq!((lava_2.width, lava_2.pixels[0]), (2, png_nearest(&set, [255; 3])));
    // Sprites keep their anchor, and what is less than half opaque is a hole.
    let fire = set.sprites[usize::from(sprite_index("FTOP").unwrap())].frames[0].images[0];
    let fire = &set.images[fire as usize];
    assert_eq!((fire.offset_x, fire.offset_y, fire.mask.as_deref()), (5, -6, Some(&[1, 0][..])));
    assert_eq!(set.sky, Some(TextureName::new("WALL")));
    let left_out: Vec<&str> = set.left_out.iter().map(String::as_str).collect();
    assert_eq!(
        left_out,
        ["texture TINTED (Blend)", "the finer picture of WALL", "the ripples of LAVA1"]
    );
}

/// The palette entry but the first that lies nearest to a colour.
fn png_nearest(set: &Assets, colour: [u8; 3]) -> u8 {
    let distance = |index: u8| -> i32 {
        set.palette[usize::from(index)]
            .iter()
            .zip(colour)
            .map(|(&a, b)| (i32::from(a) - i32::from(b)).pow(2))
            .sum()
    };
    (1..=255).min_by_key(|&index| distance(index)).unwrap()
}

#[test]
fn an_addition_alone_is_no_picture_set() {
    assert_eq!(
        Assets::from_iwad(&pwad(&addition())).map(|_| ()),
        Err(IwadError::Missing { lump: "PLAYPAL" })
    );
}

#[test]
fn pngs_of_every_colour_type_are_read_and_absurd_ones_are_not() {
    use ::png::ColorType as C;
    for (kind, samples) in [(C::Grayscale, 1), (C::GrayscaleAlpha, 2), (C::Rgb, 3), (C::Rgba, 4)] {
        let mut all = addition();
        all.iter_mut().find(|(name, _)| *name == "PNGWALL").unwrap().1 =
            png_file(3, 1, kind, &vec![200; 3 * samples], None);
        assert!(overlaid(&all).is_ok(), "{kind:?}");
    }
    // A header that claims 2^31 columns.
    let mut all = addition();
    let wall = &mut all.iter_mut().find(|(name, _)| *name == "PNGWALL").unwrap().1;
    wall[16..20].copy_from_slice(&0x7fff_ffffu32.to_be_bytes());
    assert!(matches!(overlaid(&all), Err(IwadError::Picture { .. })));
    assert!(png::is_png(&grey(1)) && !png::is_png(b"PNG"));
}

#[test]
fn mutated_additions_never_panic() {
    let (base, bytes, mut rng) = (iwad(&lumps()), pwad(&addition()), Rng::new(0xA11));
    let mut read = 0;
    for _ in 0..iterations(1500) {
        let spoiled = mutated(&mut rng, &bytes);
        match Assets::from_wads(&base, &[&spoiled], &|name| name.as_str() != "UNWANTED") {
            Ok(_) => read += 1,
            Err(error) => assert!(!error.to_string().contains(char::is_control), "{error:?}"),
        }
    }
    assert!(read > 100, "the mutations must not all be caught: {read} read");
}
