//! Over environments: inter-quartile mean, optimality gap, performance profiles, probability of
//! improvement.

use super::baselines::{Baselines, Score};
use super::{distinct, main_groups};
use crate::chart::{Ink, LinePanel, Series, figure, line_panel};
use crate::curve::{Curve, Point};
use crate::document::{Block, Cell, Figure, Section, Table, number, slug};
use crate::group::{Group, algorithm_order};
use crate::statistics::{
    Aggregate, Estimate, RESAMPLES, aggregate, aggregate_pair, aggregates, interquartile_mean,
    optimality_gap, performance_profile, probability_of_improvement,
};

/// Thresholds of the profiles: 0, 0.05, ... 1.2.
const THRESHOLDS: usize = 24;

/// Scores of an algorithm on a level: a list of seeds for each environment.
type Strata = Vec<Vec<f64>>;

/// An algorithm on a level: its place, its name, its normalised returns and feasible scores.
type Scored = (usize, String, Strata, Strata);

pub(super) fn section(groups: &[Group], baselines: &Baselines) -> Section {
    let settings = main_groups(groups);
    let mut blocks = Vec::new();
    for (setting, members) in &settings {
        let (mut rows, mut of_some) = (Vec::new(), Vec::new());
        let mut later = Vec::new();
        for level in distinct(members, |group| group.config().level) {
            let here: Vec<&Group> =
                members.iter().copied().filter(|group| group.config().level == level).collect();
            let environments = distinct(&here, |group| group.config().env.clone());
            let mut scored: Vec<Scored> = Vec::new();
            for (order, algo) in distinct(&here, |group| {
                (algorithm_order(&group.config().algo), group.config().algo.clone())
            }) {
                let strata = |of: fn(&Score) -> f64| -> Strata {
                    environments
                        .iter()
                        .map(|env| {
                            let own = here.iter().find(|group| {
                                group.config().env == *env && group.config().algo == algo
                            });
                            own.map_or_else(Vec::new, |group| {
                                baselines.scores(group).iter().map(of).collect()
                            })
                        })
                        .collect()
                };
                let (returns, feasible) =
                    (strata(|score| score.normalised), strata(|score| score.feasible));
                if returns.iter().any(|seeds| !seeds.is_empty()) {
                    scored.push((order, algo, returns, feasible));
                }
            }
            // A mean over easy environments is no rank among means over all of them.
            let mut algorithms: Vec<Scored> = Vec::new();
            for (index, places) in environment_sets(&scored).into_iter().enumerate() {
                let beside: Vec<Scored> =
                    scored.iter().filter_map(|one| within(one, &places)).collect();
                let table = beside.iter().map(|one| row(level, one)).collect::<Vec<_>>();
                if index == 0 {
                    rows.extend(table);
                    algorithms = beside;
                } else {
                    let names: Vec<&str> =
                        places.iter().map(|&place| &*environments[place]).collect();
                    of_some.push((format!("{setting}; {} alone", names.join(", ")), table));
                }
            }
            if algorithms.is_empty() {
                continue;
            }
            let name = if settings.len() > 1 {
                format!("profiles level {level} {setting}")
            } else {
                format!("profiles level {level}")
            };
            later.push(Block::Figure(profiles(&algorithms, &slug(&name), level)));
            if algorithms.len() > 1 {
                later.push(Block::Table(improvement(&algorithms, level)));
            }
        }
        if !rows.is_empty() {
            let heads = [
                "level",
                "algorithm",
                "IQM of feasible score",
                "IQM of return",
                "optimality gap",
                "environments",
            ];
            let heads = heads.map(String::from).to_vec();
            for (caption, rows) in [(setting.clone(), rows)].into_iter().chain(of_some) {
                let table = Table { caption, heads: heads.clone(), rows, ..Table::default() };
                blocks.push(Block::Table(table));
            }
            blocks.append(&mut later);
        }
    }
    Section {
        slug: "aggregates".into(),
        title: "Over environments".into(),
        text: vec![
            format!(
                "Over all seeds and environments of a level: inter-quartile mean (IQM) of the feasible score; IQM and optimality gap (how far \
                 below 1 on average) of the normalised return, in which a random policy is 0 and PPO is 1, both measured here. Intervals: 95 % of \
                 {RESAMPLES} bootstrap samples that draw seeds within each environment (stratified), from a fixed random stream; of two or \
                 three seeds an environment they are too narrow. There are none where an environment has a single seed. Algorithms that were run \
                 in some of the environments alone stand in a table of these, beside the others there."
            ),
            "The normalised return takes no notice of costs, the feasible score counts seeds above their budget as 0. Profiles: the \
             share of seeds above each score. Probability of improvement: that a seed of the row's algorithm has a higher feasible score \
             than one of the column's on the same environment, ties counting half (Agarwal et al. 2021)."
                .into(),
        ],
        blocks,
    }
}

