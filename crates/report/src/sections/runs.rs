//! Every experiment, every run, and what was passed over.

use super::main_results::marked_cells;
use crate::document::{Block, Cell, Section, Table, frames, number};
use crate::group::{Group, Source, scenario_name};
use crate::run::{Constraint, Warning};

/// A row for each experiment.
pub(super) fn experiments(groups: &[Group]) -> Section {
    let rows = groups
        .iter()
        .map(|group| {
            let config = group.config();
            let source = group.headline();
            let (return_cell, cost_cell) = marked_cells(&[group], source).remove(0);
            let seeds_values = by_seed(group, source);
            let (shortest, longest) = group.frames_span();
            let reached = if shortest == longest {
                frames(longest)
            } else {
                format!("{} to {}", frames(shortest), frames(longest))
            };
            let seeds: Vec<String> =
                group.runs.iter().map(|run| run.config.seed.to_string()).collect();
            vec![
                Cell::text(scenario_name(&config.scenario)),
                Cell::number(f64::from(config.level)).with_text(config.level.to_string()),
                Cell::text(&config.algo),
                Cell::text(group.options_line(None)),
                Cell::text(seeds.join(" ")),
                Cell::number(longest).with_text(reached),
                budget_cell(group),
                return_cell,
                cost_cell,
                Cell::text(seeds_values),
                Cell::text(if source == Source::Evaluation { "evaluation" } else { "training" }),
                Cell::estimate(
                    group.estimate(source, "length_mean"),
                    &group.samples(source, "length_mean"),
                ),
            ]
        })
        .collect();
    let heads = [
        "scenario",
        "level",
        "algorithm",
        "options",
        "seeds",
        "frames",
        "budget",
        "return",
        "cost",
        "each seed",
        "by",
        "steps an episode",
    ];
    section("experiments", "All experiments", heads.as_slice(), rows)
}

/// Return @ cost of every seed, in the order of the seeds.
fn by_seed(group: &Group, source: Source) -> String {
    let pairs =
        group.samples(source, "return_mean").into_iter().zip(group.samples(source, "cost_mean"));
    pairs
        .map(|(episode_return, cost)| format!("{} @ {}", number(episode_return), number(cost)))
        .collect::<Vec<_>>()
        .join(", ")
}

/// The budget of the whole cost, or of the only constraint; those of several have a table of their
/// own.
fn budget_cell(group: &Group) -> Cell {
    match &group.config().constraints[..] {
        [one] => Cell::number(one.budget).with_text(one.label()),
        several => Cell::text(several.iter().map(Constraint::label).collect::<Vec<_>>().join(", ")),
    }
}

/// A row for each run.
pub(super) fn runs(groups: &[Group]) -> Section {
    let rows = groups
        .iter()
        .flat_map(|group| &group.runs)
        .map(|run| {
            let value =
                |metric: &str| run.final_mean(metric).map_or_else(|| Cell::text("-"), Cell::number);
            let last = |metric: &str| run.rows.iter().rev().find_map(|row| row.get(metric));
            let hours =
                last("wall_s").map_or_else(|| Cell::text("-"), |s| Cell::number(s / 3600.0));
            let fps = run
                .frames_per_second()
                .map_or_else(|| Cell::text("-"), |fps| Cell::number(fps).with_text(number(fps)));
            let state = match run.config.frames {
                Some(asked) if !run.finished() => {
                    format!("{:.0} %", 100.0 * run.frames() / asked)
                }
                _ => "finished".into(),
            };
            let state = run
                .config
                .extended_from
                .map_or(state.clone(), |first| format!("{state}, extended from {}", frames(first)));
            vec![
                Cell::text(run.path.display().to_string()),
                Cell::text(&run.config.env),
                Cell::text(&run.config.algo),
                Cell::number(run.config.seed as f64).with_text(run.config.seed.to_string()),
                Cell::number(run.frames()).with_text(frames(run.frames())),
                Cell::text(state),
                hours,
                fps,
                value("return_mean"),
                value("cost_mean"),
                Cell::number(run.rows.len() as f64).with_text(run.rows.len().to_string()),
            ]
        })
        .collect();
    let heads = [
        "directory",
        "environment",
        "algorithm",
        "seed",
        "frames",
        "state",
        "hours",
        "frames/s",
        "return",
        "cost",
        "reports",
    ];
    section("runs", "All runs", heads.as_slice(), rows)
}

/// What was passed over while reading.
pub(super) fn warnings(warnings: &[Warning]) -> Section {
    let rows = warnings
        .iter()
        .map(|warning| {
            let line = if warning.line == 0 {
                Cell::text("")
            } else {
                Cell::number(warning.line as f64).with_text(warning.line.to_string())
            };
            vec![Cell::text(warning.path.display().to_string()), line, Cell::text(&warning.problem)]
        })
        .collect();
    section("warnings", "Passed over", &["file", "line", "problem"], rows)
}

fn section(slug: &str, title: &str, heads: &[&str], rows: Vec<Vec<Cell>>) -> Section {
    let table = Table {
        caption: String::new(),
        spans: Vec::new(),
        heads: heads.iter().map(|head| (*head).to_owned()).collect(),
        rows,
    };
    let table = table.folded(&["level", "options", "by", "state"]);
    let blocks = if table.rows.is_empty() { Vec::new() } else { vec![Block::Table(table)] };
    Section { slug: slug.into(), title: title.into(), text: Vec::new(), blocks }
}
