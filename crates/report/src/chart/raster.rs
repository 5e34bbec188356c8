//! Figures as pixels.

use super::{Anchor, Drawing, Ink, SERIES_COLOURS, Shape};
use hasard_media::{Picture, text};
use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, Rect, Stroke, StrokeDash,
    Transform,
};

/// Pixels for a CSS pixel: letters of 11 CSS pixels are then as large as the 16-pixel font.
const SCALE: f64 = 1.5;
/// Margin around the figure, in CSS pixels.
const MARGIN: f64 = 8.0;
/// Largest side in pixels.
const MAX_SIDE: f64 = 16_000.0;

/// Light colours of the inks, the same as in `ink.css` (a test holds them together).
pub(super) const LIGHT: [[u8; 3]; SERIES_COLOURS + 5] = [
    [0x1f, 0x66, 0xc4],
    [0xd9, 0x76, 0x06],
    [0x1c, 0x8f, 0x55],
    [0xcf, 0x4a, 0x9a],
    [0x7a, 0x4f, 0xc2],
    [0x0b, 0x93, 0xa3],
    [0x8a, 0x66, 0x42],
    [0x7d, 0x85, 0x1a],
    [0x5d, 0x6b, 0x7a],
    [0xa8, 0x43, 0x34],
    [0x3c, 0x4f, 0xa0],
    [0x5c, 0xa8, 0x2e],
    [0xb0, 0x8a, 0x00],
    [0x1c, 0x22, 0x2b],
    [0x5a, 0x65, 0x73],
    [0xc9, 0xd0, 0xd8],
    [0xd0, 0x2b, 0x2b],
    [0xff, 0xff, 0xff],
];

pub(super) fn colour(ink: Ink) -> [u8; 3] {
    match ink {
        Ink::Series(index) => LIGHT[index % SERIES_COLOURS],
        Ink::Text => LIGHT[SERIES_COLOURS],
        Ink::Muted => LIGHT[SERIES_COLOURS + 1],
        Ink::Grid => LIGHT[SERIES_COLOURS + 2],
        Ink::Budget => LIGHT[SERIES_COLOURS + 3],
    }
}

/// Draws a figure in its light colours; `None` if it is empty or far too large.
#[must_use]
pub fn rasterise(drawing: &Drawing) -> Option<Picture> {
    let (width, height) =
        ((drawing.width + 2.0 * MARGIN) * SCALE, (drawing.height + 2.0 * MARGIN) * SCALE);
    if !(width <= MAX_SIDE && height <= MAX_SIDE) {
        return None;
    }
    let mut pixels = Pixmap::new(width.ceil() as u32, height.ceil() as u32)?;
    pixels.fill(Color::WHITE);
    let place = Transform::from_translate(MARGIN as f32, MARGIN as f32)
        .post_scale(SCALE as f32, SCALE as f32);
    let mut texts = Vec::new();
    for shape in &drawing.shapes {
        match shape {
            Shape::Line { points, ink, width, dashed, opacity } => {
                if let Some(path) = path(points, false) {
                    let stroke = Stroke {
                        width: *width as f32,
                        line_cap: LineCap::Butt,
                        line_join: LineJoin::Round,
                        dash: dashed.then(|| StrokeDash::new(vec![5.0, 4.0], 0.0)).flatten(),
                        ..Stroke::default()
                    };
                    pixels.stroke_path(&path, &paint(*ink, *opacity), &stroke, place, None);
                }
            }
            Shape::Area { points, ink, opacity } => {
                if let Some(path) = path(points, true) {
                    pixels.fill_path(&path, &paint(*ink, *opacity), FillRule::Winding, place, None);
                }
            }
            Shape::Box { place: [x, y, w, h], ink, opacity, .. } => {
                if let Some(rect) = Rect::from_xywh(*x as f32, *y as f32, *w as f32, *h as f32) {
                    pixels.fill_rect(rect, &paint(*ink, *opacity), place, None);
                }
            }
            Shape::Dot { at, radius, ink, .. } => {
                if let Some(path) =
                    PathBuilder::from_circle(at.0 as f32, at.1 as f32, *radius as f32)
                {
                    pixels.fill_path(&path, &paint(*ink, 1.0), FillRule::Winding, place, None);
                }
            }
            Shape::Text { at, anchor, ink, text, .. } => texts.push((*at, *anchor, *ink, text)),
        }
    }
    let rgb = pixels.data().chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    let mut picture =
        Picture::from_rgb(pixels.width() as usize, pixels.height() as usize, rgb).ok()?;
    for (at, anchor, ink, line) in texts {
        let width = text::width(line) as f64;
        let x = (at.0 + MARGIN) * SCALE
            - match anchor {
                Anchor::Start => 0.0,
                Anchor::Middle => width / 2.0,
                Anchor::End => width,
            };
        // The font's base line lies three quarters down its cell.
        let y = (at.1 + MARGIN) * SCALE - text::LINE_HEIGHT as f64 * 0.78;
        text::draw(&mut picture, x.round() as isize, y.round() as isize, line, colour(ink));
    }
    Some(picture)
}

fn paint(ink: Ink, opacity: f64) -> Paint<'static> {
    let [r, g, b] = colour(ink);
    let mut paint = Paint::default();
    paint.set_color_rgba8(r, g, b, (opacity * 255.0).round() as u8);
    paint.anti_alias = true;
    paint
}

fn path(points: &[(f64, f64)], closed: bool) -> Option<tiny_skia::Path> {
    let mut builder = PathBuilder::new();
    let (first, rest) = points.split_first()?;
    builder.move_to(first.0 as f32, first.1 as f32);
    for point in rest {
        builder.line_to(point.0 as f32, point.1 as f32);
    }
    if closed {
        builder.close();
    }
    builder.finish()
}
