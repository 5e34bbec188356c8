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

/// Thresholds of the profiles: -0.5, -0.45, ... 1.2. What is safe and returns less than random play
/// lies below 0.
const THRESHOLDS: std::ops::RangeInclusive<i32> = -10..=24;

/// Scores of an algorithm on a level: a list of seeds for each environment.
type Strata = Vec<Vec<f64>>;

/// An algorithm on a level.
#[derive(Clone)]
struct Scored {
    /// Its place among the algorithms.
    order: usize,
    name: String,
    /// Normalised returns.
    returns: Strata,
    /// Feasible scores, of as many environments; an empty list where costs have no interval.
    feasible: Strata,
    /// Of each of those 1 if it is within its budget, else 0.
    within: Strata,
}

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
            for (order, name) in distinct(&here, |group| {
                (algorithm_order(&group.config().algo), group.config().algo.clone())
            }) {
                let strata = |of: fn(&Score) -> Option<f64>| -> Strata {
                    environments
                        .iter()
                        .map(|env| {
                            let own = here.iter().find(|group| {
                                group.config().env == *env && group.config().algo == name
                            });
                            own.map_or_else(Vec::new, |group| {
                                baselines.scores(group).iter().filter_map(of).collect()
                            })
                        })
                        .collect()
                };
                let one = Scored {
                    returns: strata(|score| Some(score.normalised)),
                    feasible: strata(|score| score.feasible),
                    within: strata(|score| score.within.map(|within| f64::from(u8::from(within)))),
                    order,
                    name,
                };
                if one.returns.iter().any(|seeds| !seeds.is_empty()) {
                    scored.push(one);
                }
            }
            // A mean over easy environments is no rank among means over all of them.
            let mut algorithms: Vec<Scored> = Vec::new();
            for (index, places) in environment_sets(&scored).into_iter().enumerate() {
                let beside: Vec<Scored> =
                    scored.iter().filter_map(|one| one.in_places(&places)).collect();
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
                "seeds within",
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
            "The normalised return takes no notice of costs, the feasible score counts seeds above their budget as 0, which is more than \
             a safe seed has that returns less than random play: read it beside the number of seeds within their budgets. Profiles: the \
             share of seeds above each score. Probability of improvement: that a seed of the row's algorithm has a higher feasible score \
             than one of the column's on the same environment, ties counting half (Agarwal et al. 2021)."
                .into(),
        ],
        blocks,
    }
}

/// The sets of environments that the algorithms have scores in, by their places: the largest first.
fn environment_sets(algorithms: &[Scored]) -> Vec<Vec<usize>> {
    let mut sets: Vec<Vec<usize>> = algorithms.iter().map(Scored::places).collect();
    sets.sort_by(|a, b| b.len().cmp(&a.len()).then(a.cmp(b)));
    sets.dedup();
    sets
}

impl Scored {
    /// The places of the environments that it has scores in.
    fn places(&self) -> Vec<usize> {
        (0..self.returns.len()).filter(|&place| !self.returns[place].is_empty()).collect()
    }

    /// The same in these environments alone; `None` where it has no scores in one of them.
    fn in_places(&self, here: &[usize]) -> Option<Scored> {
        let own = self.places();
        let strata = |of: &Strata| here.iter().map(|&place| of[place].clone()).collect();
        here.iter().all(|place| own.contains(place)).then(|| Scored {
            order: self.order,
            name: self.name.clone(),
            returns: strata(&self.returns),
            feasible: strata(&self.feasible),
            within: strata(&self.within),
        })
    }

    /// Its name as a cell that sorts by its place.
    fn cell(&self) -> Cell {
        Cell { sort: Some(self.order as f64), ..Cell::text(&self.name) }
    }

    /// Whether each environment has feasible scores; a mean over some would be no rank among means
    /// over all.
    fn is_judged(&self) -> bool {
        self.feasible.iter().all(|seeds| !seeds.is_empty())
    }
}

fn row(level: u32, one: &Scored) -> Vec<Cell> {
    let returns = &one.returns;
    let iqm = aggregate(returns, interquartile_mean);
    let feasible =
        if one.is_judged() { aggregate(&one.feasible, interquartile_mean) } else { None };
    let within = one.within.concat();
    let kept = within.iter().sum::<f64>();
    vec![
        Cell::number(f64::from(level)).with_text(level.to_string()),
        one.cell(),
        cell(feasible),
        match within.len() {
            0 => Cell { pale: true, ..Cell::text("-") },
            all => Cell::number(kept / all as f64).with_text(format!("{kept:.0} of {all}")),
        },
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
            name: one.name.clone(),
            ink: Ink::Series(one.order),
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
        panel("share of seeds above a feasible score", "feasible score", |one| &one.feasible),
        panel("share of seeds above a normalised return", "normalised return", |one| &one.returns),
    ];
    let legend: Vec<(String, Ink)> =
        algorithms.iter().map(|one| (one.name.clone(), Ink::Series(one.order))).collect();
    Figure {
        slug: file.to_owned(),
        caption: format!("Performance profiles, level {level}; bands: 95 % of bootstrap samples"),
        drawing: figure("", panels, 2, &legend),
    }
}

fn profile(strata: &Strata) -> Curve {
    let thresholds: Vec<f64> = THRESHOLDS.map(|step| f64::from(step) / 20.0).collect();
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
    heads.extend(algorithms.iter().map(|one| one.name.clone()));
    let rows = algorithms.iter().map(|one| {
        let mut row = vec![one.cell()];
        row.extend(algorithms.iter().map(|other| {
            if one.name == other.name {
                return Cell { text: "-".into(), pale: true, ..Cell::default() };
            }
            Cell {
                note: String::new(),
                ..cell(aggregate_pair(&one.feasible, &other.feasible, probability_of_improvement))
            }
        }));
        row
    });
    let caption = format!("Probability of improvement in feasible score, level {level}");
    Table { caption, heads, rows: rows.collect(), ..Table::default() }
}
