//! The armour bonus: a small red helmet.

use crate::assets::embedded::canvas::Canvas;
use crate::assets::embedded::colour::{Colour, gradient};
use crate::assets::embedded::gallery::Gallery;

/// Paints the helmet: its frames A to D brighten the eyes, shown back and forth.
pub(super) fn paint(gallery: &mut Gallery) {
    for glow in 0..4 {
        gallery.standing("BON2", &helmet(glow as f32 / 3.0));
    }
}

/// A red helmet with a dark visor and a yellow badge.
fn helmet(glow: f32) -> Canvas {
    let mut c = Canvas::new(13, 19);
    let red = [
        Colour::hex(0x4A0606),
        Colour::hex(0xB01410),
        Colour::hex(0xF03A28),
        Colour::hex(0xFF9080),
    ];
    let at = |u: f32, v: f32| gradient(&red, 0.62 - 0.42 * u - 0.38 * v);
    // Neck guard, then the dome over it.
    c.polygon(
        &[(1.0, 8.0), (12.0, 8.0), (11.5, 15.0), (9.0, 19.0), (4.0, 19.0), (1.5, 15.0)],
        |x, y| at((x as f32 - 6.0) / 7.0, (y as f32 - 10.0) / 10.0) * 0.8,
    );
    c.ellipse((6.5, 7.0), (6.4, 6.8), at);
    // Visor slit and nose bar.
    let dark = Colour::hex(0x181416);
    c.rect(2, 9, 9, 3, dark);
    c.rect(4, 12, 5, 2, dark);
    let eye = Colour::hex(0x402020).mix(Colour::hex(0xFFE070), glow);
    c.rect(3, 10, 2, 1, eye);
    c.rect(8, 10, 2, 1, eye);
    c.rect(6, 8, 1, 6, Colour::hex(0xC0C4C8));
    // Crest.
    c.rect(6, 0, 1, 7, Colour::hex(0xE8E0D0));
    c.rect(5, 1, 1, 4, Colour::hex(0x909498));
    c.outline(0.55);
    c
}
