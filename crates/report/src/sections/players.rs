//! Humans and other players, and evaluations of trained agents: results of episodes rather than of
//! training.

use crate::document::{Block, Cell, Mark, Section, Table};
use crate::group::{Group, scenario_name, scenario_order};
use crate::published::published_human;
use crate::run::{
    Constraint, EpisodeResult, Found, Origin, PlayerKey, default_budget, scenario_and_level,
};
use crate::statistics::Estimate;
use hasard_envs::RuleSet;

/// Rollouts of policies and evaluations of trained agents.
pub(super) fn section(found: &Found, groups: &[Group]) -> Section {
    let mut rows: Vec<(String, Vec<Cell>)> = played(found, |key| key.origin == Origin::Rollout);
    for group in groups {
        for run in &group.runs {
            if !run.evaluation.is_empty() {
                let who = format!("{}, seed {}", run.config.algo, run.config.seed);
                rows.push(row(
                    &who,
                    &run.config.env,
                    &group.options_line(None),
                    &run.config.constraints,
                    &run.evaluation,
                ));
            }
        }
    }
    Section {
        slug: "players".into(),
        title: "Baselines and evaluations".into(),
        text: vec![
            "Mean over single episodes: files of rollouts, and evaluations of trained agents. n is the number of episodes, which is no \
             measure of the spread between seeds."
                .into(),
        ],
        blocks: table(rows),
    }
}

/// People's episodes, beside the paper's human where the rules are those of its tables.
pub(super) fn human(found: &Found) -> Section {
    let by_people = |key: &PlayerKey| key.origin == Origin::Recorded;
    let mut rows = played(found, by_people);
    let mut papers: Vec<(String, u32)> = found
        .players
        .keys()
        .filter(|key| {
            by_people(key) && key.options.split(", ").any(|option| option == "rules tables")
        })
        .map(|key| scenario_and_level(&key.env))
        .collect();
    papers.sort();
    papers.dedup();
    for (scenario, level) in papers {
        let Some(paper) = published_human(&scenario, level) else { continue };
        let pale = |cell: Cell| Cell { pale: true, ..cell };
        let cells = vec![
            pale(Cell::text("human (paper)")),
            pale(Cell::text(scenario_name(&scenario))),
            pale(Cell::number(f64::from(level)).with_text(level.to_string())),
            pale(Cell::text("rules tables")),
            pale(Cell { note: "n=10".into(), ..Cell::number(paper.episode_return) }),
            pale(Cell { note: "n=10".into(), ..Cell::number(paper.cost) }),
            pale(Cell::text("-")),
            pale(Cell::text("-")),
        ];
        rows.push((format!("{:02} {scenario} {level} ~", scenario_order(&scenario)), cells));
    }
    Section {
        slug: "human".into(),
        title: "Human play".into(),
        text: vec![
            "Recorded episodes, the mean over a player's episodes; n is their number. The paper's human stands beside episodes under \
             `--rules tables`."
                .into(),
        ],
        blocks: table(rows),
    }
}

fn played(found: &Found, counts: impl Fn(&PlayerKey) -> bool) -> Vec<(String, Vec<Cell>)> {
    let mut rows = Vec::new();
    for (PlayerKey { player, env, options, .. }, episodes) in
        found.players.iter().filter(|(key, _)| counts(key))
    {
        let (scenario, _) = scenario_and_level(env);
        let has = |wanted: &str| options.split(", ").any(|option| option == wanted);
        let named = |rules: &RuleSet| has(&format!("rules {}", rules.name()));
        let rules = RuleSet::ALL.into_iter().find(named).unwrap_or_default();
        let budget = if has("hard true") { 0.0 } else { default_budget(&scenario, rules) };
        rows.push(row(player, env, options, &[Constraint { term: None, budget }], episodes));
    }
    rows
}

fn table(mut rows: Vec<(String, Vec<Cell>)>) -> Vec<Block> {
    rows.sort_by(|a, b| a.0.cmp(&b.0));
    let heads = [
        "player",
        "scenario",
        "level",
        "options",
        "return",
        "cost",
        "steps",
        "episodes within budget",
    ];
    let rows: Vec<Vec<Cell>> = rows.into_iter().map(|(_, cells)| cells).collect();
    let table = Table { heads: heads.map(String::from).to_vec(), rows, ..Table::default() };
    if table.rows.is_empty() { Vec::new() } else { vec![Block::Table(table)] }
}

fn row(
    player: &str,
    env: &str,
    options: &str,
    constraints: &[Constraint],
    episodes: &[EpisodeResult],
) -> (String, Vec<Cell>) {
    let (scenario, level) = scenario_and_level(env);
    let returns: Vec<f64> = episodes.iter().map(|episode| episode.episode_return).collect();
    let costs: Vec<f64> = episodes.iter().map(|episode| episode.cost).collect();
    let lengths: Vec<f64> = episodes.iter().filter_map(|episode| episode.length).collect();
    let keeps = |episode: &&EpisodeResult| {
        constraints.iter().all(|one| episode.cost_of(one).is_some_and(|cost| cost <= one.budget))
    };
    let within = episodes.iter().filter(keeps).count() as f64 / episodes.len().max(1) as f64;
    let kept = |one: &Constraint| {
        let costs: Option<Vec<f64>> = episodes.iter().map(|episode| episode.cost_of(one)).collect();
        one.kept_by(costs.and_then(|costs| Estimate::of(&costs)))
    };
    let plain = |samples: &[f64]| Cell {
        title: String::new(),
        ..Cell::estimate(Estimate::of(samples), samples)
    };
    let mut cost = plain(&costs);
    cost.mark = Mark::of(constraints.iter().map(kept).min().unwrap_or_default());
    let cells = vec![
        Cell::text(player),
        Cell::text(scenario_name(&scenario)),
        Cell::number(f64::from(level)).with_text(level.to_string()),
        Cell::text(options),
        plain(&returns),
        cost,
        plain(&lengths),
        Cell::number(within).with_text(format!("{:.0} %", within * 100.0)),
    ];
    (format!("{:02} {scenario} {level} {player}", scenario_order(&scenario)), cells)
}
