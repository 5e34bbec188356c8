//! Points on a plane, with intervals both ways.

use super::axis::{Axis, axis_title, draw_vertical_axis, short, ticks};
use super::{Anchor, Drawing, Ink, Shape};

/// A point.
#[derive(Clone, Debug)]
pub struct Spot {
    /// What it says when pointed at.
    pub name: String,
    /// Its colour.
    pub ink: Ink,
    /// Its place.
    pub at: (f64, f64),
    /// Lower and upper ends of its intervals, along x and y.
    pub intervals: [Option<(f64, f64)>; 2],
    /// What it stands for.
    pub kind: SpotKind,
}

/// What a point stands for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum SpotKind {
    /// A mean over seeds: large.
    Mean,
    /// A single seed: small.
    Seed,
    /// A published value: a pale square.
    Paper,
}

/// Draws points, the budget as a dashed vertical line, and the front: a thin line through the
/// points that no other beats in both ways (less along x, more along y).
#[must_use]
pub fn scatter_panel(
    title: &str,
    axes: (&str, &str),
    spots: &[Spot],
    budget: Option<f64>,
    size: (f64, f64),
) -> Drawing {
    let (width, height) = size;
    let mut drawing = Drawing::new(width, height);
    let (left, top, right, bottom) = (52.0, 40.0, width - 10.0, height - 36.0);
    let heading = Shape::Text {
        at: (4.0, 14.0),
        anchor: Anchor::Start,
        size: 12.0,
        ink: Ink::Text,
        bold: true,
        text: title.into(),
    };
    drawing.shapes.push(heading);
    drawing.text((4.0, 30.0), Anchor::Start, Ink::Muted, axes.1);
    axis_title(&mut drawing, axes.0, (left, right), height - 4.0);
    let span = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((0.0, 0.0), |(low, high), v| (v.min(low), v.max(high)))
    };
    let across =
        span(&mut spots.iter().map(|spot| spot.at.0).chain(budget.map(|budget| budget * 1.1)));
    let up = span(&mut spots.iter().map(|spot| spot.at.1));
    let (xs, ys) = (ticks(across.0, across.1, 4), ticks(up.0, up.1, 4));
    let horizontal = Axis { from: xs[0], to: xs[xs.len() - 1], start: left, end: right };
    let vertical = Axis { from: ys[0], to: ys[ys.len() - 1], start: bottom, end: top };
    draw_vertical_axis(&mut drawing, &vertical, &ys, left, right);
    for &x in &xs {
        let anchor = if x == horizontal.to { Anchor::End } else { Anchor::Middle };
        drawing.text((horizontal.place(x), bottom + 15.0), anchor, Ink::Muted, short(x));
    }
    let line =
        |points, ink, width, dashed, opacity| Shape::Line { points, ink, width, dashed, opacity };
    if let Some(budget) = budget {
        let x = horizontal.place(budget);
        drawing.shapes.push(line(vec![(x, top), (x, bottom)], Ink::Budget, 1.4, true, 1.0));
    }
    let means: Vec<(f64, f64)> =
        spots.iter().filter(|spot| spot.kind == SpotKind::Mean).map(|spot| spot.at).collect();
    let points =
        front(&means).into_iter().map(|(x, y)| (horizontal.place(x), vertical.place(y))).collect();
    drawing.shapes.push(line(points, Ink::Muted, 1.0, false, 0.6));
    for spot in spots {
        let (x, y) = (horizontal.place(spot.at.0), vertical.place(spot.at.1));
        if let [Some((low, high)), _] = spot.intervals {
            let points = vec![(horizontal.place(low), y), (horizontal.place(high), y)];
            drawing.shapes.push(line(points, spot.ink, 1.2, false, 0.6));
        }
        if let [_, Some((low, high))] = spot.intervals {
            drawing.shapes.push(line(
                vec![(x, vertical.place(low)), (x, vertical.place(high))],
                spot.ink,
                1.2,
                false,
                0.6,
            ));
        }
        let (ink, title) = (spot.ink, spot.name.clone());
        drawing.shapes.push(match spot.kind {
            SpotKind::Mean => Shape::Dot { at: (x, y), radius: 4.5, ink, title },
            SpotKind::Seed => Shape::Dot { at: (x, y), radius: 1.8, ink, title },
            SpotKind::Paper => {
                Shape::Box { place: [x - 4.0, y - 4.0, 8.0, 8.0], ink, opacity: 0.45, title }
            }
        });
    }
    drawing
}

/// The points that no other beats both ways, in the order of x.
fn front(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let beaten = |one: &(f64, f64)| {
        points.iter().any(|other| other.0 <= one.0 && other.1 >= one.1 && other != one)
    };
    let mut front: Vec<(f64, f64)> = points.iter().filter(|one| !beaten(one)).copied().collect();
    front.sort_by(|a, b| a.0.total_cmp(&b.0));
    front.dedup();
    front
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_holds_what_nothing_beats() {
        let points = [(50.0, 40.0), (60.0, 39.0), (5.0, 10.0), (100.0, 90.0), (5.0, 9.0)];
        assert_eq!(front(&points), [(5.0, 10.0), (50.0, 40.0), (100.0, 90.0)]);
        assert!(front(&[]).is_empty());
        let drawing = scatter_panel("t", ("cost", "return"), &[], Some(5.0), (200.0, 150.0));
        assert!(super::super::rasterise(&drawing).is_some());
    }
}
