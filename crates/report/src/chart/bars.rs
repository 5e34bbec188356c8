//! Bars with intervals.

use super::axis::{Axis, draw_vertical_axis, short, ticks};
use super::{Anchor, Drawing, Ink, Shape, text_width};

/// A bar.
#[derive(Clone, Debug)]
pub struct Bar {
    /// Its name in the pointer box.
    pub name: String,
    /// Its height.
    pub value: f64,
    /// Lower and upper end of its interval.
    pub interval: Option<(f64, f64)>,
    /// Its colour.
    pub ink: Ink,
    /// Pale: a published value beside ours.
    pub pale: bool,
}

/// Bars that stand together over one name.
#[derive(Clone, Debug)]
pub struct BarGroup {
    /// The name.
    pub name: String,
    /// The bars.
    pub bars: Vec<Bar>,
    /// The budget that they are held to: a dashed line across the group.
    pub budget: Option<f64>,
}

/// Rows of names below a panel at most.
const MAX_ROWS: usize = 4;
/// Size of the names' letters, and the least room between two names of a row.
const LETTERS: f64 = 11.0;
const GAP: f64 = 5.0;

/// In how many rows names stand whole, by turns: the fewest in which none runs into the next of its
/// row; `None` where even the most rows are too few. Names are their middles and widths.
fn rows_of(names: &[(f64, f64)]) -> Option<usize> {
    let apart =
        |one: &(f64, f64), next: &(f64, f64)| next.0 - next.1 / 2.0 - (one.0 + one.1 / 2.0) >= GAP;
    let fits = |rows: &usize| {
        names.iter().zip(names.iter().skip(*rows)).all(|(one, next)| apart(one, next))
    };
    (1..=MAX_ROWS).find(fits)
}

/// Draws groups of bars.
#[must_use]
pub fn bar_panel(title: &str, groups: &[BarGroup], size: (f64, f64)) -> Drawing {
    let (width, height) = size;
    let mut drawing = Drawing::new(width, height);
    let (left, top, right) = (46.0, 26.0, width - 4.0);
    let slots: f64 = groups.iter().map(|group| group.bars.len() as f64 + 0.8).sum();
    let slot = ((right - left) / slots.max(1.0)).min(46.0);
    let room = |group: &BarGroup| (group.bars.len() as f64 + 0.8) * slot;
    // A name stands below the middle of its bars, but within the picture.
    let within = |middle: f64, wide: f64| middle.min(width - 1.0 - wide / 2.0).max(wide / 2.0);
    let mut from = left;
    let place = |group: &BarGroup| {
        let middle = from + room(group) / 2.0;
        from += room(group);
        let wide = text_width(&group.name, LETTERS);
        (within(middle, wide), wide)
    };
    let names: Vec<(f64, f64)> = groups.iter().map(place).collect();
    let whole = rows_of(&names);
    let rows = whole.unwrap_or(MAX_ROWS);
    let bottom = height - 9.0 - 13.0 * rows as f64;
    let title = Shape::Text {
        at: (left, 14.0),
        anchor: Anchor::Start,
        size: 12.0,
        ink: Ink::Text,
        bold: true,
        text: title.into(),
    };
    drawing.shapes.push(title);
    let bars = || groups.iter().flat_map(|group| &group.bars);
    let budgets = groups.iter().filter_map(|group| group.budget);
    // An interval of two or three seeds can be many times its mean; it is cut rather than squash
    // all bars.
    let reach = |bar: &Bar| {
        bar.interval.map_or(bar.value, |(_, high)| high.min(bar.value.abs() * 2.0).max(bar.value))
    };
    let high = bars().map(reach).chain(budgets).fold(0.0, f64::max);
    let low = bars().map(|bar| bar.value).fold(0.0, f64::min);
    let values = ticks(low, if high > low { high } else { low + 1.0 }, 4);
    let axis = Axis { from: values[0], to: values[values.len() - 1], start: bottom, end: top };
    draw_vertical_axis(&mut drawing, &axis, &values, left, right);
    let mut x = left + 0.4 * slot;
    for (index, group) in groups.iter().enumerate() {
        let from = x;
        for bar in &group.bars {
            let (zero, end) = (axis.place(0.0), axis.place(bar.value));
            let interval = bar.interval.map_or_else(String::new, |(low, high)| {
                format!(" (95 % interval {low:.2} to {high:.2})")
            });
            drawing.shapes.push(Shape::Box {
                place: [x + 1.0, zero.min(end), slot - 2.0, (zero - end).abs().max(1.0)],
                ink: bar.ink,
                opacity: if bar.pale { 0.35 } else { 0.9 },
                title: format!("{} - {}: {:.2}{interval}", group.name, bar.name, bar.value),
            });
            if let Some((low, high)) = bar.interval {
                let middle = x + slot / 2.0;
                let cap = (slot * 0.2).min(4.0);
                let mut lines = vec![vec![(middle, axis.place(low)), (middle, axis.place(high))]];
                // An end that is cut off has no cap: it is not there.
                for end in [low, high] {
                    if (axis.from..=axis.to).contains(&end) {
                        let y = axis.place(end);
                        lines.push(vec![(middle - cap, y), (middle + cap, y)]);
                    }
                }
                for points in lines {
                    drawing.shapes.push(Shape::Line {
                        points,
                        ink: Ink::Text,
                        width: 1.2,
                        dashed: false,
                        opacity: 0.9,
                    });
                }
            }
            x += slot;
        }
        if let Some(budget) = group.budget {
            let y = axis.place(budget);
            let ends = vec![(from - 0.3 * slot, y), (x + 0.3 * slot, y)];
            drawing.shapes.push(Shape::Line {
                points: ends,
                ink: Ink::Budget,
                width: 1.4,
                dashed: true,
                opacity: 1.0,
            });
        }
        // A name that does not fit even so is cut; the pointer box has it whole.
        let mut name = group.name.clone();
        let longest = if whole.is_some() { width - 2.0 } else { rows as f64 * room(group) - GAP };
        while text_width(&name, LETTERS) > longest && name.chars().count() > 2 {
            name.pop();
        }
        let y = bottom + 15.0 + 13.0 * (index % rows) as f64;
        let middle = within((from + x) / 2.0, text_width(&name, LETTERS));
        drawing.text((middle, y), Anchor::Middle, Ink::Muted, name);
        x += 0.8 * slot;
    }
    if groups.iter().all(|group| group.bars.is_empty()) {
        drawing.text(
            ((left + right) / 2.0, (top + bottom) / 2.0),
            Anchor::Middle,
            Ink::Muted,
            format!("no value ({})", short(0.0)),
        );
    }
    drawing
}
