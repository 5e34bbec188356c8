//! Lava and acid: animated, each frame flowing into the next and the last into the first.

use crate::assets::embedded::canvas::Canvas;
use crate::assets::embedded::colour::{Colour, gradient};
use crate::assets::embedded::gallery::Gallery;
use crate::assets::embedded::noise::Field;
use crate::assets::embedded::surface::Surface;

/// Texels on each side of a flat.
const SIZE: usize = 64;
/// Tics that each frame is shown, as in the original engine.
const TICS: u8 = 8;

/// Where two layers of noise are moved to in the four phases of a cycle: around a circle and back.
const DRIFT: [(i32, i32); 4] = [(3, 0), (0, 3), (-3, 0), (0, -3)];

/// How far the lava has cooled down.
const COOLNESS: f32 = 0.34;

/// Paints the liquids.
pub(super) fn paint(gallery: &mut Gallery) {
    let lava: Vec<Canvas> = (0..4).map(lava).collect();
    gallery.animation(&["LAVA1", "LAVA2", "LAVA3", "LAVA4"], &lava, TICS);
    let acid: Vec<Canvas> = (0..3).map(acid).collect();
    gallery.animation(&["NUKAGE1", "NUKAGE2", "NUKAGE3"], &acid, TICS);
}

/// A dark red crust torn by glowing seams: the seams lie where two drifting layers of noise cross.
fn lava(phase: usize) -> Canvas {
    let (dx, dy) = DRIFT[phase];
    let first = Field::clouds(SIZE, SIZE, (7, 8), 4, 11);
    let second = Field::clouds(SIZE, SIZE, (8, 7), 4, 12);
    let crust = Field::clouds(SIZE, SIZE, (12, 12), 3, 13);
    let glow = [
        Colour::hex(0xFFE040),
        Colour::hex(0xFF9C10),
        Colour::hex(0xE05806),
        Colour::hex(0xA82E02),
        Colour::hex(0x761802),
        Colour::hex(0x520E02),
        Colour::hex(0x360602),
    ];
    Surface::new(SIZE, SIZE, |x, y| {
        let apart = (first.at(x + dx, y + dy) - second.at(x - dx, y - dy)).abs();
        // The offset sets how much of the surface glows: the specified mean without any scaling,
        // which would turn the bright seams brown.
        let cool =
            (apart * 2.3 + (crust.at(x - dy, y + dx) - 0.5) * 0.8 + COOLNESS).clamp(0.0, 1.0);
        (gradient(&glow, cool), cool)
    })
    .lit(0.2, 0.1, 14)
    .canvas()
}

/// Dark green acid with lighter scum and a few bubbles.
fn acid(phase: usize) -> Canvas {
    let (dx, dy) = DRIFT[phase];
    let slow = Field::clouds(SIZE, SIZE, (4, 4), 4, 21);
    let fast = Field::clouds(SIZE, SIZE, (7, 7), 3, 22);
    let tones = [
        Colour::hex(0x0A2004),
        Colour::hex(0x163C0A),
        Colour::hex(0x2C6414),
        Colour::hex(0x7CD048),
    ];
    Surface::new(SIZE, SIZE, |x, y| {
        let wave = slow.at(x + dx, y - dy) * 0.6 + fast.at(x - 2 * dx, y + 2 * dy) * 0.4;
        let scum = (wave - 0.35).max(0.0) * 1.7;
        (gradient(&tones, scum * scum + 0.1), wave * 2.0)
    })
    .lit(0.5, 0.1, 23)
    .with_mean(Colour(22.0, 46.0, 13.0))
    .canvas()
}
