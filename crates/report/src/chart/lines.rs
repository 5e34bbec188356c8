//! Curves with bands.

use super::axis::{Axis, axis_title, draw_vertical_axis, short, ticks};
use super::{Anchor, Drawing, Hover, HoverCurve, Ink, Shape};
use crate::curve::{Curve, Point};

/// A curve on a panel.
#[derive(Clone, Debug)]
pub struct Series {
    /// Its name in legend and pointer box.
    pub name: String,
    /// Its colour.
    pub ink: Ink,
    /// Its points.
    pub curve: Curve,
    /// Drawn behind the others, as far as they go: a thin dashed line in a faint band. Published
    /// curves are.
    pub behind: bool,
}

impl Series {
    /// The same, a published curve cut where ours end.
    fn up_to(&self, frames: f64) -> Series {
        let mut cut = self.clone();
        if self.behind {
            let end = self.curve.at(frames);
            cut.curve.mean.retain(|point| point.frames < frames);
            cut.curve.mean.extend(end.map(|value| Point { frames, value, band: None }));
        }
        cut
    }
}

/// What a panel of curves shows.
#[derive(Clone, Debug, Default)]
pub struct LinePanel {
    /// Its title.
    pub title: String,
    /// What is counted along the horizontal axis; frames if empty.
    pub axis: String,
    /// The curves.
    pub series: Vec<Series>,
    /// The budget: a dashed line across.
    pub budget: Option<f64>,
    /// Width and height of the whole panel.
    pub size: (f64, f64),
}

/// Draws curves against frames: the mean as a line, its 95 % interval as a band, every seed as a
/// thin line. Each curve ends where its runs ended.
#[must_use]
pub fn line_panel(panel: &LinePanel) -> Drawing {
    let (width, height) = panel.size;
    let mut drawing = Drawing::new(width, height);
    let (left, top, right, bottom) = (46.0, 26.0, width - 8.0, height - 36.0);
    let axis = if panel.axis.is_empty() { "frames" } else { &panel.axis };
    drawing.shapes.push(Shape::Text {
        at: (left, 14.0),
        anchor: Anchor::Start,
        size: 12.0,
        ink: Ink::Text,
        bold: true,
        text: panel.title.clone(),
    });
    let ours = || panel.series.iter().filter(|series| !series.behind).map(|series| &series.curve);
    let points = || ours().flat_map(|curve| &curve.seeds).map(|(_, points)| points);
    let most_frames = points().filter_map(|all| all.last()).map(|p| p.0).fold(0.0, f64::max);
    // Frames begin at 0; scores may lie below.
    let least = points().filter_map(|all| all.first()).map(|p| p.0).fold(0.0, f64::min);
    if most_frames <= 0.0 {
        drawing.text(
            ((left + right) / 2.0, (top + bottom) / 2.0),
            Anchor::Middle,
            Ink::Muted,
            "no report yet",
        );
        return drawing;
    }
    let cut: Vec<Series> = panel.series.iter().map(|series| series.up_to(most_frames)).collect();
    let in_order = || {
        cut.iter().filter(|series| series.behind).chain(cut.iter().filter(|series| !series.behind))
    };
    let curves = || cut.iter().map(|series| &series.curve);
    let high = curves().map(Curve::top).fold(panel.budget.unwrap_or(0.0) * 1.15, f64::max);
    let low = curves().map(Curve::bottom).fold(0.0, f64::min);
    let values = ticks(low, if high > low { high } else { low + 1.0 }, 4);
    let vertical = Axis { from: values[0], to: values[values.len() - 1], start: bottom, end: top };
    let horizontal = Axis { from: least, to: most_frames, start: left, end: right };
    draw_vertical_axis(&mut drawing, &vertical, &values, left, right);
    axis_title(&mut drawing, axis, (left, right), height - 4.0);
    let frame_ticks = ticks(least, most_frames, 4);
    for &frames in
        frame_ticks.iter().filter(|frames| (least..=most_frames * 1.001).contains(*frames))
    {
        let anchor = if frames > most_frames * 0.97 { Anchor::End } else { Anchor::Middle };
        drawing.text((horizontal.place(frames), bottom + 15.0), anchor, Ink::Muted, short(frames));
    }
    // Thin seeds below, then bands, then means, so that means stay readable.
    for series in &cut {
        if series.curve.seeds.len() > 1 || series.curve.mean.is_empty() {
            for (_, points) in &series.curve.seeds {
                drawing.shapes.push(Shape::Line {
                    points: points
                        .iter()
                        .map(|p| (horizontal.place(p.0), vertical.place(p.1)))
                        .collect(),
                    ink: series.ink,
                    width: 0.7,
                    dashed: false,
                    opacity: 0.35,
                });
            }
        }
    }
    for series in in_order() {
        let banded: Vec<(f64, (f64, f64))> = series
            .curve
            .mean
            .iter()
            .filter_map(|point| Some((horizontal.place(point.frames), point.ends()?)))
            .collect();
        let upper = banded.iter().map(|(x, (_, high))| (*x, vertical.place(*high)));
        let lower = banded.iter().rev().map(|(x, (low, _))| (*x, vertical.place(*low)));
        let points: Vec<_> = upper.chain(lower).collect();
        if points.len() > 3 {
            drawing.shapes.push(Shape::Area {
                points,
                ink: series.ink,
                opacity: if series.behind { 0.08 } else { 0.16 },
            });
        }
    }
    for series in in_order() {
        let points: Vec<_> = series
            .curve
            .mean
            .iter()
            .map(|p| (horizontal.place(p.frames), vertical.place(p.value.mean)))
            .collect();
        if let [only] = points[..] {
            drawing.shapes.push(Shape::Dot {
                at: only,
                radius: 2.5,
                ink: series.ink,
                title: series.name.clone(),
            });
        }
        let (width, opacity) = if series.behind { (1.1, 0.75) } else { (1.8, 1.0) };
        drawing.shapes.push(Shape::Line {
            points,
            ink: series.ink,
            width,
            dashed: series.behind,
            opacity,
        });
    }
    if let Some(budget) = panel.budget {
        let y = vertical.place(budget);
        drawing.shapes.push(Shape::Line {
            points: vec![(left, y), (right, y)],
            ink: Ink::Budget,
            width: 1.4,
            dashed: true,
            opacity: 1.0,
        });
        drawing.text(
            (right, y - 4.0),
            Anchor::End,
            Ink::Budget,
            format!("budget {}", short(budget)),
        );
    }
    drawing.hovers.push(Hover {
        place: [left, top, right - left, bottom - top],
        horizontal: (least, most_frames),
        axis: axis.to_owned(),
        curves: cut
            .iter()
            .map(|series| HoverCurve {
                name: series.name.clone(),
                ink: series.ink,
                points: series
                    .curve
                    .mean
                    .iter()
                    .map(|p| (p.frames, p.value.mean, p.value.half_width, p.value.n))
                    .collect(),
            })
            .collect(),
    });
    drawing
}
