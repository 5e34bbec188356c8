//! The project's own picture set, painted by code when the program starts.
//!
//! | file | what it holds |
//! |---|---|
//! | `palette`, `colour` | the 256 colours, the light tables, true colours and their rounding to the palette |
//! | `noise`, `surface` | tileable noise; surfaces with relief that are lit, tinted and tiled |
//! | `canvas`, `model`, `camera`, `solid`, `vector` | two-dimensional painting; small solid models turned into sprites from eight sides |
//! | `textures`, `sky` | walls, floors, fences, liquids, skies |
//! | `sprites`, `hud` | things of the world; status bar, digits, faces, letters |
//! | `gallery` | where the finished pictures are collected |
//!
//! Nothing is random from run to run and nothing depends on the platform's mathematical library, so
//! the pictures, and every observation made of them, are the same bits everywhere.

mod camera;
mod canvas;
mod colour;
mod gallery;
mod hud;
mod model;
mod noise;
mod palette;
mod sky;
mod solid;
mod sprites;
mod surface;
mod textures;
mod vector;

use super::Assets;
use gallery::Gallery;
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

impl Assets {
    /// The project's own pictures: painted at the first call, shared ever after.
    #[must_use]
    pub fn embedded() -> Arc<Assets> {
        static EMBEDDED: OnceLock<Arc<Assets>> = OnceLock::new();
        EMBEDDED.get_or_init(|| Arc::new(paint())).clone()
    }
}

fn paint() -> Assets {
    let palette = palette::colours();
    let mut gallery = Gallery::new(Assets {
        light_tables: palette::light_tables(&palette),
        palette,
        images: Vec::new(),
        textures: BTreeMap::new(),
        fallbacks: Vec::new(),
        sprites: Vec::new(),
        graphics: BTreeMap::new(),
        sky: None,
        soot: None,
        left_out: std::collections::BTreeSet::new(),
    });
    textures::paint(&mut gallery);
    sky::paint(&mut gallery);
    sprites::paint(&mut gallery);
    hud::paint(&mut gallery);
    gallery.assets
}

#[cfg(test)]
mod tests {
    use super::super::{Assets, Image, SPRITE_NAMES, sprite_index};

    #[test]
    fn every_image_is_whole_and_every_reference_leads_to_one() {
        let assets = Assets::embedded();
        for image in &assets.images {
            let size = image.width as usize * image.height as usize;
            assert!(size > 0 && image.pixels.len() == size);
            assert!(image.mask.as_ref().is_none_or(|mask| mask.len() == size && mask.contains(&1)));
        }
        for (name, entry) in &assets.textures {
            assert!(entry.frames > 0 && entry.tics > 0, "{name:?}");
            assert!(
                entry.first as usize + entry.frames as usize <= assets.images.len(),
                "{name:?}"
            );
        }
        assert!(assets.graphics.values().all(|&index| (index as usize) < assets.images.len()));
    }

    #[test]
    fn surfaces_have_the_mean_colours_of_the_specification() {
        let assets = Assets::embedded();
        let cases = [
            ("LAVA1", [112, 35, 7]),
            ("FLOOR0_5", [97, 97, 97]),
            ("AQF052", [83, 83, 83]),
            ("A-BROK28", [120, 97, 77]),
            ("FLAT5_5", [87, 67, 50]),
            ("FLAT5", [108, 72, 39]),
            ("SLIME16", [111, 88, 67]),
            ("AQRUST07", [70, 61, 50]),
            ("BSTONE3", [92, 69, 40]),
            ("CRATOP2", [113, 90, 61]),
            ("STONE5", [89, 89, 89]),
            ("RROCK15", [72, 53, 30]),
            ("BIGBRIK1", [49, 30, 15]),
            ("A-MUD", [72, 54, 36]),
            ("ZIMMER3", [54, 39, 21]),
            ("GRASS1", [48, 56, 31]),
            ("RROCK20", [67, 74, 47]),
            ("STARGR2", [84, 84, 83]),
        ];
        for (name, expected) in cases {
            let image: &Image =
                &assets.images[assets.texture(crate::map::TextureName::new(name)).first as usize];
            for (channel, expected) in expected.into_iter().enumerate() {
                let sum: i32 = image
                    .pixels
                    .iter()
                    .map(|&p| i32::from(assets.palette[p as usize][channel]))
                    .sum();
                let mean = sum / image.pixels.len() as i32;
                assert!(
                    (mean - expected).abs() <= 7,
                    "{name}: channel {channel} is {mean}, not {expected}"
                );
            }
        }
    }

