//! The status bar's plates and the key symbols.

use super::digits::stamp_bits;
use super::glyphs::{LABEL, READING};
use crate::assets::embedded::canvas::Canvas;
use crate::assets::embedded::colour::Colour;
use crate::assets::embedded::gallery::Gallery;
use crate::assets::embedded::noise::Field;

/// Paints the bar, the arms panel and the keys.
pub(super) fn paint(gallery: &mut Gallery) {
    gallery.graphic("STBAR", &bar(), 0, 0);
    gallery.graphic("STARMS", &arms(), 0, 0);
    let keys = [0x3858F0, 0xE8D03C, 0xE02018];
    for (i, colour) in keys.into_iter().enumerate() {
        gallery.graphic(&format!("STKEYS{i}"), &card(Colour::hex(colour)), 0, 0);
        gallery.graphic(&format!("STKEYS{}", i + 3), &skull(Colour::hex(colour)), 0, 0);
    }
}

/// A plate of brushed metal with a raised rim.
fn plate(canvas: &mut Canvas, x: i32, width: i32) {
    let brush = Field::clouds(64, 32, (2, 24), 3, 901);
    let blotch = Field::clouds(64, 32, (6, 4), 3, 902);
    for at_x in x..x + width {
        for y in 0..32 {
            let tone = 78.0 + 34.0 * (brush.at(at_x, y) - 0.5) + 26.0 * (blotch.at(at_x, y) - 0.5)
                - y as f32 * 0.5;
            let (from_left, from_right) = (at_x - x, x + width - 1 - at_x);
            let rim = if y == 0 || from_left == 0 {
                1.55
            } else if y == 31 || from_right == 0 {
                0.4
            } else if y == 1 || from_left == 1 {
                1.2
            } else if y == 30 || from_right == 1 {
                0.7
            } else {
                1.0
            };
            canvas.set(at_x, y, Colour(tone, tone * 0.985, tone * 0.96) * rim);
        }
    }
    for (rivet_x, rivet_y) in [(x + 3, 27), (x + width - 5, 27)] {
        canvas.bevel(rivet_x, rivet_y, 2, 2, Colour::grey(90.0), 0.5);
    }
}

/// A dark sunken window for a number.
fn well(canvas: &mut Canvas, x: i32, y: i32, width: i32, height: i32) {
    canvas.bevel(x, y, width, height, Colour::hex(0x1C1A1A), -0.9);
    canvas.rect(x, y + height - 1, width, 1, Colour::grey(118.0));
    canvas.rect(x + width - 1, y, 1, height, Colour::grey(104.0));
}

fn reading_text(canvas: &mut Canvas, x: i32, y: i32, text: &str) {
    for (i, character) in text.chars().enumerate() {
        if let Some((_, rows)) = READING.iter().find(|(known, _)| *known == character) {
            // The two middle rows of the seven are the same in most letters; five rows fit under
            // the number.
            let rows = [rows[0], rows[1], rows[3], rows[5], rows[6]];
            let x = x + 6 * i as i32;
            stamp_bits(canvas, x + 1, y + 1, &rows, 5, Colour::grey(14.0));
            stamp_bits(canvas, x, y, &rows, 5, Colour::grey(182.0));
        }
    }
}

fn label_text(canvas: &mut Canvas, x: i32, y: i32, text: &str) {
    for (i, character) in text.chars().enumerate() {
        if let Some((_, rows)) = LABEL.iter().find(|(known, _)| *known == character) {
            stamp_bits(canvas, x + 4 * i as i32, y, rows, 3, Colour::grey(170.0));
        }
    }
}

fn bar() -> Canvas {
    let mut c = Canvas::new(320, 32);
    plate(&mut c, 0, 48);
    well(&mut c, 2, 2, 44, 18);
    reading_text(&mut c, 12, 24, "AMMO");
    plate(&mut c, 48, 56);
    well(&mut c, 50, 2, 52, 18);
    reading_text(&mut c, 58, 24, "HEALTH");
    // The frag plate: covered by the arms panel in the games that this bar is for.
    plate(&mut c, 104, 39);
    // The face looks out of a dark well.
    plate(&mut c, 143, 36);
    well(&mut c, 145, 1, 32, 30);
    plate(&mut c, 179, 57);
    well(&mut c, 181, 2, 53, 18);
    reading_text(&mut c, 192, 24, "ARMOR");
    plate(&mut c, 236, 13);
    for slot in 0..3 {
        well(&mut c, 237, 2 + 10 * slot, 11, 9);
    }
    plate(&mut c, 249, 71);
    well(&mut c, 272, 2, 45, 28);
    for (i, label) in ["BULL", "SHEL", "RCKT", "CELL"].into_iter().enumerate() {
        let y = 5 + 6 * i as i32;
        label_text(&mut c, 254, y, label);
        c.line((293.0, y as f32 + 4.0), (295.0, y as f32), Colour::hex(0x8A8030));
    }
    c
}

fn arms() -> Canvas {
    let mut c = Canvas::new(40, 32);
    plate(&mut c, 0, 39);
    c.rect(39, 0, 1, 32, Colour::grey(30.0));
    for slot in 0..6 {
        well(&mut c, 4 + 12 * (slot % 3), 3 + 10 * (slot / 3), 9, 9);
    }
    reading_text(&mut c, 8, 24, "ARMS");
    c
}

fn card(colour: Colour) -> Canvas {
    let mut c = Canvas::new(7, 5);
    c.bevel(0, 0, 7, 5, colour, 0.35);
    c.rect(1, 1, 2, 2, colour * 0.4);
    c.rect(4, 3, 2, 1, colour * 0.5);
    c
}

fn skull(colour: Colour) -> Canvas {
    let mut c = Canvas::new(7, 7);
    c.ball((3.5, 3.0), (3.4, 3.0), colour);
    c.rect(2, 5, 3, 2, colour * 0.8);
    c.rect(1, 3, 2, 1, Colour::grey(10.0));
    c.rect(4, 3, 2, 1, Colour::grey(10.0));
    c.set(3, 6, Colour::grey(20.0));
    c
}
