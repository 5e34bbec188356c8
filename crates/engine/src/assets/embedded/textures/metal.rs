//! Plates, grilles and steel, clean or rusty.

use crate::assets::embedded::colour::{Colour, gradient};
use crate::assets::embedded::gallery::Gallery;
use crate::assets::embedded::noise::Field;
use crate::assets::embedded::surface::Surface;

/// Paints the metals.
pub(super) fn paint(gallery: &mut Gallery) {
    gallery.surface("AQRUST07", &rust_plates(211).with_mean(Colour(70.0, 61.0, 50.0)));
    gallery.surface("METAL5", &dark_steel(221).with_mean(Colour(36.0, 36.0, 38.0)));
    gallery.surface("SUPPORT3", &girder(231).with_mean(Colour(78.0, 72.0, 64.0)));
}

/// Large riveted plates, dark steel eaten by rust.
fn rust_plates(seed: u32) -> Surface {
    let size = 128;
    let rust = Field::clouds(size, size, (4, 4), 5, seed);
    let drip = Field::clouds(size, size, (24, 3), 3, seed + 1);
    let tones = [
        Colour::hex(0x3A3630),
        Colour::hex(0x4A443A),
        Colour::hex(0x5A4C3C),
        Colour::hex(0x6A4C30),
        Colour::hex(0x7C5028),
    ];
    let mut surface = Surface::new(size, size, |x, y| {
        let (u, v) = (x % 64, y % 64);
        let edge = u.min(63 - u).min(v.min(63 - v)) as f32;
        let eaten =
            rust.at(x, y) * 0.75 + drip.at(x, y) * 0.35 - 0.08 + (4.0 - edge).max(0.0) * 0.05;
        let seam = if edge < 1.0 { 0.45 } else { 1.0 };
        (gradient(&tones, eaten) * seam, (edge / 2.0).min(1.0) * 1.5 + rust.at(x, y) * 1.6)
    });
    for plate_x in [0, 64] {
        for plate_y in [0, 64] {
            for step in 0..4 {
                let along = 7 + step * 16 + step / 2;
                surface.rivet(plate_x + along, plate_y + 5, 1.5, Colour::hex(0x5E564A));
                surface.rivet(plate_x + along, plate_y + 58, 1.5, Colour::hex(0x5A4E3E));
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

/// Dark steel with ribs across.
fn dark_steel(seed: u32) -> Surface {
    let grime = Field::clouds(128, 128, (5, 5), 5, seed);
    let mut surface = Surface::new(128, 128, |x, y| {
        let v = y % 32;
        let rib = if v < 6 { (v.min(5 - v) as f32).min(1.5) + 0.5 } else { 0.0 };
        let seam = x % 64 == 0;
        (
            Colour::grey(40.0 * (0.75 + 0.5 * grime.at(x, y)) * if seam { 0.4 } else { 1.0 }),
            rib * 1.4 + grime.at(x, y),
        )
    });
    for y in [19, 51, 83, 115] {
        for x in [6, 58, 70, 122] {
            surface.rivet(x, y, 1.6, Colour::grey(52.0));
        }
    }
    surface.lit(0.4, 0.1, seed + 1)
}

/// An upright I-beam with holes, 64 wide.
fn girder(seed: u32) -> Surface {
    let rust = Field::clouds(64, 128, (4, 8), 5, seed);
    let mut surface = Surface::new(64, 128, |x, y| {
        let (u, v) = (x % 32, y % 32);
        let flange = u.min(31 - u);
        let (dx, dy) = (u as f32 - 15.5, v as f32 - 15.5);
        let hole = dx * dx + dy * dy < 36.0;
        let steel =
            Colour::hex(0x6C665C).mix(Colour::hex(0x74481E), (rust.at(x, y) - 0.4).max(0.0) * 1.6);
        if hole {
            (Colour::hex(0x14120E), -3.0)
        } else if flange < 6 {
            (steel * 1.1, 3.0 + (flange.min(5 - flange) as f32).min(1.0))
        } else {
            (steel * 0.85, rust.at(x, y) * 0.8)
        }
    });
    for x in [3, 28, 35, 60] {
        for y in (4..128).step_by(16) {
            surface.rivet(x, y, 1.2, Colour::hex(0x7C766C));
        }
    }
    surface.lit(0.32, 0.12, seed + 1)
}
