//! How a contact sheet is laid out: a row for each moment, its large views in a line, its learner's
//! frames in a square.

use hasard_media::{Picture, text};

/// Colour around and between the views.
const GROUND: [u8; 3] = [24, 24, 28];
/// Colour of captions.
const INK: [u8; 3] = [232, 232, 236];
/// Pixels between views.
const GAP: usize = 4;
/// Size in which the large views are shown.
const SHOWN: (usize, usize) = (320, 240);

/// One moment in every view: colour, depth, segmentation, map.
pub struct Row {
    /// What stands above it.
    pub caption: String,
    /// The views for people, shown reduced.
    pub large: [Picture; 4],
    /// The views at the learner's size, shown as they are.
    pub small: [Picture; 4],
}

/// The rows below each other.
///
/// # Panics
/// When there is no row.
pub fn sheet(rows: &[Row]) -> Picture {
    let frame = &rows.first().expect("at least one row").small[0];
    let (small_width, small_height) = (frame.width(), frame.height());
    let row_height = text::LINE_HEIGHT + SHOWN.1.max(2 * small_height + GAP) + GAP;
    let width = GAP + 4 * (SHOWN.0 + GAP) + 2 * (small_width + GAP);
    let mut sheet = Picture::filled(width, GAP + rows.len() * row_height, GROUND);
    for (i, row) in rows.iter().enumerate() {
        let top = GAP + i * row_height;
        text::draw(&mut sheet, GAP as isize, top as isize, &row.caption, INK);
        let top = top + text::LINE_HEIGHT;
        for (column, view) in row.large.iter().enumerate() {
            sheet.paste(&view.resized(SHOWN.0, SHOWN.1), GAP + column * (SHOWN.0 + GAP), top);
        }
        let left = GAP + 4 * (SHOWN.0 + GAP);
        for (place, view) in row.small.iter().enumerate() {
            sheet.paste(
                view,
                left + place % 2 * (small_width + GAP),
                top + place / 2 * (small_height + GAP),
            );
        }
    }
    sheet
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_view_has_its_place() {
        let shade = |level: u8, width, height| Picture::filled(width, height, [level, 0, 0]);
        let row = |base: u8| Row {
            caption: String::new(),
            large: [0, 1, 2, 3].map(|i| shade(base + i, 640, 480)),
            small: [4, 5, 6, 7].map(|i| shade(base + i, 128, 72)),
        };
        let sheet = sheet(&[row(40), row(50)]);
        let step = text::LINE_HEIGHT + 240 + GAP;
        assert_eq!((sheet.width(), sheet.height()), (4 * 324 + 2 * 132 + GAP, 2 * step + GAP));
        for (i, base) in [40, 50].into_iter().enumerate() {
            let top = GAP + i * step + text::LINE_HEIGHT;
            for view in 0..4 {
                assert_eq!(sheet.get(GAP + view * 324, top)[0], base + view as u8);
                let small = (GAP + 4 * 324 + view % 2 * 132, top + view / 2 * 76);
                assert_eq!(sheet.get(small.0, small.1)[0], base + 4 + view as u8);
            }
        }
    }
}
