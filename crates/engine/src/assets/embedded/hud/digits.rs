//! The digits of the status bar and the letters of text overlays.

use super::glyphs::{LABEL, READING};
use crate::assets::embedded::canvas::Canvas;
use crate::assets::embedded::colour::{Colour, gradient};
use crate::assets::embedded::gallery::Gallery;

/// Strokes of each big digit in a seven-segment order: top, upper left, upper right, middle, lower
/// left, lower right, bottom.
const SEGMENTS: [u8; 10] = [
    0b1110111, 0b0010010, 0b1011101, 0b1011011, 0b0111010, 0b1101011, 0b1101111, 0b1010010,
    0b1111111, 0b1111011,
];

/// Paints digits and letters.
pub(super) fn paint(gallery: &mut Gallery) {
    for (digit, &segments) in SEGMENTS.iter().enumerate() {
        gallery.graphic(&format!("STTNUM{digit}"), &embossed(&big_digit(segments)), 0, 0);
    }
    gallery.graphic("STTMINUS", &embossed(&[(3, 7, 8, 3)]), 0, 0);
    gallery.graphic("STTPRCNT", &percent(), 0, 0);
    for digit in 0..10 {
        gallery.graphic(
            &format!("STGNUM{digit}"),
            &small_digit(digit, Colour::hex(0x8C8C8C)),
            0,
            0,
        );
        gallery.graphic(
            &format!("STYSNUM{digit}"),
            &small_digit(digit, Colour::hex(0xE8D84C)),
            0,
            0,
        );
    }
    for (character, rows) in READING {
        gallery.graphic(&format!("STCFN{:03}", character as u32), &letter(&rows), 0, 0);
    }
}

/// The bars of a 14 by 16 digit, each as left, top, width, height.
fn big_digit(segments: u8) -> Vec<(i32, i32, i32, i32)> {
    let bars = [
        (2, 1, 10, 3),
        (1, 2, 4, 6),
        (9, 2, 4, 6),
        (2, 6, 10, 3),
        (1, 8, 4, 6),
        (9, 8, 4, 6),
        (2, 12, 10, 3),
    ];
    if segments == SEGMENTS[1] {
        // A lone right stroke would stand off from its neighbours.
        return vec![(5, 1, 4, 14), (3, 2, 3, 3)];
    }
    bars.into_iter()
        .enumerate()
        .filter(|(i, _)| segments >> (6 - i) & 1 == 1)
        .map(|(_, bar)| bar)
        .collect()
}

/// Red bars with a light upper left edge, a dark lower right one and a black shadow, rounded at
/// free corners.
fn embossed(bars: &[(i32, i32, i32, i32)]) -> Canvas {
    let mut shape = Canvas::new(14, 16);
    for &(x, y, width, height) in bars {
        shape.rect(x, y, width, height, Colour::BLACK);
    }
    let solid = shape.clone();
    let filled = |x, y| solid.get(x, y).is_some();
    for x in 0..14 {
        for y in 0..16 {
            let (across, down) =
                (filled(x - 1, y) && filled(x + 1, y), filled(x, y - 1) && filled(x, y + 1));
            let neighbours = [(1, 0), (-1, 0), (0, 1), (0, -1)]
                .iter()
                .filter(|(dx, dy)| filled(x + dx, y + dy))
                .count();
            if filled(x, y) && neighbours <= 2 && !across && !down {
                shape.clear(x, y);
            }
        }
    }
    let rounded = shape.clone();
    let filled = |x, y| rounded.get(x, y).is_some();
    let red = [Colour::hex(0xE81C14), Colour::hex(0xB01010), Colour::hex(0x7C0808)];
    let mut out = Canvas::new(14, 16);
    for x in 0..14 {
        for y in 0..16 {
            if filled(x - 1, y - 1) {
                out.set(x, y, Colour::hex(0x180404));
            }
        }
    }
    for x in 0..14 {
        for y in 0..16 {
            if filled(x, y) {
                let body = gradient(&red, y as f32 / 15.0);
                let colour = if !filled(x, y - 1) || !filled(x - 1, y) {
                    body.mix(Colour::hex(0xFF8060), 0.55)
                } else if !filled(x, y + 1) || !filled(x + 1, y) {
                    body * 0.6
                } else {
                    body
                };
                out.set(x, y, colour);
            }
        }
    }
    out
}

fn percent() -> Canvas {
    let mut out = Canvas::new(15, 16);
    let ring = |canvas: &mut Canvas, x, y| {
        canvas.bevel(x, y, 5, 5, Colour::hex(0xB41010), 0.4);
        canvas.rect(x + 2, y + 2, 1, 1, Colour::hex(0x180404));
    };
    for step in 0..11 {
        out.rect(
            10 - step * 8 / 10,
            2 + step,
            3,
            2,
            Colour::hex(if step % 2 == 0 { 0xC01410 } else { 0xA81010 }),
        );
    }
    ring(&mut out, 1, 2);
    ring(&mut out, 9, 9);
    out
}

fn small_digit(digit: u8, colour: Colour) -> Canvas {
    let mut out = Canvas::new(4, 6);
    let (_, rows) = LABEL[13 + digit as usize];
    stamp_bits(&mut out, 1, 1, &rows, 3, Colour::hex(0x101010));
    stamp_bits(&mut out, 0, 0, &rows, 3, colour);
    out
}

fn letter(rows: &[u8; 7]) -> Canvas {
    let mut out = Canvas::new(6, 8);
    stamp_bits(&mut out, 1, 1, rows, 5, Colour::hex(0x080808));
    stamp_bits(&mut out, 0, 0, rows, 5, Colour::hex(0xF0E8D8));
    out
}

/// Sets the dots of a glyph; the highest of the `width` bits is the left dot.
pub(super) fn stamp_bits(
    canvas: &mut Canvas,
    x: i32,
    y: i32,
    rows: &[u8],
    width: i32,
    colour: Colour,
) {
    for (row, bits) in rows.iter().enumerate() {
        for column in 0..width {
            if bits >> (width - 1 - column) & 1 == 1 {
                canvas.set(x + column, y + row as i32, colour);
            }
        }
    }
}
