//! Figures: shapes on a plane, drawn as SVG for pages and as pixels for PNG files.

mod axis;
mod bars;
mod font;
mod lines;
mod pdf;
mod raster;
mod scatter;
mod svg;

pub use bars::{Bar, BarGroup, bar_panel};
pub use lines::{LinePanel, Series, line_panel};
pub use pdf::pdf;
pub use raster::rasterise;
pub use scatter::{Spot, SpotKind, scatter_panel};
pub use svg::{INK_STYLE, inline_svg, standalone_svg};

/// What a shape is drawn with. Pages give each a light and a dark colour.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Ink {
    /// Letters.
    Text,
    /// Letters of less weight.
    Muted,
    /// Grid and axes.
    Grid,
    /// The budget.
    Budget,
    /// The n-th series; colours repeat after [`SERIES_COLOURS`].
    Series(usize),
}

/// Series that have a colour of their own.
pub const SERIES_COLOURS: usize = 13;

/// Where a text stands relative to its point.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Anchor {
    /// It begins there.
    Start,
    /// Its middle is there.
    Middle,
    /// It ends there.
    End,
}

/// A shape, in CSS pixels.
#[derive(Clone, PartialEq, Debug)]
pub enum Shape {
    /// Straight lines through points.
    Line {
        /// The points.
        points: Vec<(f64, f64)>,
        /// Colour.
        ink: Ink,
        /// Width.
        width: f64,
        /// Dashed or whole.
        dashed: bool,
        /// 0 to 1.
        opacity: f64,
    },
    /// A filled polygon.
    Area {
        /// Its corners.
        points: Vec<(f64, f64)>,
        /// Colour.
        ink: Ink,
        /// 0 to 1.
        opacity: f64,
    },
    /// A filled rectangle that says something when pointed at.
    Box {
        /// Left, top, width, height.
        place: [f64; 4],
        /// Colour.
        ink: Ink,
        /// 0 to 1.
        opacity: f64,
        /// What it says.
        title: String,
    },
    /// A filled circle that says something when pointed at.
    Dot {
        /// Its middle.
        at: (f64, f64),
        /// Its radius.
        radius: f64,
        /// Colour.
        ink: Ink,
        /// What it says.
        title: String,
    },
    /// A line of text; its base line lies at the point.
    Text {
        /// The point.
        at: (f64, f64),
        /// Where the text stands from it.
        anchor: Anchor,
        /// Height of letters.
        size: f64,
        /// Colour.
        ink: Ink,
        /// Bold or not.
        bold: bool,
        /// The text.
        text: String,
    },
}

/// Values to show beside the pointer over a panel of curves.
#[derive(Clone, PartialEq, Debug)]
pub struct Hover {
    /// Left, top, width, height of the plot.
    pub place: [f64; 4],
    /// Value at the plot's left and right.
    pub horizontal: (f64, f64),
    /// What is counted along it.
    pub axis: String,
    /// Name, colour and points (x, mean, half width of the interval or `None`, n) of each curve.
    pub curves: Vec<HoverCurve>,
}

/// A curve's values for [`Hover`].
#[derive(Clone, PartialEq, Debug)]
pub struct HoverCurve {
    /// The curve's name in the legend.
    pub name: String,
    /// Its colour.
    pub ink: Ink,
    /// x, mean, half width of the interval, n.
    pub points: Vec<(f64, f64, Option<f64>, usize)>,
}

/// A figure.
#[derive(Clone, PartialEq, Debug)]
pub struct Drawing {
    /// Width.
    pub width: f64,
    /// Height.
    pub height: f64,
    /// The shapes, the last on top.
    pub shapes: Vec<Shape>,
    /// Panels that show values.
    pub hovers: Vec<Hover>,
}

impl Drawing {
    /// An empty figure.
    #[must_use]
    pub fn new(width: f64, height: f64) -> Drawing {
        Drawing { width, height, shapes: Vec::new(), hovers: Vec::new() }
    }

