//! Plates, grilles and steel, clean or rusty.

use crate::assets::embedded::colour::{Colour, gradient};
use crate::assets::embedded::gallery::Gallery;
use crate::assets::embedded::noise::Field;
use crate::assets::embedded::surface::Surface;

/// Paints the metals.
pub(super) fn paint(gallery: &mut Gallery) {
    gallery.surface("AQRUST07", &rust_plates(211).with_mean(Colour(70.0, 61.0, 50.0)));
}

/// Large riveted plates, dark steel eaten by rust.
fn rust_plates(seed: u32) -> Surface {
    let size = 128;
    let rust = Field::clouds(size, size, (4, 4), 5, seed);
    let drip = Field::clouds(size, size, (24, 3), 3, seed + 1);
    let tones =
        [Colour::hex(0x3C3C3A), Colour::hex(0x4A4640), Colour::hex(0x5E4630), Colour::hex(0x74461E), Colour::hex(0x865420)];
    let mut surface = Surface::new(size, size, |x, y| {
        let (u, v) = (x % 64, y % 64);
        let edge = u.min(63 - u).min(v.min(63 - v)) as f32;
        let eaten = rust.at(x, y) * 0.75 + drip.at(x, y) * 0.35 - 0.08 + (4.0 - edge).max(0.0) * 0.05;
        let seam = if edge < 1.0 { 0.45 } else { 1.0 };
        (gradient(&tones, eaten) * seam, (edge / 2.0).min(1.0) * 1.5 + rust.at(x, y) * 1.6)
    });
    for plate_x in [0, 64] {
        for plate_y in [0, 64] {
            for step in 0..4 {
                let along = 7 + step * 16 + step / 2;
                surface.rivet(plate_x + along, plate_y + 5, 1.5, Colour::hex(0x5C5850));
                surface.rivet(plate_x + along, plate_y + 58, 1.5, Colour::hex(0x5C5040));
            }
        }
    }
    // A sunken hatch on one plate breaks the repetition.
    surface.area(18, 84, 28, 24, |x, y, colour, raise| {
        let edge = x.min(27 - x).min(y.min(23 - y));
        (if edge == 0 { colour * 0.5 } else { colour * 0.85 }, raise - (edge as f32 / 2.0).min(1.5))
    });
    surface.lit(0.34, 0.14, seed + 2)
}
