//! Training curves: a metric against frames, over seeds.

use crate::group::Group;
use crate::statistics::Estimate;

/// Equal distances of frames that the longest run of a figure is divided into: about one every two
/// pixels. A curve has a point at each, however often its runs reported: reports come by the clock,
/// and a fast machine makes more of them.
const MAX_POINTS: usize = 240;

/// A point of a mean curve (or of a profile, whose thresholds stand in the place of frames).
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Point {
    /// Frames.
    pub frames: f64,
    /// Mean over the seeds, with its interval.
    pub value: Estimate,
    /// The band around it where that is not symmetric; else it follows from `value`.
    pub band: Option<(f64, f64)>,
}

impl Point {
    /// Lower and upper end of the band; `None` without one.
    #[must_use]
    pub fn ends(&self) -> Option<(f64, f64)> {
        self.band.or_else(|| self.value.half_width.map(|_| (self.value.low(), self.value.high())))
    }
}

/// A metric over the seeds of one experiment.
#[derive(Clone, PartialEq, Debug)]
pub struct Curve {
    /// Mean and interval, as far as the shortest run went: beyond, the mean would be of other seeds
    /// and jump.
    pub mean: Vec<Point>,
    /// Every seed's own curve, in full length.
    pub seeds: Vec<(u64, Vec<(f64, f64)>)>,
}

impl Curve {
    /// The curve of a metric, with points at equal distances in frames. Several reports of a seed
    /// within one distance are averaged; a seed's value at a point lies on the line between those
    /// around it. Nothing is smoothed otherwise, and no curve is stretched to the length of
    /// another.
    #[must_use]
    pub fn of(group: &Group, metric: &str) -> Curve {
        let longest = group.frames_span().1;
        let stretch = longest / MAX_POINTS as f64;
        let mut seeds = Vec::new();
        for run in &group.runs {
            let reports: Vec<(f64, f64)> =
                run.rows.iter().filter_map(|row| Some((row.frames, row.get(metric)?))).collect();
            let binned = bin(&reports, stretch, MAX_POINTS);
            if !binned.is_empty() {
                seeds.push((run.config.seed, binned));
            }
        }
        let from = seeds.iter().map(|(_, points)| points[0].0).fold(0.0, f64::max);
        let to = seeds
            .iter()
            .map(|(_, points)| points[points.len() - 1].0)
            .fold(f64::INFINITY, f64::min);
        let points = (1..MAX_POINTS).map(|point| point as f64 * longest / MAX_POINTS as f64);
        let within = points.filter(|frames| *frames > from && *frames < to);
        // Where the last seed begins and the first one ends there are points too.
        let mut grid: Vec<f64> = std::iter::once(from).chain(within).collect();
        grid.extend(Some(to).filter(|to| *to > from && to.is_finite()));
        let mean = grid
            .into_iter()
            .filter_map(|frames| {
                let values: Vec<f64> =
                    seeds.iter().filter_map(|(_, points)| interpolate(points, frames)).collect();
                Some(Point { frames, value: Estimate::of(&values)?, band: None })
            })
            .collect();
        Curve { mean, seeds }
    }

    /// The mean at `frames`, on the line between its points; `None` outside of them. Its interval
    /// is the wider one of the two points around.
    #[must_use]
    pub fn at(&self, frames: f64) -> Option<Estimate> {
        let after = self.mean.partition_point(|point| point.frames < frames);
        let right = self.mean.get(after)?;
        if right.frames == frames {
            return Some(right.value);
        }
        let left = self.mean.get(after.checked_sub(1)?)?;
        let share = (frames - left.frames) / (right.frames - left.frames);
        let half_width = match (left.value.half_width, right.value.half_width) {
            (Some(a), Some(b)) => Some(a.max(b)),
            _ => None,
        };
        let mean = left.value.mean + (right.value.mean - left.value.mean) * share;
        Some(Estimate { mean, half_width, n: left.value.n.min(right.value.n) })
    }

    /// The largest value that is worth showing: of the means and their bands, but a band of few
    /// seeds does not squash the rest, so it counts at most twice its mean's height.
    #[must_use]
    pub fn top(&self) -> f64 {
        let high = |point: &Point| point.ends().map_or(point.value.mean, |(_, high)| high);
        let means = self
            .mean
            .iter()
            .map(|point| high(point).min(point.value.mean.abs() * 2.0).max(point.value.mean));
        let seeds = self.seeds.iter().flat_map(|(_, points)| points.iter().map(|point| point.1));
        means.chain(seeds).fold(0.0, f64::max)
    }

    /// The smallest value, or 0 if none is negative.
    #[must_use]
    pub fn bottom(&self) -> f64 {
        self.seeds
            .iter()
            .flat_map(|(_, points)| points.iter().map(|point| point.1))
            .fold(0.0, f64::min)
    }
}

fn stretch_of(frames: f64, stretch: f64, stretches: usize) -> usize {
    // The end of a stretch belongs to it, so that the last report falls into the last one.
    ((frames / stretch).ceil() as usize).clamp(1, stretches) - 1
}

