//! Whether critics of costs expect what comes.

use super::{distinct, setting};
use crate::chart::{Ink, LinePanel, Series, figure, line_panel};
use crate::curve::{Curve, Point};
use crate::document::{Block, Cell, Figure, Section, Table};
use crate::group::{Group, algorithm_order, scenario_name};
use crate::run::Calibration;
use crate::statistics::Estimate;

/// A panel for each environment: observed against predicted cost to come; and a row for each
/// critic.
pub(super) fn section(groups: &[Group]) -> Section {
    let mut rows = Vec::new();
    let mut panels = Vec::new();
    let mut legend: Vec<(String, Ink)> = Vec::new();
    for env in distinct(groups, |group| group.config().env.clone()) {
        let mut series: Vec<Series> = Vec::new();
        for group in groups.iter().filter(|group| group.config().env == env) {
            let config = group.config();
            let ink = Ink::Series(algorithm_order(&config.algo));
            for run in &group.runs {
                for critic in &run.calibration {
                    rows.push(row(group, run.config.seed, critic));
                    let name = format!("{}, seed {}", config.algo, run.config.seed);
                    series.extend(curve(critic).map(|curve| Series {
                        name,
                        ink,
                        curve,
                        behind: false,
                    }));
                    if !legend.iter().any(|(known, _)| *known == config.algo) {
                        legend.push((config.algo.clone(), ink));
                    }
                }
            }
        }
        if series.is_empty() {
            continue;
        }
        let most = series
            .iter()
            .flat_map(|one| &one.curve.mean)
            .map(|point| point.frames)
            .fold(0.0, f64::max);
        let exact = [0.0, most].map(|value| point(value, value)).to_vec();
        let curve = Curve { mean: exact, seeds: Vec::new() };
        series.push(Series { name: "exact".into(), ink: Ink::Muted, curve, behind: true });
        let axis = "predicted cost to come".to_owned();
        panels.push(line_panel(&LinePanel {
            title: format!("{env}: cost that came"),
            axis,
            series,
            budget: None,
            size: (400.0, 260.0),
        }));
    }
    let heads = [
        "scenario",
        "level",
        "algorithm",
        "options",
        "seed",
        "constraint",
        "discount",
        "steps",
        "bias",
        "error",
    ];
    let table = Table { heads: heads.map(String::from).to_vec(), rows, ..Table::default() }
        .folded(&["level", "options"]);
    let mut blocks = Vec::new();
    if !panels.is_empty() {
        let caption = "A line a seed; dashed: predictions that come true".to_owned();
        blocks.push(Block::Figure(Figure {
            slug: "calibration".into(),
            caption,
            drawing: figure("", panels, 3, &legend),
        }));
    }
    if !table.rows.is_empty() {
        blocks.push(Block::Table(table));
    }
    Section {
        slug: "calibration".into(),
        title: "Calibration of cost critics".into(),
        text: vec![
            "What the selected checkpoint's critics of the costs expected at the steps of its closing episodes, against the discounted cost \
             that followed: bins of equal numbers of steps. Below the dashed line less cost came than a critic expected. Bias: mean of \
             prediction minus what came; error: root of the mean squared difference."
                .into(),
        ],
        blocks,
    }
}

fn point(predicted: f64, observed: f64) -> Point {
    Point {
        frames: predicted,
        value: Estimate { mean: observed, half_width: None, n: 1 },
        band: None,
    }
}

/// The bins as a curve; `None` without any.
fn curve(critic: &Calibration) -> Option<Curve> {
    let mean: Vec<Point> =
        critic.bins.iter().map(|bin| point(bin.predicted, bin.observed)).collect();
    let points: Vec<(f64, f64)> =
        mean.iter().map(|point| (point.frames, point.value.mean)).collect();
    (!mean.is_empty()).then(|| Curve { mean, seeds: vec![(0, points)] })
}

fn row(group: &Group, seed: u64, critic: &Calibration) -> Vec<Cell> {
    let config = group.config();
    vec![
        Cell::text(scenario_name(&config.scenario)),
        Cell::number(f64::from(config.level)).with_text(config.level.to_string()),
        Cell::text(&config.algo),
        Cell::text(setting(group)),
        Cell::number(seed as f64).with_text(seed.to_string()),
        Cell::text(critic.term.as_deref().unwrap_or("whole cost")),
        Cell::number(critic.gamma).with_text(critic.gamma.to_string()),
        Cell::number(critic.steps).with_text(format!("{:.0}", critic.steps)),
        Cell::number(critic.bias),
        Cell::number(critic.error),
    ]
}
