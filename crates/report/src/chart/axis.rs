//! Round numbers along an axis.

use super::{Anchor, Drawing, Ink, Shape};

/// A linear axis from value to position.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    /// Values at the ends.
    pub from: f64,
    pub to: f64,
    /// Positions of the ends.
    pub start: f64,
    pub end: f64,
}

impl Axis {
    /// Position of a value, kept within a pixel of the axis.
    pub fn place(&self, value: f64) -> f64 {
        let share = ((value - self.from) / (self.to - self.from)).clamp(-0.004, 1.004);
        self.start + (self.end - self.start) * share
    }
}

/// Round values from at or below `low` to at or above `high`, about `count` of them.
pub(super) fn ticks(low: f64, high: f64, count: usize) -> Vec<f64> {
    let span = if high > low && (high - low).is_finite() { high - low } else { 1.0 };
    let rough = span / count.max(1) as f64;
    let magnitude = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0]
        .map(|factor| factor * magnitude)
        .into_iter()
        .find(|step| *step >= rough * 0.999)
        .unwrap_or(rough);
    let first = (low / step + 1e-9).floor() as i64;
    let last =
        (first..).find(|&k| k as f64 * step >= low + span - step * 1e-6).unwrap_or(first + 1);
    (first..=last).map(|k| k as f64 * step).collect()
}

/// A number as short as its axis allows: 2M, 500k, 0.25.
#[must_use]
pub(super) fn short(value: f64) -> String {
    let trim = |number: f64, unit: &str| {
        let text = format!("{number:.3}");
        let text = text.trim_end_matches('0').trim_end_matches('.');
        format!("{text}{unit}")
    };
    match value.abs() {
        size if size >= 1e9 => trim(value / 1e9, "G"),
        size if size >= 1e6 => trim(value / 1e6, "M"),
        size if size >= 1e4 => trim(value / 1e3, "k"),
        _ if value == 0.0 => "0".into(),
        size if size < 0.01 => format!("{value:.1e}"),
        _ => trim(value, ""),
    }
}

/// Writes what is counted along the horizontal axis below its middle.
pub(super) fn axis_title(drawing: &mut Drawing, title: &str, (left, right): (f64, f64), y: f64) {
    drawing.text(((left + right) / 2.0, y), Anchor::Middle, Ink::Muted, title);
}

/// Draws horizontal grid lines with their values at the left.
pub(super) fn draw_vertical_axis(
    drawing: &mut Drawing,
    axis: &Axis,
    values: &[f64],
    left: f64,
    right: f64,
) {
    for &value in values {
        let y = axis.place(value);
        let zero = value == 0.0;
        drawing.shapes.push(Shape::Line {
            points: vec![(left, y), (right, y)],
            ink: Ink::Grid,
            width: 1.0,
            dashed: false,
            opacity: if zero { 1.0 } else { 0.5 },
        });
        drawing.text((left - 6.0, y + 4.0), Anchor::End, Ink::Muted, short(value));
    }
}
