//! Humans and other players, and evaluations of trained agents: results of episodes rather than of training.

use crate::document::{Block, Cell, Mark, Section, Table};
use crate::group::{Group, scenario_name, scenario_order};
use crate::run::{Constraint, EpisodeResult, Found, default_budget, scenario_and_level};
use crate::statistics::Estimate;

pub(super) fn section(found: &Found, groups: &[Group]) -> Section {
    let mut rows: Vec<(String, Vec<Cell>)> = Vec::new();
    for ((player, env, options), episodes) in &found.players {
        let (scenario, _) = scenario_and_level(env);
        let told = |option: &str| options.split(", ").any(|told| told == option);
        let budget = if told("hard true") { 0.0 } else { default_budget(&scenario, told("rules released")) };
        rows.push(row(player, env, options, &[Constraint { term: None, budget }], episodes));
    }
    for group in groups {
        for run in &group.runs {
            if !run.evaluation.is_empty() {
                let who = format!("{}, seed {}", run.config.algo, run.config.seed);
                rows.push(row(&who, &run.config.env, &group.options_line(None), &run.config.constraints, &run.evaluation));
            }
        }
    }
    rows.sort_by(|a, b| a.0.cmp(&b.0));
    let heads = ["player", "scenario", "level", "options", "return", "cost", "steps", "episodes within budget"];
    let rows: Vec<Vec<Cell>> = rows.into_iter().map(|(_, cells)| cells).collect();
    let table = Table { caption: String::new(), spans: Vec::new(), heads: heads.map(String::from).to_vec(), rows };
    Section {
        slug: "players".into(),
        title: "Humans, baselines and evaluations".into(),
        text: vec![
            "Mean over single episodes: recorded ones of humans, files of rollouts, and `hasard eval` of trained agents. n is the number \
             of episodes, which is no measure of the spread between seeds."
                .into(),
        ],
        blocks: if table.rows.is_empty() { Vec::new() } else { vec![Block::Table(table)] },
    }
}

fn row(player: &str, env: &str, options: &str, constraints: &[Constraint], episodes: &[EpisodeResult]) -> (String, Vec<Cell>) {
    let (scenario, level) = scenario_and_level(env);
    let returns: Vec<f64> = episodes.iter().map(|episode| episode.episode_return).collect();
    let costs: Vec<f64> = episodes.iter().map(|episode| episode.cost).collect();
    let lengths: Vec<f64> = episodes.iter().filter_map(|episode| episode.length).collect();
    let keeps =
        |episode: &&EpisodeResult| constraints.iter().all(|one| episode.cost_of(one).is_some_and(|cost| cost <= one.budget));
    let within = episodes.iter().filter(keeps).count() as f64 / episodes.len().max(1) as f64;
    let kept = |one: &Constraint| {
        let costs: Option<Vec<f64>> = episodes.iter().map(|episode| episode.cost_of(one)).collect();
        one.kept_by(costs.and_then(|costs| Estimate::of(&costs)))
    };
    let plain = |samples: &[f64]| Cell { title: String::new(), ..Cell::estimate(Estimate::of(samples), samples) };
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