/// The sets of environments that the algorithms have scores in, by their places: the largest first.
fn environment_sets(algorithms: &[Scored]) -> Vec<Vec<usize>> {
    let mut sets: Vec<Vec<usize>> = algorithms.iter().map(places).collect();
    sets.sort_by(|a, b| b.len().cmp(&a.len()).then(a.cmp(b)));
    sets.dedup();
    sets
}

/// The places of the environments that an algorithm has scores in.
fn places((_, _, returns, _): &Scored) -> Vec<usize> {
    (0..returns.len()).filter(|&place| !returns[place].is_empty()).collect()
}

/// An algorithm in these environments alone; `None` where it has no scores in one of them.
fn within(one: &Scored, here: &[usize]) -> Option<Scored> {
    let own = places(one);
    let strata = |of: &Strata| here.iter().map(|&place| of[place].clone()).collect();
    let (order, name, returns, feasible) = one;
    here.iter()
        .all(|place| own.contains(place))
        .then(|| (*order, name.clone(), strata(returns), strata(feasible)))
}

fn row(level: u32, (order, algo, returns, feasible): &Scored) -> Vec<Cell> {
    let iqm = aggregate(returns, interquartile_mean);
    vec![
        Cell::number(f64::from(level)).with_text(level.to_string()),
        Cell { sort: Some(*order as f64), ..Cell::text(algo) },
        cell(aggregate(feasible, interquartile_mean)),
        cell(iqm),
        cell(aggregate(returns, |samples| optimality_gap(samples, 1.0))),
        Cell::number(iqm.map_or(0.0, |one| one.strata as f64))
            .with_text(iqm.map_or(0, |one| one.strata).to_string()),
    ]
}

fn cell(estimate: Option<Aggregate>) -> Cell {
    let Some(estimate) = estimate else {
        return Cell { text: "-".into(), pale: true, ..Cell::default() };
    };
    let interval = estimate
        .interval
        .map_or_else(String::new, |(low, high)| format!(" [{}, {}]", number(low), number(high)));
    Cell {
        text: format!("{}{interval}", number(estimate.value)),
        note: format!("n={}", estimate.n),
        sort: Some(estimate.value),
        ..Cell::default()
    }
}

/// Performance profiles of normalised return and of feasible score, each with its bootstrap band.
fn profiles(algorithms: &[Scored], file: &str, level: u32) -> Figure {
    let panel = |title: &str, axis: &str, of: fn(&Scored) -> &Strata| {
        let series = algorithms.iter().map(|one| Series {
            name: one.1.clone(),
            ink: Ink::Series(one.0),
            curve: profile(of(one)),
            behind: false,
        });
        let size = (480.0, 260.0);
        line_panel(&LinePanel {
            title: title.into(),
            axis: axis.into(),
            series: series.collect(),
            budget: None,
            size,
        })
    };
    let panels = vec![
        panel("share of seeds above a feasible score", "feasible score", |one| &one.3),
        panel("share of seeds above a normalised return", "normalised return", |one| &one.2),
    ];
    let legend: Vec<(String, Ink)> =
        algorithms.iter().map(|one| (one.1.clone(), Ink::Series(one.0))).collect();
    Figure {
        slug: file.to_owned(),
        caption: format!("Performance profiles, level {level}; bands: 95 % of bootstrap samples"),
        drawing: figure("", panels, 2, &legend),
    }
}

fn profile(strata: &Strata) -> Curve {
    let thresholds: Vec<f64> =
        (0..=THRESHOLDS).map(|step| 1.2 * step as f64 / THRESHOLDS as f64).collect();
    let shares = aggregates(strata, |samples| {
        thresholds
            .iter()
            .map(|threshold| performance_profile(samples, *threshold))
            .collect::<Option<Vec<f64>>>()
    });
    let point = |(frames, share): (&f64, Aggregate)| {
        let value = Estimate { mean: share.value, half_width: None, n: share.n };
        Point { frames: *frames, value, band: share.interval }
    };
    let mean: Vec<Point> = thresholds.iter().zip(shares.unwrap_or_default()).map(point).collect();
    let points = mean.iter().map(|point| (point.frames, point.value.mean)).collect();
    Curve { mean, seeds: vec![(0, points)] }
}

/// Probability of improvement of each algorithm over each other.
fn improvement(algorithms: &[Scored], level: u32) -> Table {
    let mut heads = vec!["P(row > column)".to_owned()];
    heads.extend(algorithms.iter().map(|one| one.1.clone()));
    let rows = algorithms.iter().map(|one| {
        let mut row = vec![Cell { sort: Some(one.0 as f64), ..Cell::text(&one.1) }];
        row.extend(algorithms.iter().map(|other| {
            if one.1 == other.1 {
                return Cell { text: "-".into(), pale: true, ..Cell::default() };
            }
            Cell {
                note: String::new(),
                ..cell(aggregate_pair(&one.3, &other.3, probability_of_improvement))
            }
        }));
        row
    });
    let caption = format!("Probability of improvement in feasible score, level {level}");
    Table { caption, heads, rows: rows.collect(), ..Table::default() }
}