    /// Lays another figure into this one.
    pub fn place(&mut self, other: Drawing, x: f64, y: f64) {
        let moved = |(px, py): (f64, f64)| (px + x, py + y);
        self.shapes.extend(other.shapes.into_iter().map(|shape| match shape {
            Shape::Line { points, ink, width, dashed, opacity } => Shape::Line {
                points: points.into_iter().map(moved).collect(),
                ink,
                width,
                dashed,
                opacity,
            },
            Shape::Area { points, ink, opacity } => {
                Shape::Area { points: points.into_iter().map(moved).collect(), ink, opacity }
            }
            Shape::Box { place: [left, top, w, h], ink, opacity, title } => {
                Shape::Box { place: [left + x, top + y, w, h], ink, opacity, title }
            }
            Shape::Dot { at, radius, ink, title } => {
                Shape::Dot { at: moved(at), radius, ink, title }
            }
            Shape::Text { at, anchor, size, ink, bold, text } => {
                Shape::Text { at: moved(at), anchor, size, ink, bold, text }
            }
        }));
        self.hovers.extend(other.hovers.into_iter().map(|mut hover| {
            hover.place[0] += x;
            hover.place[1] += y;
            hover
        }));
    }

    /// Adds a text of the usual size.
    pub fn text(&mut self, at: (f64, f64), anchor: Anchor, ink: Ink, text: impl Into<String>) {
        self.shapes.push(Shape::Text {
            at,
            anchor,
            size: 11.0,
            ink,
            bold: false,
            text: text.into(),
        });
    }
}

/// Panels in rows, with a title above and a legend below.
#[must_use]
pub fn figure(
    title: &str,
    panels: Vec<Drawing>,
    columns: usize,
    legend: &[(String, Ink)],
) -> Drawing {
    const GAP: f64 = 16.0;
    let columns = columns.clamp(1, panels.len().max(1));
    let width = panels
        .chunks(columns)
        .map(|row| row.iter().map(|panel| panel.width + GAP).sum::<f64>() - GAP)
        .fold(0.0, f64::max);
    let mut drawing = Drawing::new(width, 0.0);
    let mut y = 0.0;
    if !title.is_empty() {
        drawing.shapes.push(Shape::Text {
            at: (0.0, 15.0),
            anchor: Anchor::Start,
            size: 14.0,
            ink: Ink::Text,
            bold: true,
            text: title.into(),
        });
        y = 24.0;
    }
    let mut panels = panels.into_iter().peekable();
    while panels.peek().is_some() {
        let (mut x, mut tallest) = (0.0, 0.0f64);
        for panel in panels.by_ref().take(columns) {
            tallest = tallest.max(panel.height);
            let step = panel.width + GAP;
            drawing.place(panel, x, y);
            x += step;
        }
        y += tallest + GAP / 2.0;
    }
    let mut x = 4.0;
    if !legend.is_empty() {
        y += 6.0;
    }
    for (name, ink) in legend {
        let entry_width = 26.0 + text_width(name, 11.0) + 14.0;
        if x > 4.0 && x + entry_width > width {
            x = 4.0;
            y += 18.0;
        }
        drawing.shapes.push(Shape::Line {
            points: vec![(x, y + 5.0), (x + 20.0, y + 5.0)],
            ink: *ink,
            width: if *ink == Ink::Budget { 1.5 } else { 3.0 },
            dashed: *ink == Ink::Budget,
            opacity: 1.0,
        });
        drawing.text((x + 26.0, y + 9.0), Anchor::Start, Ink::Text, name);
        x += entry_width;
    }
    drawing.height = y + if legend.is_empty() { 0.0 } else { 18.0 };
    drawing
}

/// About how wide a text is in the page's font.
#[must_use]
pub fn text_width(text: &str, size: f64) -> f64 {
    text.chars().count() as f64 * size * 0.58
}

#[cfg(test)]
mod tests;
