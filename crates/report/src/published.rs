//! The values that the paper prints.

use crate::run::Config;
use std::sync::LazyLock;

/// A cell of one of the paper's tables.
#[derive(Clone, PartialEq, Debug)]
pub struct Published {
    /// `main`, `hard`, `full-actions`, `cost-scale` or `curriculum`.
    pub table: String,
    /// Level.
    pub level: u32,
    /// Algorithm.
    pub algorithm: String,
    /// Cost scale or curriculum, where the table varies it.
    pub option: String,
    /// Scenario.
    pub scenario: String,
    /// Return, corrected where the printed one is known to be wrong.
    pub episode_return: Option<f64>,
    /// Cost.
    pub cost: Option<f64>,
    /// What to know about it.
    pub note: String,
}

/// Every cell, from `data/published.csv` (see the README beside it).
static PUBLISHED: LazyLock<Vec<Published>> =
    LazyLock::new(|| include_str!("../data/published.csv").lines().skip(1).map(parse_line).collect());

fn parse_line(line: &str) -> Published {
    let fields = split_csv(line);
    let number = |at: usize| fields[at].parse::<f64>().ok();
    let mut note = fields[8].clone();
    if let (Some(printed), Some(_)) = (number(5), number(6)) {
        note = format!("printed as {printed}: {note}");
    }
    Published {
        table: fields[0].clone(),
        level: fields[1].parse().unwrap_or(0),
        algorithm: fields[2].clone(),
        option: fields[3].clone(),
        scenario: fields[4].clone(),
        episode_return: number(6).or(number(5)),
        cost: number(7),
        note,
    }
}

/// Splits a line of CSV with optional quotes.
fn split_csv(line: &str) -> Vec<String> {
    let (mut fields, mut quoted) = (vec![String::new()], false);
    for character in line.chars() {
        match character {
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(String::new()),
            c => fields.last_mut().expect("never empty").push(c),
        }
    }
    fields
}

/// The published cell of an experiment, if the paper has it. Rules, preset and frames do not matter here: the reader is
/// shown both values and told under what ours were made.
#[must_use]
pub fn published(config: &Config) -> Option<&'static Published> {
    let option = |key: &str| config.options.get(key).map(String::as_str);
    let (table, value) = match (config.hard(), option("full_actions").is_some(), option("curriculum"), option("cost_scale")) {
        (true, false, None, None) => ("hard", String::new()),
        (false, true, None, None) => ("full-actions", String::new()),
        (false, false, Some(levels), None) => ("curriculum", levels.to_owned()),
        (false, false, None, Some(scale)) => ("cost-scale", scale.to_owned()),
        (false, false, None, None) => ("main", String::new()),
        _ => return None,
    };
    let varied = ["safety_budget", "observation", "frame_stack", "frame_skip"].iter().any(|key| option(key).is_some());
    PUBLISHED.iter().find(|cell| {
        !varied
            && cell.table == table
            && cell.level == config.level
            && cell.option == value
            && cell.scenario == config.scenario
            && cell.algorithm.eq_ignore_ascii_case(&config.algo)
    })
}

/// The published cell to hold an experiment against where experiments that differ in `key` are compared: the paper's table
/// of that comparison if it has one.
#[must_use]
pub fn published_in(config: &Config, key: &str) -> Option<&'static Published> {
    let alone = key == "curriculum" && !config.options.contains_key("curriculum");
    let table = if alone { "curriculum" } else { "cost-scale" };
    let option = if alone { "none".to_owned() } else { config.cost_scale.to_string() };
    let special = PUBLISHED.iter().find(|cell| {
        (alone || key == "cost_scale")
            && cell.table == table
            && cell.level == config.level
            && cell.option == option
            && cell.scenario == config.scenario
            && cell.algorithm.eq_ignore_ascii_case(&config.algo)
    });
    special.or_else(|| published(config))
}

/// The main table's cell for an algorithm on a scenario and level.
#[must_use]
pub fn published_main(algorithm: &str, scenario: &str, level: u32) -> Option<&'static Published> {
    let same = |cell: &&Published| cell.scenario == scenario && cell.algorithm.eq_ignore_ascii_case(algorithm);
    PUBLISHED.iter().filter(|cell| cell.table == "main" && cell.level == level).find(same)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(extra: &str, algo: &str, env: &str) -> Option<&'static Published> {
        published(&Config::parse(&format!("{{\"env\":\"{env}\",\"algo\":\"{algo}\",\"seed\":1{extra}}}")).unwrap())
    }

    #[test]
    fn every_line_is_understood() {
        for cell in PUBLISHED.iter() {
            assert!(
                crate::group::scenario_order(&cell.scenario) < 6 && crate::group::algorithm_order(&cell.algorithm) < 13,
                "{cell:?}"
            );
            assert!((1..=3).contains(&cell.level) && cell.episode_return.is_some(), "{cell:?}");
        }
        // Four algorithms of the spec's table at each of levels 2 and 3, nine at level 1, and one cell of PPOCost.
        assert_eq!(PUBLISHED.iter().filter(|cell| cell.table == "main").count(), 6 * (9 + 4 + 4) + 1);
    }

    #[test]
    fn an_experiment_finds_its_own_cell() {
        let main = of("", "PPOLag", "RemedyRushLevel1-v0").unwrap();
        assert_eq!((main.episode_return, main.cost), (Some(36.37), Some(5.25)));
        assert_eq!(of(",\"hard\":true", "PPO", "VolcanicVentureLevel1-v0").unwrap().cost, Some(1410.0));
        assert_eq!(of(",\"full_actions\":true", "PPOLag", "RemedyRushLevel1-v0").unwrap().episode_return, Some(24.96));
        assert_eq!(of(",\"cost_scale\":0.5", "PPOCost", "PrecipicePlungeLevel1-v0").unwrap().episode_return, Some(242.04));
        assert_eq!(of(",\"curriculum\":[1,2,3]", "PPOPID", "CollateralDamageLevel1-v0").unwrap().episode_return, Some(15.32));
        assert_eq!(of(",\"safety_budget\":25", "PPOLag", "VolcanicVentureLevel1-v0"), None);
        assert_eq!(of(",\"observation\":\"segmented\"", "PPOLag", "VolcanicVentureLevel1-v0"), None);
        let alone = Config::parse("{\"env\":\"RemedyRushLevel3-v0\",\"algo\":\"PPOPID\",\"seed\":1}").unwrap();
        assert_eq!(published(&alone).unwrap().episode_return, Some(13.51));
        assert_eq!(published_in(&alone, "curriculum").unwrap().episode_return, Some(6.65));
        let cost = of("", "PPOCost", "ArmamentBurdenLevel1-v0").unwrap();
        assert_eq!(cost.episode_return, Some(2.17));
        assert!(cost.note.starts_with("printed as 5.47"));
    }
}
