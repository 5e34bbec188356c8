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
}

/// Plates of rock, parted by cracks.
fn cracked(size: usize, cells: usize, seed: u32) -> Surface {
    let plates = Cells::new(size, size, (cells, cells), 0.9, seed);
    let warp = Field::clouds(size, size, (8, 8), 3, seed + 1);
    let rough = Field::clouds(size, size, (6, 6), 5, seed + 2);
    Surface::new(size, size, |x, y| {
        let (dx, dy) = ((warp.at(x, y) - 0.5) * 7.0, (warp.at(y + 50, x + 9) - 0.5) * 7.0);
        let cell = plates.at((x as f32 + dx).rem_euclid(size as f32), (y as f32 + dy).rem_euclid(size as f32));
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
    let tones = [Colour::hex(0x2A2A16), Colour::hex(0x38401E), Colour::hex(0x4C5830), Colour::hex(0x6C7844)];
    Surface::new(size, size, |x, y| {
        let blade = unit(x, y / 2, seed + 2);
        let level = patch.at(x, y) * 0.5 + fine.at(x, y) * 0.25 + blade * 0.3;
        (gradient(&tones, level), blade * 1.2 + patch.at(x, y) * 2.0)
    })
    .lit(0.22, 0.2, seed + 3)
}
