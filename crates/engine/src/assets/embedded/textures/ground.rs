//! Natural ground: rock, grass, earth.

use crate::assets::embedded::colour::{Colour, gradient};
use crate::assets::embedded::gallery::Gallery;
use crate::assets::embedded::noise::{Cells, Field, unit};
use crate::assets::embedded::surface::Surface;

/// Paints the grounds.
pub(super) fn paint(gallery: &mut Gallery) {
    gallery.surface("STONE5", &cracked(128, 5, 111).with_mean(Colour(89.0, 89.0, 89.0)));
    gallery.surface("GRASS1", &grass(121).with_mean(Colour(48.0, 56.0, 31.0)));
    gallery.surface("RROCK20", &grass(131).with_mean(Colour(67.0, 74.0, 47.0)));
    gallery.surface("RROCK15", &cracked(64, 6, 141).with_mean(Colour(72.0, 53.0, 30.0)));
    gallery.surface("A-MUD", &cracked(64, 4, 145).with_mean(Colour(72.0, 54.0, 36.0)));
    gallery.surface("AQF018", &earth(64, 149, 0.2).with_mean(Colour(97.0, 73.0, 37.0)));
    gallery.surface("FLAT10", &earth(64, 153, 0.5).with_mean(Colour(46.0, 29.0, 13.0)));
    gallery.surface("RROCK17", &earth(64, 157, 0.8).with_mean(Colour(47.0, 36.0, 19.0)));
    gallery.surface("RROCK18", &earth(64, 161, 1.0).with_mean(Colour(57.0, 44.0, 25.0)));
    gallery.surface("RROCK19", &moss_over_earth(165).with_mean(Colour(49.0, 49.0, 28.0)));
    gallery.surface("MFLR8_3", &cobbles(169).with_mean(Colour(110.0, 109.0, 102.0)));
}

/// Plates of rock, parted by cracks.
fn cracked(size: usize, cells: usize, seed: u32) -> Surface {
    let plates = Cells::new(size, size, (cells, cells), 0.9, seed);
    let warp = Field::clouds(size, size, (8, 8), 3, seed + 1);
    let rough = Field::clouds(size, size, (6, 6), 5, seed + 2);
    Surface::new(size, size, |x, y| {
        let (dx, dy) = ((warp.at(x, y) - 0.5) * 7.0, (warp.at(y + 50, x + 9) - 0.5) * 7.0);
        let cell = plates
            .at((x as f32 + dx).rem_euclid(size as f32), (y as f32 + dy).rem_euclid(size as f32));
        let tone = 0.85 + 0.22 * ((cell.id & 255) as f32 / 255.0) + 0.4 * (rough.at(x, y) - 0.5);
        let crack = (1.0 - cell.border / 1.4).clamp(0.0, 1.0);
        (
            Colour::grey(100.0 * tone * (1.0 - 0.6 * crack)),
            (cell.border / 3.0).min(1.0) * 1.6 - cell.centre * 0.05 + rough.at(x, y) * 2.4,
        )
    })
    .lit(0.34, 0.14, seed + 3)
}

/// Short grass over earth: blades are single bright texels with a dark foot.
fn grass(seed: u32) -> Surface {
    let size = 64;
    let patch = Field::clouds(size, size, (4, 4), 4, seed);
    let fine = Field::clouds(size, size, (16, 16), 2, seed + 1);
    let tones = [
        Colour::hex(0x2A2A16),
        Colour::hex(0x38401E),
        Colour::hex(0x4C5830),
        Colour::hex(0x6C7844),
    ];
    Surface::new(size, size, |x, y| {
        let blade = unit(x, y / 2, seed + 2);
        let level = patch.at(x, y) * 0.5 + fine.at(x, y) * 0.25 + blade * 0.3;
        (gradient(&tones, level), blade * 1.2 + patch.at(x, y) * 2.0)
    })
    .lit(0.22, 0.2, seed + 3)
}

/// Trodden earth with pebbles; `stony` says how many.
fn earth(size: usize, seed: u32, stony: f32) -> Surface {
    let lumps = Field::clouds(size, size, (5, 5), 5, seed);
    let pebbles = Cells::new(size, size, (10, 10), 0.9, seed + 1);
    Surface::new(size, size, |x, y| {
        let cell = pebbles.at(x as f32, y as f32);
        let radius = 0.6 + 2.0 * (cell.id >> 8 & 255) as f32 / 255.0;
        let pebble = (cell.id & 255) as f32 / 255.0 < 0.5 * stony && cell.centre < radius;
        let lump = lumps.at(x, y);
        let bare = Colour::hex(0x5C4228) * (0.7 + 0.6 * lump);
        if pebble {
            (Colour::hex(0x847460) * (0.9 + 0.3 * lump), lump * 3.0 + (radius - cell.centre) * 0.9)
        } else {
            (bare, lump * 3.0)
        }
    })
    .lit(0.3, 0.2, seed + 2)
}

/// Earth that patches of moss have overgrown.
fn moss_over_earth(seed: u32) -> Surface {
    let size = 64;
    let patch = Field::clouds(size, size, (3, 3), 4, seed);
    let lumps = Field::clouds(size, size, (6, 6), 4, seed + 1);
    Surface::new(size, size, |x, y| {
        let lump = lumps.at(x, y);
        let moss = ((patch.at(x, y) - 0.45) * 5.0).clamp(0.0, 1.0);
        let earth = Colour::hex(0x5A4426) * (0.7 + 0.6 * lump);
        let green = Colour::hex(0x3E5422) * (0.7 + 0.7 * unit(x, y, seed + 2));
        (earth.mix(green, moss), lump * 2.6 + moss * 1.2)
    })
    .lit(0.28, 0.2, seed + 3)
}

/// Round cobbles in dark earth.
fn cobbles(seed: u32) -> Surface {
    let size = 64;
    let stones = Cells::new(size, size, (6, 6), 0.7, seed);
    let rough = Field::clouds(size, size, (8, 8), 4, seed + 1);
    Surface::new(size, size, |x, y| {
        let cell = stones.at(x as f32, y as f32);
        let dome = (cell.border / 3.0).clamp(0.0, 1.0);
        let tone = 0.8 + 0.35 * (cell.id & 255) as f32 / 255.0;
        let gap = cell.border < 0.8;
        let colour = if gap { Colour::hex(0x383428) } else { Colour::hex(0x8C8A80) * tone };
        (colour * (0.85 + 0.3 * rough.at(x, y)), dome.sqrt() * 3.0 + rough.at(x, y) * 1.4)
    })
    .lit(0.3, 0.14, seed + 2)
}
