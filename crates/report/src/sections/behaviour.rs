//! What agents do: the paper says that none of its agents discards weapons, avoids decoys, seeks
//! the goggles first or pushes barrels. Scenarios count it, episodes carry the counts.

use super::setting;
use crate::document::{Block, Cell, Section, Table};
use crate::group::{Group, scenario_name};
use crate::run::{EpisodeResult, Found, scenario_and_level};
use crate::statistics::{Estimate, mean};

/// Parts of the names of the counts that the paper speaks of, and what each shows.
const CLAIMS: [(&str, &str); 4] = [
    ("discard", "weapons thrown away rather than carried"),
    ("decoy", "decoys taken though they bring nothing"),
    ("goggles", "goggles taken (first: before anything else)"),
    ("push", "barrels pushed to safer places"),
];

pub(super) fn section(found: &Found, groups: &[Group]) -> Section {
    let (mut claims, mut others) = (Vec::new(), Vec::new());
    let mut add = |who: [Cell; 4], seeds: &[&[EpisodeResult]]| {
        for name in names(seeds) {
            let claim = CLAIMS.iter().find(|(part, _)| name.contains(part));
            let mut row = who.to_vec();
            row.extend(cells(&name, claim.map_or("", |(_, what)| what), seeds));
            if claim.is_some() { &mut claims } else { &mut others }.push(row);
        }
    };
    for group in groups {
        let seeds: Vec<&[EpisodeResult]> = group
            .runs
            .iter()
            .filter(|run| !run.evaluation.is_empty())
            .map(|run| &run.evaluation[..])
            .collect();
        add(who(&group.config().env, &group.config().algo, &setting(group)), &seeds);
    }
    for (key, episodes) in &found.players {
        add(who(&key.env, &key.player, &key.options), &[episodes]);
    }
    let heads = [
        "scenario",
        "level",
        "player",
        "options",
        "count",
        "what it shows",
        "an episode",
        "in episodes",
    ];
    let table = |caption: &str, rows: Vec<Vec<Cell>>| {
        let (caption, heads) = (caption.to_owned(), heads.map(String::from).to_vec());
        (!rows.is_empty()).then(|| Block::Table(Table { caption, heads, rows, ..Table::default() }))
    };
    Section {
        slug: "behaviour".into(),
        title: "Behaviour".into(),
        text: vec![
            "Mean counts an episode (± over seeds) and the share of episodes with any. The paper reports that none of its agents \
             discards weapons, avoids decoys, seeks the goggles first or pushes barrels."
                .into(),
        ],
        blocks: table("What the paper speaks of", claims).into_iter().chain(table("Other counts", others)).collect(),
    }
}

fn who(env: &str, player: &str, options: &str) -> [Cell; 4] {
    let (scenario, level) = scenario_and_level(env);
    let level = Cell::number(f64::from(level)).with_text(level.to_string());
    [Cell::text(scenario_name(&scenario)), level, Cell::text(player), Cell::text(options)]
}

fn names(seeds: &[&[EpisodeResult]]) -> Vec<String> {
    let mut names: Vec<String> = seeds
        .iter()
        .flat_map(|episodes| *episodes)
        .flat_map(|one| &one.stats)
        .map(|(name, _)| name.clone())
        .collect();
    names.sort();
    names.dedup();
    names
}

fn cells(name: &str, what: &str, seeds: &[&[EpisodeResult]]) -> [Cell; 4] {
    let values = |episodes: &[EpisodeResult]| -> Vec<f64> {
        let of = |one: &EpisodeResult| {
            one.stats.iter().find(|(known, _)| known == name).map(|(_, value)| *value)
        };
        episodes.iter().filter_map(of).collect()
    };
    let means: Vec<f64> = seeds.iter().filter_map(|episodes| mean(&values(episodes))).collect();
    let any: Vec<f64> = seeds
        .iter()
        .flat_map(|episodes| values(episodes))
        .map(|v| f64::from(u8::from(v > 0.0)))
        .collect();
    let share = mean(&any).unwrap_or(0.0);
    [
        Cell::text(name.replace('_', " ")),
        Cell::text(what),
        Cell { note: String::new(), ..Cell::estimate(Estimate::of(&means), &means) },
        Cell::number(share).with_text(format!("{:.0} %", share * 100.0)),
    ]
}
