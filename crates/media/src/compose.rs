//! Several views of one moment side by side.

use crate::{Picture, text};

/// Colour around and between the panels.
const GROUND: [u8; 3] = [24, 24, 28];
/// Colour of captions.
const INK: [u8; 3] = [232, 232, 236];
/// Pixels between panels.
const GAP: usize = 4;

/// A view with its caption; an empty caption takes no room if all are empty.
#[derive(Clone, Debug)]
pub struct Panel<'a> {
    picture: &'a Picture,
    caption: String,
}

impl<'a> Panel<'a> {
    /// A view with its caption.
    #[must_use]
    pub fn new(picture: &'a Picture, caption: impl Into<String>) -> Panel<'a> {
        Panel { picture, caption: caption.into() }
    }
}

/// The panels in one row, each `enlarge` times as large, captions below. Panels of unlike height
/// are brought to that of the first, keeping their proportions, so that an automap of any size
/// stands beside a view.
///
/// # Panics
/// When there is no panel.
#[must_use]
pub fn side_by_side(panels: &[Panel], enlarge: usize) -> Picture {
    grid(panels, panels.len(), enlarge)
}

/// The panels in rows of `columns`, all cells of a size: a contact sheet.
///
/// # Panics
/// When there is no panel.
#[must_use]
pub fn grid(panels: &[Panel], columns: usize, enlarge: usize) -> Picture {
    let first = panels.first().expect("at least one panel");
    let columns = columns.clamp(1, panels.len());
    let height = first.picture.height() * enlarge.max(1);
    let sized: Vec<Picture> = panels
        .iter()
        .map(|panel| {
            let source = panel.picture;
            if source.height() * enlarge.max(1) == height {
                source.enlarged(enlarge)
            } else {
                source.resized((source.width() * height / source.height()).max(1), height)
            }
        })
        .collect();
    // A column is as wide as its widest view; a caption that is wider still is cut.
    let widths: Vec<usize> = (0..columns)
        .map(|column| {
            sized.iter().skip(column).step_by(columns).map(Picture::width).max().unwrap_or(1)
        })
        .collect();
    let caption_height =
        if panels.iter().all(|panel| panel.caption.is_empty()) { 0 } else { text::LINE_HEIGHT + 2 };
    let rows = panels.len().div_ceil(columns);
    let cell_height = height + caption_height + GAP;
    // Even sides, because video encodes colour for squares of 2 x 2 pixels.
    let even = |side: usize| side + side % 2;
    let mut sheet = Picture::filled(
        even(widths.iter().sum::<usize>() + GAP * (columns + 1)),
        even(rows * cell_height + GAP),
        GROUND,
    );
    for (index, (panel, view)) in panels.iter().zip(&sized).enumerate() {
        let column = index % columns;
        let x = GAP + widths[..column].iter().map(|w| w + GAP).sum::<usize>();
        let y = GAP + index / columns * cell_height;
        sheet.paste(view, x, y);
        let fits = (widths[column] / text::width("x")).max(1);
        let caption: String = panel.caption.chars().take(fits).collect();
        text::draw(&mut sheet, x as isize, (y + height + 2) as isize, &caption, INK);
    }
    sheet
}

/// The frame with a line of text under it: time, return, cost.
#[must_use]
pub fn with_footer(frame: &Picture, line: &str) -> Picture {
    let height = frame.height() + text::LINE_HEIGHT + 2;
    let mut picture = Picture::filled(frame.width(), height + height % 2, GROUND);
    picture.paste(frame, 0, 0);
    text::draw(&mut picture, 4, frame.height() as isize + 1, line, INK);
    picture
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_of_unlike_height_stand_in_a_row() {
        let view = Picture::filled(160, 120, [200, 0, 0]);
        let map = Picture::filled(50, 240, [0, 200, 0]);
        let sheet = side_by_side(
            &[Panel::new(&view, "colour"), Panel::new(&map, "automap that is wider than its view")],
            2,
        );
        assert_eq!((sheet.width() % 2, sheet.height() % 2), (0, 0));
        assert_eq!(sheet.get(GAP, GAP), [200, 0, 0]);
        assert_eq!(sheet.get(GAP + 320 + GAP, GAP), [0, 200, 0]);
        assert_eq!(sheet.width(), 320 + 50 + 3 * GAP);
        assert_eq!(sheet.height(), 240 + text::LINE_HEIGHT + 2 + 2 * GAP);
    }

    #[test]
    fn a_grid_has_its_rows() {
        let view = Picture::filled(8, 8, [1; 3]);
        let sheet = grid(&vec![Panel::new(&view, ""); 5], 2, 1);
        assert_eq!((sheet.width(), sheet.height()), (2 * 8 + 3 * GAP, 3 * (8 + GAP) + GAP));
    }
}
