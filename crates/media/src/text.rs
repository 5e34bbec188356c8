//! Captions on pictures.

use crate::Picture;
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// Rows that a line of text takes.
pub const LINE_HEIGHT: usize = RasterHeight::Size16.val();

/// Columns that a text takes; every character is as wide as any other.
#[must_use]
pub fn width(text: &str) -> usize {
    text.chars().count() * get_raster_width(FontWeight::Regular, RasterHeight::Size16)
}

/// Writes one line, its upper left corner at (`x`, `y`). Latin characters are known, others become
/// `?`.
pub fn draw(picture: &mut Picture, x: isize, y: isize, text: &str, colour: [u8; 3]) {
    each_pixel(text, |column, row, share| {
        picture.blend(x + column as isize, y + row as isize, colour, share)
    });
}

/// Writes one line with a dark shadow, so that it can be read on any background.
pub fn draw_shadowed(picture: &mut Picture, x: isize, y: isize, text: &str, colour: [u8; 3]) {
    for (dx, dy) in [(1, 0), (0, 1), (1, 1), (-1, 0), (0, -1)] {
        draw(picture, x + dx, y + dy, text, [0; 3]);
    }
    draw(picture, x, y, text, colour);
}

/// Visits every inked pixel of a line of text: column, row, ink of 1..=255.
pub fn each_pixel(text: &str, mut visit: impl FnMut(usize, usize, u8)) {
    let mut left = 0;
    for character in text.chars() {
        let glyph = get_raster(character, FontWeight::Regular, RasterHeight::Size16)
            .or_else(|| get_raster('?', FontWeight::Regular, RasterHeight::Size16))
            .expect("the font has a question mark");
        for (row, line) in glyph.rows().enumerate() {
            for (column, &ink) in line.iter().enumerate() {
                if ink > 0 {
                    visit(left + column, row, ink);
                }
            }
        }
        left += glyph.width();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn different_letters_look_different_and_stay_inside() {
        let mut drawings = std::collections::BTreeSet::new();
        for character in ('!'..='~').chain(['é', '±']) {
            let mut picture = Picture::filled(width("x"), LINE_HEIGHT, [0; 3]);
            draw(&mut picture, 0, 0, &character.to_string(), [255; 3]);
            assert!(drawings.insert(picture.rgb().to_vec()), "{character}");
        }
        let mut small = Picture::filled(3, 3, [0; 3]);
        draw_shadowed(&mut small, -2, -2, "cut off \u{4e2d}", [255; 3]);
    }
}
