//! The agents that one gets from runs, rather than the training that made them: a row a run.

use super::main_results::cost_cell;
use super::setting;
use crate::document::{Block, Cell, Mark, Section, Table, frames, number};
use crate::group::{Group, Source, scenario_name};
use crate::run::{Constraint, Run};
use crate::statistics::{Estimate, conditional_value_at_risk, mean};

/// A row for each evaluated run, and one for the mean of each experiment.
pub(super) fn section(groups: &[Group]) -> Section {
    let mut rows = Vec::new();
    for group in groups {
        let evaluated: Vec<&Run> =
            group.runs.iter().filter(|run| run.evaluated("return_mean").is_some()).collect();
        rows.extend(evaluated.iter().map(|run| row(run, setting(group))));
        if evaluated.len() > 1 {
            rows.push(mean_row(group, evaluated.len()));
        }
    }
    let heads = [
        "scenario",
        "level",
        "algorithm",
        "options",
        "seed",
        "frames",
        "minutes",
        "taken after",
        "episodes",
        "return",
        "cost",
        "up to",
        "budget",
        "over budget",
        "worst tenth",
    ];
    let table = Table { heads: heads.map(String::from).to_vec(), rows, ..Table::default() };
    Section {
        slug: "selected".into(),
        title: "Selected checkpoints".into(),
        text: vec![
            "Each run selects the best checkpoint that keeps its budget in evaluations (of the algorithms that keep none, the one that returns \
             most); here it plays its closing episodes, \
             which training has not seen; one that is over its budget in them has given way to the next. ± is half the 95 % interval over \
             episodes, of skewed costs the arm of it above the mean; `up to` is its upper end; green is within the budget \
             by the mean, on green ground by the upper end too. `over budget` is the share of episodes above the budget, `worst tenth` the \
             mean cost of the costliest tenth of episodes. In the rows of means ± is over seeds."
                .into(),
        ],
        blocks: if table.rows.is_empty() { Vec::new() } else { vec![Block::Table(table.folded(&["level", "options", "frames"]))] },
    }
}

fn row(run: &Run, options: String) -> Vec<Cell> {
    let config = &run.config;
    let minutes = run
        .rows
        .iter()
        .rev()
        .find_map(|row| row.get("wall_s"))
        .map_or_else(|| Cell::text("-"), |s| Cell::number(s / 60.0));
    let taken = run.selected.as_ref().map_or_else(
        || Cell::text("-"),
        |one| Cell::number(one.frames).with_text(frames(one.frames)),
    );
    let mut cells = vec![
        Cell::text(scenario_name(&config.scenario)),
        Cell::number(f64::from(config.level)).with_text(config.level.to_string()),
        Cell::text(&config.algo),
        Cell::text(options),
        Cell::number(config.seed as f64).with_text(config.seed.to_string()),
        Cell::number(run.frames()).with_text(frames(run.frames())),
        minutes,
        taken,
        Cell::number(run.evaluated_episodes() as f64)
            .with_text(run.evaluated_episodes().to_string()),
        plain(run.evaluated("return_mean")),
    ];
    cells.extend(cost_cells(run));
    let over = share_over(run).map_or_else(|| Cell::text("-"), percent);
    let tail = |one: &Constraint| conditional_value_at_risk(&run.episode_costs(one), 0.1);
    let tails: Option<Vec<String>> =
        config.constraints.iter().map(|one| Some(number(tail(one)?))).collect();
    cells.extend([over, Cell::text(tails.map_or_else(|| "-".into(), |tails| tails.join(", ")))]);
    cells
}

/// Share of the evaluated episodes that were over a budget; `None` where single episodes were not
/// kept.
pub(super) fn share_over(run: &Run) -> Option<f64> {
    let over = |episode: &crate::run::EpisodeResult| {
        let costs =
            run.config.constraints.iter().map(|one| Some(episode.cost_of(one)? > one.budget));
        costs.collect::<Option<Vec<bool>>>().map(|over| f64::from(u8::from(over.contains(&true))))
    };
    mean(&run.evaluation.iter().map(over).collect::<Option<Vec<f64>>>()?)
}

/// A share as people read it.
pub(super) fn percent(share: f64) -> Cell {
    // The sum of nothing is -0.
    Cell::number(share).with_text(format!("{:.0} %", share * 100.0 + 0.0))
}

/// Cost, upper end and budget; of several constraints, all in each cell.
fn cost_cells(run: &Run) -> [Cell; 3] {
    let costs = run.config.constraints.iter().map(|one| (one, run.evaluated(&one.metric())));
    let all: Vec<(&Constraint, Option<Estimate>)> = costs.collect();
    let kept = all.iter().map(|(one, cost)| one.kept_by(*cost)).min().unwrap_or_default();
    let joined = |text: &dyn Fn(&Constraint, Option<Estimate>) -> String| {
        Cell::text(all.iter().map(|(one, cost)| text(one, *cost)).collect::<Vec<_>>().join(", "))
    };
    let cost = joined(&|one, cost| one.named(&plain(cost).text));
    let up_to = joined(&|one, cost| {
        one.named(&cost.map_or_else(|| "-".into(), |cost| number(cost.high())))
    });
    let budget = joined(&|one, _| one.label());
    [Cell { mark: Mark::of(kept), ..cost }, up_to, budget]
}

fn mean_row(group: &Group, runs: usize) -> Vec<Cell> {
    let config = group.config();
    let over_seeds = |metric: &str| plain(group.estimate(Source::Evaluation, metric));
    let mut cells = vec![
        Cell::text(scenario_name(&config.scenario)),
        Cell::number(f64::from(config.level)).with_text(config.level.to_string()),
        Cell::text(&config.algo),
        Cell::text(setting(group)),
        Cell::text(format!("mean of {runs}")),
    ];
    cells.extend(std::iter::repeat_n(Cell::text(""), 4));
    let cost = Cell {
        mark: Mark::of(group.kept(Source::Evaluation)),
        note: String::new(),
        ..cost_cell(group, Source::Evaluation)
    };
    cells.extend([over_seeds("return_mean"), cost]);
    cells.extend(std::iter::repeat_n(Cell::text(""), 4));
    cells
}

fn plain(estimate: Option<Estimate>) -> Cell {
    Cell { note: String::new(), ..Cell::estimate(estimate, &[]) }
}
