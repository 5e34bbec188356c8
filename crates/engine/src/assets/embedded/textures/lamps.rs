//! Surfaces that give light: ceiling lamps and strips.

use crate::assets::embedded::canvas::Canvas;
use crate::assets::embedded::colour::{Colour, gradient};
use crate::assets::embedded::gallery::Gallery;
use crate::assets::embedded::noise::Field;
use crate::assets::embedded::surface::Surface;

/// Paints the lamps.
pub(super) fn paint(gallery: &mut Gallery) {
    let red = [
        Colour::hex(0xFFE8D8),
        Colour::hex(0xF05040),
        Colour::hex(0xC01C14),
        Colour::hex(0x5C0808),
    ];
    let amber = [
        Colour::hex(0xFFFFF0),
        Colour::hex(0xFFF0A0),
        Colour::hex(0xE0B040),
        Colour::hex(0x704810),
    ];
    gallery.texture("TLITE6_5", &round_lamps(&red, 501));
    gallery.texture("TLITE6_4", &round_lamps(&amber, 511));
    gallery.texture("LITEBLU4", &strips(Colour::hex(0x0C0C88), Colour::hex(0x3848FF), 16, 521));
    gallery.texture("LITEBLU2", &strips(Colour::hex(0x2030A0), Colour::hex(0xA8C8FF), 32, 531));
    gallery.texture("LITERED1", &strips(Colour::hex(0xA01010), Colour::hex(0xFF8060), 32, 541));
    gallery.texture("LITEYEL3", &light_crate(551));
}

/// Dark plates, each with a round lamp in a ring.
fn round_lamps(tones: &[Colour], seed: u32) -> Canvas {
    let size = 64;
    let grime = Field::clouds(size, size, (6, 6), 4, seed);
    let plate = Surface::new(size, size, |x, y| {
        let (u, v) = (x % 32, y % 32);
        let edge = u.min(31 - u).min(v.min(31 - v)) as f32;
        let (dx, dy) = (u as f32 - 15.5, v as f32 - 15.5);
        let ring = ((dx * dx + dy * dy).sqrt() - 9.4).abs();
        let raise = (edge / 2.0).min(1.0) + if ring < 1.6 { 1.4 } else { 0.0 };
        (Colour::hex(0x26231F) * (0.7 + 0.6 * grime.at(x, y)), raise)
    });
    let mut canvas = plate.lit(0.4, 0.12, seed + 1).canvas();
    for (x, y) in [(16.0, 16.0), (48.0, 16.0), (16.0, 48.0), (48.0, 48.0)] {
        canvas.ellipse((x, y), (7.6, 7.6), |u, v| {
            let out = (u * u + v * v).sqrt();
            // A ring of light around a dark bulb socket, as such lamps look from below.
            let level = if out < 0.34 { 0.45 - out } else { (out - 0.62).abs() * 2.2 };
            gradient(tones, level)
        });
    }
    canvas
}

/// Glowing horizontal tubes in a dark frame; `pitch` texels from tube to tube.
fn strips(dark: Colour, bright: Colour, pitch: i32, seed: u32) -> Canvas {
    let size = 64;
    let grime = Field::clouds(size, size, (4, 4), 3, seed);
    let mut canvas = Canvas::new(size as i32, size as i32);
    for x in 0..size as i32 {
        for y in 0..size as i32 {
            let v = y % pitch;
            let from_middle = ((v as f32 + 0.5) / pitch as f32 * 2.0 - 1.0).abs();
            let colour = if from_middle > 0.86 || (x % 32 == 0 && pitch > 16) {
                dark * 0.28
            } else {
                dark.mix(bright, (1.0 - from_middle) * (1.0 - from_middle))
            };
            canvas.set(x, y, colour * (0.88 + 0.24 * grime.at(x, y)));
        }
    }
    canvas
}

/// The side of a grey-brown box with bright yellow strips.
fn light_crate(seed: u32) -> Canvas {
    let size = 64;
    let scuff = Field::clouds(size, size, (5, 5), 4, seed);
    let base = Surface::new(size, size, |x, y| {
        let v = y % 16;
        let edge = v.min(15 - v) as f32;
        (Colour::hex(0x6C6048) * (0.8 + 0.4 * scuff.at(x, y)), edge.min(2.0))
    });
    let mut canvas = base.lit(0.3, 0.12, seed + 1).canvas();
    for y in (0..size as i32).step_by(16) {
        canvas.bevel(1, y + 4, 30, 8, Colour::hex(0x282418), -0.5);
        canvas.bevel(33, y + 4, 30, 8, Colour::hex(0x282418), -0.5);
        for x in [2, 34] {
            for row in 0..6 {
                let glow = [0.5, 0.8, 1.0, 1.0, 0.8, 0.5][row as usize];
                canvas.rect(
                    x,
                    y + 5 + row,
                    28,
                    1,
                    Colour::hex(0x706030).mix(Colour::hex(0xFFF8B0), glow),
                );
            }
        }
    }
    canvas
}
