//! What runs hand out: the agents that one gets, rather than the training that made them.

use crate::document::{Block, Cell, Mark, Section, Table, frames, number};
use crate::group::{Group, scenario_name};
use crate::run::{Constraint, Run};
use crate::statistics::{Estimate, mean};

/// A row for each run that was evaluated when it was over, and one for the mean of each experiment.
pub(super) fn section(groups: &[Group]) -> Section {
    let mut rows = Vec::new();
    for group in groups {
        let evaluated: Vec<&Run> = group.runs.iter().filter(|run| !run.evaluation.is_empty()).collect();
        rows.extend(evaluated.iter().map(|run| row(run)));
        if evaluated.len() > 1 {
            rows.push(mean_row(group, &evaluated));
        }
    }
    let heads = [
        "scenario",
        "level",
        "algorithm",
        "seed",
        "frames",
        "minutes",
        "handed out after",
        "episodes",
        "return",
        "cost",
        "up to",
        "budget",
    ];
    let table = Table { caption: String::new(), spans: Vec::new(), heads: heads.map(String::from).to_vec(), rows };
    Section {
        slug: "handed-out".into(),
        title: "Agents handed out".into(),
        text: vec![
            "Each run hands out the best checkpoint that keeps its budget in evaluations; here it plays episodes that neither training \
             nor that choice has seen. ± is half the 95 % interval over episodes, `up to` its upper end; green is within the budget \
             by the mean, bold by the upper end too. In the rows of means ± is over seeds."
                .into(),
        ],
        blocks: if table.rows.is_empty() { Vec::new() } else { vec![Block::Table(table)] },
    }
}

fn row(run: &Run) -> Vec<Cell> {
    let config = &run.config;
    let returns: Vec<f64> = run.evaluation.iter().map(|episode| episode.episode_return).collect();
    let minutes =
        run.rows.iter().rev().find_map(|row| row.get("wall_s")).map_or_else(|| Cell::text("-"), |s| Cell::number(s / 60.0));
    let handed_out =
        run.hand_out.as_ref().map_or_else(|| Cell::text("-"), |one| Cell::number(one.frames).with_text(frames(one.frames)));
    let mut cells = vec![
        Cell::text(scenario_name(&config.scenario)),
        Cell::number(f64::from(config.level)).with_text(config.level.to_string()),
        Cell::text(&config.algo),
        Cell::number(config.seed as f64).with_text(config.seed.to_string()),
        Cell::number(run.frames()).with_text(frames(run.frames())),
        minutes,
        handed_out,
        Cell::number(returns.len() as f64).with_text(returns.len().to_string()),
        plain(Estimate::of(&returns)),
    ];
    cells.extend(cost_cells(run));
    cells
}

/// Cost, upper end and budget; of several constraints, all in each cell.
fn cost_cells(run: &Run) -> [Cell; 3] {
    let estimate = |one: &Constraint| {
        let costs: Option<Vec<f64>> = run.evaluation.iter().map(|episode| episode.cost_of(one)).collect();
        costs.and_then(|costs| Estimate::of(&costs))
    };
    let all: Vec<(&Constraint, Option<Estimate>)> = run.config.constraints.iter().map(|one| (one, estimate(one))).collect();
    let within = all.iter().all(|(one, cost)| cost.is_some_and(|cost| cost.mean <= one.budget));
    let surely = all.iter().all(|(one, cost)| cost.is_some_and(|cost| cost.high() <= one.budget));
    let mark = match (within, surely) {
        (_, true) => Mark::WithinBest,
        (true, false) => Mark::Within,
        _ => Mark::None,
    };
    let joined = |text: &dyn Fn(&Constraint, Option<Estimate>) -> String| {
        Cell::text(all.iter().map(|(one, cost)| text(one, *cost)).collect::<Vec<_>>().join(", "))
    };
    let named = |one: &Constraint, text: String| one.term.as_ref().map_or_else(|| text.clone(), |term| format!("{term} {text}"));
    let cost = joined(&|one, cost| named(one, plain(cost).text));
    let up_to = joined(&|one, cost| named(one, cost.map_or_else(|| "-".into(), |cost| number(cost.high()))));
    let budget = joined(&|one, _| one.label());
    [Cell { mark, ..cost }, up_to, budget]
}

fn mean_row(group: &Group, runs: &[&Run]) -> Vec<Cell> {
    let config = group.config();
    let over_seeds = |of: fn(&crate::run::EpisodeResult) -> f64| {
        let means: Vec<f64> = runs.iter().filter_map(|run| mean(&run.evaluation.iter().map(of).collect::<Vec<_>>())).collect();
        plain(Estimate::of(&means))
    };
    let mut cells = vec![
        Cell::text(scenario_name(&config.scenario)),
        Cell::number(f64::from(config.level)).with_text(config.level.to_string()),
        Cell::text(&config.algo),
        Cell::text(format!("mean of {}", runs.len())),
    ];
    cells.extend(std::iter::repeat_n(Cell::text(""), 4));
    cells.extend([
        over_seeds(|episode| episode.episode_return),
        over_seeds(|episode| episode.cost),
        Cell::text(""),
        Cell::text(""),
    ]);
    cells
}

fn plain(estimate: Option<Estimate>) -> Cell {
    Cell { note: String::new(), ..Cell::estimate(estimate, &[]) }
}
