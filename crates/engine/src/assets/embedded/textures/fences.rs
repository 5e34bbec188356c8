//! See-through barriers: their holes are transparent.

use crate::assets::embedded::canvas::Canvas;
use crate::assets::embedded::colour::Colour;
use crate::assets::embedded::gallery::Gallery;

/// Paints the fences.
pub(super) fn paint(gallery: &mut Gallery) {
    gallery.texture("MIDBARS3", &bars());
    gallery.texture("MIDSPACE", &mesh());
}

/// Upright round bars between two rails.
fn bars() -> Canvas {
    let mut c = Canvas::new(64, 128);
    let across = [0.45, 0.9, 1.35, 1.0, 0.6, 0.35];
    for x in (5..64).step_by(16) {
        for (i, light) in across.into_iter().enumerate() {
            c.rect(x + i as i32, 0, 1, 128, Colour::hex(0x6C6E70) * light);
        }
    }
    for y in [4, 60, 116] {
        for (i, light) in [1.3, 1.1, 0.9, 0.9, 0.7, 0.45].into_iter().enumerate() {
            c.rect(0, y + i as i32, 64, 1, Colour::hex(0x5C5E60) * light);
        }
        for x in (7..64).step_by(16) {
            c.rect(x, y + 2, 2, 2, Colour::hex(0xA0A4A8));
        }
    }
    c
}

/// Wire mesh in lozenges, with a post at each end.
fn mesh() -> Canvas {
    let mut c = Canvas::new(64, 128);
    for x in 0..64i32 {
        for y in 0..128 {
            let (up, down) = ((x + y) % 16, (x - y).rem_euclid(16));
            // The wire that runs up to the right lies over the other, and is lit.
            if up < 2 {
                c.set(x, y, Colour::hex(if up == 0 { 0xA8ACB0 } else { 0x64686C }));
            } else if down < 2 {
                c.set(x, y, Colour::hex(if down == 0 { 0x787C80 } else { 0x404448 }));
            }
        }
    }
    for (i, light) in [0.5, 1.0, 1.35, 1.0, 0.6, 0.4].into_iter().enumerate() {
        c.rect(i as i32, 0, 1, 128, Colour::hex(0x707478) * light);
    }
    for (y, height) in [(0, 4), (124, 4)] {
        for row in 0..height {
            c.rect(0, y + row, 64, 1, Colour::hex(0x707478) * [1.3, 1.0, 0.8, 0.5][row as usize]);
        }
    }
    c
}
