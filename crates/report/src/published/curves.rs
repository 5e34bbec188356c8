//! The paper's training curves as numbers (`data/published_curves.gz`; the README beside it
//! describes the format).

use super::{comparable, experiment};
use crate::curve::{Curve, Point, interpolate};
use crate::run::Config;
use crate::statistics::Estimate;
use flate2::read::GzDecoder;
use std::collections::BTreeMap;
use std::io::Read;
use std::sync::LazyLock;

/// Experiment, level, scenario, algorithm, option and metric.
type Key = (String, u32, String, String, String, String);
/// Frames, mean and half the 95 % band at each point.
type Points = Vec<(f64, f64, f64)>;

static CURVES: LazyLock<BTreeMap<Key, Points>> = LazyLock::new(|| {
    let mut text = String::new();
    // The file is part of the program; should it be damaged, the tests say so and a report goes
    // without.
    let _ = GzDecoder::new(&include_bytes!("../../data/published_curves.gz")[..])
        .read_to_string(&mut text);
    parse(&text)
});

fn parse(text: &str) -> BTreeMap<Key, Points> {
    let lines: Vec<&str> = text.lines().collect();
    lines.chunks_exact(4).filter_map(curve).collect()
}

fn curve(four: &[&str]) -> Option<(Key, Points)> {
    let head: Vec<&str> = four[0].split(' ').collect();
    let &[experiment, level, scenario, algorithm, option, metric, step] = head.as_slice() else {
        return None;
    };
    let step: f64 = step.parse().ok()?;
    let sums = |line: &str, unit: f64| {
        let mut sum = 0i64;
        line.split(' ')
            .map(|difference| {
                sum += difference.parse::<i64>().ok()?;
                Some(sum as f64 * unit)
            })
            .collect::<Option<Vec<f64>>>()
    };
    let (frames, means, halves) = (sums(four[1], 1e5)?, sums(four[2], step)?, sums(four[3], step)?);
    let points = frames
        .into_iter()
        .zip(means)
        .zip(halves)
        .map(|((frames, mean), half)| (frames, mean, half))
        .collect();
    let option = if option == "-" { "" } else { option };
    let key = [experiment, scenario, algorithm, option, metric].map(String::from);
    let [experiment, scenario, algorithm, option, metric] = key;
    Some(((experiment, level.parse().ok()?, scenario, algorithm, option, metric), points))
}

/// Seeds behind the published bands.
fn seeds(experiment: &str) -> usize {
    match experiment {
        "full-actions" => 1,
        "cost-scale" => 2,
        _ => 3,
    }
}

/// The published curve of an experiment's `return` or `cost`, if the paper has it and the run's
/// rules are the tables' own.
#[must_use]
pub fn published_curve(config: &Config, metric: &str) -> Option<Curve> {
    if !comparable(config) {
        return None;
    }
    let (tables, mut option) = experiment(config)?;
    if tables == ["full-actions"] {
        option = "full".into();
    }
    let of = |table: &str, metric: &str| {
        let key = (
            table.into(),
            config.level,
            config.scenario.clone(),
            spelled(&config.algo),
            option.clone(),
            metric.into(),
        );
        CURVES.get(&key)
    };
    tables.iter().find_map(|table| {
        let mut points = of(table, metric)?.clone();
        // PPOCost's returns were drawn with the penalty added back at scale 1, whatever its scale.
        if metric == "return" && config.cost_scale != 1.0 && *table != "hard" {
            let costs: Vec<(f64, f64)> =
                of(table, "cost")?.iter().map(|&(frames, cost, _)| (frames, cost)).collect();
            let last = costs.last()?.1;
            for point in &mut points {
                point.1 += (config.cost_scale - 1.0) * interpolate(&costs, point.0).unwrap_or(last);
            }
        }
        let n = seeds(table);
        let value = |mean, half| Estimate { mean, half_width: (n > 1).then_some(half), n };
        let mean = points
            .into_iter()
            .map(|(frames, mean, half)| Point { frames, value: value(mean, half), band: None })
            .collect();
        Some(Curve { mean, seeds: Vec::new() })
    })
}

/// An algorithm as the file spells it.
fn spelled(algo: &str) -> String {
    crate::group::ALGORITHMS
        .iter()
        .find(|known| known.eq_ignore_ascii_case(algo))
        .map_or(algo, |known| known)
        .to_owned()
}

/// All curves: how many there are, and how many points.
#[cfg(test)]
pub(super) fn size() -> (usize, usize) {
    (CURVES.len(), CURVES.values().map(Vec::len).sum())
}
