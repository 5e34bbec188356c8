//! The values that the paper prints, and when they may stand beside a run.

mod curves;
mod notes;

pub use curves::published_curve;

use crate::group::Group;
use crate::run::Config;
use std::sync::LazyLock;

/// A cell of one of the paper's tables.
#[derive(Clone, PartialEq, Debug)]
pub struct Published {
    /// `main`, `trpo`, `hard`, `full-actions`, `cost-scale`, `curriculum` or `human`.
    pub table: String,
    /// Level.
    pub level: u32,
    /// Algorithm, or `Human`.
    pub algorithm: String,
    /// Cost scale or curriculum, where the table varies it.
    pub option: String,
    /// Scenario.
    pub scenario: String,
    /// Return of the environment: the printed one, corrected where the paper's scripts added back
    /// the wrong penalty.
    pub episode_return: f64,
    /// Return as printed.
    pub printed_return: f64,
    /// Cost.
    pub cost: f64,
    /// What to know about it.
    pub notes: Vec<String>,
}

impl Published {
    /// Frames that it was trained for.
    #[must_use]
    pub fn frames(&self) -> f64 {
        if ["hard", "curriculum"].contains(&self.table.as_str()) { 3e8 } else { 5e8 }
    }

    /// Its notes in one line.
    #[must_use]
    pub fn note(&self) -> String {
        self.notes.join("; ")
    }
}

/// Every cell, from `data/published.csv` (see the README beside it).
static PUBLISHED: LazyLock<Vec<Published>> = LazyLock::new(|| {
    include_str!("../../data/published.csv").lines().skip(1).map(parse_line).collect()
});

/// A line of the file is part of the program: one that cannot be read is a fault of the build,
/// which the tests find.
fn parse_line(line: &str) -> Published {
    let fields: Vec<&str> = line.split(',').collect();
    let number = |at: usize| fields[at].parse::<f64>().ok();
    let (printed_return, cost) = (number(5).unwrap_or(f64::NAN), number(6).unwrap_or(f64::NAN));
    // The scripts added 1.0 x cost to a return from which scale x cost had been taken. Rounding
    // must not make a return that cannot be negative so.
    let corrected = number(7)
        .filter(|scale| *scale != 1.0)
        .map(|scale| (printed_return + (scale - 1.0) * cost).max(0.0));
    let mut cell = Published {
        table: fields[0].to_owned(),
        level: fields[1].parse().unwrap_or(0),
        algorithm: fields[2].to_owned(),
        option: fields[3].replace(' ', ","),
        scenario: fields[4].to_owned(),
        episode_return: corrected.unwrap_or(printed_return),
        printed_return,
        cost,
        notes: Vec::new(),
    };
    cell.notes = notes::of(&cell);
    cell
}

/// Whether a run's rules are those that the paper's tables were made under.
#[must_use]
pub fn comparable(config: &Config) -> bool {
    config.rules().is_some_and(|rules| rules.eq_ignore_ascii_case("tables"))
}

/// Table and option of the paper's experiment that a run repeats, whatever its rules, preset and
/// frames.
fn experiment(config: &Config) -> Option<(&'static [&'static str], String)> {
    let option = |key: &str| config.options.get(key).map(String::as_str);
    let varied = [
        "safety_budget",
        "observation",
        "frame_stack",
        "frame_skip",
        "constraints",
        "tasks",
        "changed",
        "early_creatures",
        "init_from",
    ];
    if varied.iter().any(|key| option(key).is_some()) {
        return None;
    }
    match (
        config.hard(),
        option("full_actions").is_some(),
        option("curriculum"),
        option("cost_scale"),
    ) {
        (true, false, None, None) => Some((&["hard"], String::new())),
        (false, true, None, None) => Some((&["full-actions"], String::new())),
        (false, false, Some(levels), None) => Some((&["curriculum"], levels.to_owned())),
        (false, false, None, Some(scale)) => Some((&["cost-scale"], scale.to_owned())),
        (false, false, None, None) => Some((&["main", "trpo"], String::new())),
        _ => None,
    }
}

fn find(
    tables: &[&str],
    level: u32,
    option: &str,
    scenario: &str,
    algorithm: &str,
) -> Option<&'static Published> {
    PUBLISHED.iter().find(|cell| {
        tables.contains(&cell.table.as_str())
            && cell.level == level
            && cell.option == option
            && cell.scenario == scenario
            && cell.algorithm.eq_ignore_ascii_case(algorithm)
    })
}

fn whatever_the_rules(config: &Config) -> Option<&'static Published> {
    let (tables, option) = experiment(config)?;
    find(tables, config.level, &option, &config.scenario, &config.algo)
}

/// The published cell of an experiment, if the paper has it and the run's rules are the tables'
/// own. Preset and frames do not matter here: the reader is shown both values and under what ours
/// were made.
#[must_use]
pub fn published(config: &Config) -> Option<&'static Published> {
    whatever_the_rules(config).filter(|_| comparable(config))
}

/// The published cell to hold an experiment against where experiments that differ in `key` are
/// compared: the paper's table of that comparison if it has one.
#[must_use]
pub fn published_in(config: &Config, key: &str) -> Option<&'static Published> {
    if !comparable(config) {
        return None;
    }
    let alone = key == "curriculum" && !config.options.contains_key("curriculum");
    let special = if alone {
        find(&["curriculum"], config.level, "none", &config.scenario, &config.algo)
    } else if key == "cost_scale" {
        find(
            &["cost-scale"],
            config.level,
            &config.cost_scale.to_string(),
            &config.scenario,
            &config.algo,
        )
    } else {
        None
    };
    special.or_else(|| published(config))
}

/// The paper's human on a scenario and level.
#[must_use]
pub fn published_human(scenario: &str, level: u32) -> Option<&'static Published> {
    find(&["human"], level, "", scenario, "Human")
}

/// A number of the paper's text by its name in `data/published_figures.csv`.
#[must_use]
pub fn published_figure(name: &str) -> Option<f64> {
    let mut lines = include_str!("../../data/published_figures.csv").lines();
    lines.find_map(|line| line.strip_prefix(name)?.strip_prefix(',')?.parse().ok())
}

/// Why published values are missing beside some experiments that the paper has too; `None` if none
/// is missing.
#[must_use]
pub fn withheld(groups: &[Group]) -> Option<String> {
    let without: Vec<&Group> = groups
        .iter()
        .filter(|g| whatever_the_rules(g.config()).is_some() && !comparable(g.config()))
        .collect();
    let mut rules: Vec<&str> =
        without.iter().map(|group| group.config().rules().unwrap_or("unnamed")).collect();
    rules.sort_unstable();
    rules.dedup();
    let count = without.len();
    (count > 0).then(|| {
        format!(
            "{count} {} here ran under other rules ({}) than the paper's tables, with other costs, starts and creatures: published \
             values stand beside runs under `--rules tables` alone.",
            if count == 1 { "experiment" } else { "experiments" },
            rules.join(", ")
        )
    })
}

#[cfg(test)]
mod tests;
