//! How safe agents are, and how safe their training was.

use super::baselines::{Baselines, judged_by};
use super::selected::{percent, share_over};
use super::{distinct, setting};
use crate::document::{Block, Cell, Section, Table, frames, number};
use crate::group::{Group, scenario_name};
use crate::run::{Constraint, Run};
use crate::statistics::{Estimate, conditional_value_at_risk};

/// Numbers over seeds with a caption each.
type Column = (&'static str, fn(&Run) -> Option<f64>);

/// Of the training itself: sums, and time within the budget.
const TRAINING: [Column; 4] = [
    ("cost in training", |run| run.total("cost_total")),
    ("violation in training", |run| run.total("violation_total")),
    ("frames until within", |run| run.time_within().map(|(frames, _)| frames)),
    ("within after", |run| run.time_within().and_then(|(_, share)| share)),
];

pub(super) fn section(groups: &[Group], baselines: &Baselines) -> Section {
    let rows: Vec<Vec<Cell>> = groups.iter().map(|group| row(group, baselines)).collect();
    let heads = [
        "scenario",
        "level",
        "algorithm",
        "options",
        "feasible score",
        "soft",
        "normalised return",
        "judged by",
        "episodes over budget",
        "worst tenth",
    ];
    let mut heads = heads.map(String::from).to_vec();
    heads.extend(TRAINING.iter().map(|(head, _)| (*head).to_owned()));
    let mut text = vec![
        "Normalised return: (R - random) / (PPO - random), both measured here. Feasible score: the normalised return of a seed if the upper \
         95 % end of its cost is within the budget, else 0 (below 0: safe, but returns less than random play; so a breach, at 0, stands \
         above it); soft: a return above random play's divided by how far the upper end is above the budget. Neither is given where a \
         cost has no interval: at the end of training, and for a single episode. \
         Episodes over budget and the mean cost of the worst tenth of episodes (CVaR 10 %) are of the selected checkpoint."
            .to_owned(),
        "Cost and violation in training are sums over all training episodes, a violation being what an episode costs above the \
         budget. Frames until within: of the first report whose mean cost is within the budget; within after: the share \
         of the frames that followed. All are means over seeds, of these two over the seeds that came within, whose number \
         is named where some never did."
            .to_owned(),
    ];
    let missing = baselines.missing(
        &groups.iter().filter(|group| baselines.scores(group).is_empty()).collect::<Vec<_>>(),
    );
    if let [first, rest @ ..] = &missing[..] {
        let more = if rest.is_empty() {
            String::new()
        } else {
            format!(" (and {} more like it)", rest.len())
        };
        text.push(format!("Scores need both ends of their scale. Missing here: {first}{more}."));
    }
    let of_other_length = baselines.of_other_length(groups);
    if !of_other_length.is_empty() {
        text.push(format!(
            "Measured by a PPO that was trained for more frames or fewer, for want of one as long: {}.",
            of_other_length.join(", ")
        ));
    }
    let unlearned = baselines.unlearned(groups);
    if !unlearned.is_empty() {
        text.push(format!(
            "No scale, hence no score, where the episodes of PPO's seeds do not show that these return more than a random policy: {}.",
            unlearned.join(", ")
        ));
    }
    let blocks = if rows.is_empty() {
        Vec::new()
    } else {
        vec![Block::Table(Table { heads, rows, ..Table::default() }.folded(&[
            "level",
            "options",
            "judged by",
        ]))]
    };
    Section { slug: "safety".into(), title: "Safety".into(), text, blocks }
}

fn row(group: &Group, baselines: &Baselines) -> Vec<Cell> {
    let config = group.config();
    let scores = baselines.scores(group);
    let over_seeds = |samples: Vec<f64>| Cell {
        note: String::new(),
        ..Cell::estimate(Estimate::of(&samples), &samples)
    };
    let mut row = vec![
        Cell::text(scenario_name(&config.scenario)),
        Cell::number(f64::from(config.level)).with_text(config.level.to_string()),
        Cell::text(&config.algo),
        Cell::text(setting(group)),
        over_seeds(scores.iter().filter_map(|score| score.feasible).collect()),
        over_seeds(scores.iter().filter_map(|score| score.soft).collect()),
        over_seeds(scores.iter().map(|score| score.normalised).collect()),
        Cell::text(distinct(&group.runs, judged_by).join(", ")),
    ];
    let over: Vec<f64> = group.runs.iter().filter_map(share_over).collect();
    row.push(Estimate::of(&over).map_or_else(|| over_seeds(Vec::new()), |one| percent(one.mean)));
    let tails = |one: &Constraint| {
        let tails = group
            .runs
            .iter()
            .filter_map(|run| conditional_value_at_risk(&run.episode_costs(one), 0.1));
        Estimate::of(&tails.collect::<Vec<_>>()).map(|one| one.mean)
    };
    let tails: Option<Vec<f64>> = config.constraints.iter().map(tails).collect();
    row.push(match tails {
        Some(tails) => Cell {
            sort: tails.first().copied(),
            ..Cell::text(tails.iter().map(|tail| number(*tail)).collect::<Vec<_>>().join(", "))
        },
        None => over_seeds(Vec::new()),
    });
    for (head, of) in TRAINING {
        let samples: Vec<f64> = group.runs.iter().filter_map(of).collect();
        let mean = Estimate::of(&samples).map(|one| one.mean);
        let cell = match mean {
            Some(mean) if head == "within after" => percent(mean),
            Some(mean) => Cell::number(mean).with_text(frames(mean)),
            None => over_seeds(Vec::new()),
        };
        let some = mean.is_some() && samples.len() < group.runs.len();
        let text = format!("{} ({} of {} seeds)", cell.text, samples.len(), group.runs.len());
        row.push(if some { cell.with_text(text) } else { cell });
    }
    row
}