/// Means of frames and values in each stretch that has any.
fn bin(reports: &[(f64, f64)], stretch: f64, stretches: usize) -> Vec<(f64, f64)> {
    let mut binned: Vec<(f64, f64)> = Vec::new();
    let mut at = 0;
    while at < reports.len() {
        let index = stretch_of(reports[at].0, stretch, stretches);
        let here = reports[at..]
            .iter()
            .take_while(|report| stretch_of(report.0, stretch, stretches) == index);
        let (mut frames, mut value, mut count) = (0.0, 0.0, 0);
        for report in here {
            frames += report.0;
            value += report.1;
            count += 1;
        }
        binned.push((frames / f64::from(count), value / f64::from(count)));
        at += count as usize;
    }
    binned
}

/// The value at `frames` on the line through a seed's points; `None` outside of them.
pub(crate) fn interpolate(points: &[(f64, f64)], frames: f64) -> Option<f64> {
    let after = points.partition_point(|point| point.0 < frames);
    let right = points.get(after)?;
    if right.0 == frames {
        return Some(right.1);
    }
    let left = points.get(after.checked_sub(1)?)?;
    Some(left.1 + (right.1 - left.1) * (frames - left.0) / (right.0 - left.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::{Config, Row, Run};

    fn run(seed: u64, rows: &[(f64, f64)]) -> Run {
        let config = Config::parse(&format!(
            "{{\"env\":\"RemedyRushLevel1-v0\",\"algo\":\"PPO\",\"seed\":{seed}}}"
        ))
        .unwrap();
        let rows = rows
            .iter()
            .map(|&(frames, value)| Row::new(frames, vec![("return_mean".into(), value)]))
            .collect();
        Run {
            path: "x".into(),
            config,
            rows,
            evaluation: vec![],
            summary: None,
            selected: None,
            calibration: vec![],
            heatmaps: vec![],
        }
    }

    #[test]
    fn curves_are_neither_mixed_nor_stretched() {
        let long: Vec<_> = (1..=10).map(|k| (f64::from(k) * 100.0, f64::from(k))).collect();
        let short: Vec<_> = (1..=5).map(|k| (f64::from(k) * 100.0, f64::from(k) + 2.0)).collect();
        let curve = Curve::of(
            &Group { runs: vec![run(1, &long), run(2, &short)], shown: Default::default() },
            "return_mean",
        );
        assert_eq!(curve.seeds[0].1, long);
        assert_eq!(curve.seeds[1].1, short);
        assert_eq!((curve.mean[0].frames, curve.mean[curve.mean.len() - 1].frames), (100.0, 500.0));
        for point in &curve.mean {
            assert!(
                (point.value.mean - (point.frames / 100.0 + 1.0)).abs() < 1e-9
                    && point.value.n == 2,
                "{point:?}"
            );
        }
    }

    /// A fast machine reports ten times as often: the points are the same.
    #[test]
    fn points_do_not_depend_on_how_often_a_run_reported() {
        let of = |reports: u32| {
            let rows: Vec<_> = (0..=reports)
                .map(|k| f64::from(k) * 1e6 / f64::from(reports))
                .map(|x| (x, x / 1e5))
                .collect();
            Curve::of(
                &Group { runs: vec![run(1, &rows)], shown: Default::default() },
                "return_mean",
            )
            .mean
        };
        let (often, seldom) = (of(230), of(10));
        assert_eq!(often.len(), seldom.len());
        for (a, b) in often.iter().zip(&seldom) {
            assert!(
                a.frames == b.frames && (a.value.mean - b.value.mean).abs() < 1e-9,
                "{a:?} {b:?}"
            );
        }
    }

    #[test]
    fn long_runs_are_thinned_by_means() {
        let rows: Vec<_> =
            (1..=24_000).map(|k| (f64::from(k) * 4096.0, f64::from(k % 100))).collect();
        let curve = Curve::of(
            &Group { runs: vec![run(1, &rows)], shown: Default::default() },
            "return_mean",
        );
        assert!(
            (MAX_POINTS - 1..=MAX_POINTS + 1).contains(&curve.mean.len()),
            "{}",
            curve.mean.len()
        );
        assert!(curve.mean.iter().all(
            |point| (point.value.mean - 49.5).abs() < 1e-9 && point.value.half_width.is_none()
        ));
    }

    #[test]
    fn reports_at_unlike_frames_meet_on_the_lines_between() {
        let group = Group {
            runs: vec![
                run(1, &[(0.0, 0.0), (100.0, 10.0)]),
                run(2, &[(0.0, 0.0), (50.0, 10.0), (100.0, 10.0)]),
            ],
            shown: Default::default(),
        };
        let curve = Curve::of(&group, "return_mean");
        let at_50 = curve.mean.iter().find(|point| point.frames == 50.0).unwrap();
        assert_eq!(at_50.value.mean, 7.5);
        assert!(Curve::of(&group, "no_such").mean.is_empty());
    }
}