    #[test]
    fn every_sprite_has_the_frames_that_things_show_and_all_eight_sides() {
        let assets = Assets::embedded();
        let counts = [
            ("POSS", 12),
            ("SPOS", 12),
            ("CPOS", 14),
            ("TROO", 13),
            ("SARG", 14),
            ("SKEL", 17),
            ("SKUL", 11),
        ];
        let more = [
            ("HEAD", 12),
            ("PLAY", 23),
            ("BEXP", 5),
            ("MISL", 4),
            ("PUFF", 4),
            ("PISG", 3),
            ("SHT2", 10),
            ("MISF", 4),
            ("RSMK", 5),
        ];
        for (name, sprite) in SPRITE_NAMES.iter().zip(&assets.sprites) {
            let listed = counts.iter().chain(&more).find(|(known, _)| known == name);
            let expected = listed.map_or(1, |&(_, count)| count);
            assert!(
                sprite.frames.len() >= expected,
                "{name} has {} of {expected} frames",
                sprite.frames.len()
            );
            for frame in &sprite.frames {
                assert!(
                    frame.images.iter().all(|&image| (image as usize) < assets.images.len()),
                    "{name}"
                );
            }
        }
        assert_eq!(assets.sprites.len(), SPRITE_NAMES.len());
    }

    #[test]
    fn a_creature_looks_different_from_every_side_and_a_left_side_is_the_mirrored_right_side() {
        let assets = Assets::embedded();
        for name in ["POSS", "TROO", "SARG", "SKEL", "HEAD"] {
            let frame = assets.sprites[sprite_index(name).unwrap() as usize].frames[0];
            for side in 0..5 {
                for other in side + 1..5 {
                    let picture = |side: usize| &assets.images[frame.images[side] as usize];
                    assert_ne!(
                        picture(side).pixels,
                        picture(other).pixels,
                        "{name}: sides {side} and {other}"
                    );
                }
            }
            for side in 1..4 {
                assert_eq!(frame.images[side], frame.images[8 - side]);
                assert!(!frame.mirrored[side] && frame.mirrored[8 - side]);
            }
        }
    }

    #[test]
    fn unknown_texture_names_get_a_lasting_stand_in() {
        let assets = Assets::embedded();
        let unknown = |name| assets.texture(crate::map::TextureName::new(name));
        assert_eq!(unknown("NOSUCH1"), unknown("NOSUCH1"));
        assert!((unknown("NOSUCH1").first as usize) < assets.images.len());
        assert!(assets.fallbacks.len() > 1);
    }

    #[test]
    fn light_tables_darken_step_by_step_and_the_first_changes_nothing() {
        let assets = Assets::embedded();
        let brightness = |table: usize| -> i32 {
            assets.light_tables[table]
                .iter()
                .flat_map(|&p| assets.palette[p as usize])
                .map(i32::from)
                .sum()
        };
        assert!((0..256).all(|i| assets.light_tables[0][i] == i as u8));
        let full = brightness(0);
        for table in 1..32 {
            let expected = full * (32 - table as i32) / 32;
            let off = (brightness(table) - expected).abs();
            assert!(off < full / 30, "table {table} is off by {off} of {full}");
        }
    }
}
