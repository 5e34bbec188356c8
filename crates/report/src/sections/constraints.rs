//! Constraints on single cost terms: each beside its own budget.

use crate::document::{Block, Cell, Mark, Section, Table};
use crate::group::{Group, Source, scenario_name};

/// A row for each constraint of the experiments that constrain named cost terms.
pub(super) fn section(groups: &[Group]) -> Section {
    let named = groups
        .iter()
        .filter(|group| group.config().constraints.iter().any(|one| one.term.is_some()));
    let rows: Vec<Vec<Cell>> = named
        .flat_map(|group| {
            let config = group.config();
            config.constraints.iter().map(move |one| {
                let cell = |source: Source| {
                    let (estimate, samples) = (
                        group.estimate(source, &one.metric()),
                        group.samples(source, &one.metric()),
                    );
                    Cell {
                        mark: Mark::of(one.kept_by(estimate)),
                        ..Cell::estimate(estimate, &samples)
                    }
                };
                vec![
                    Cell::text(scenario_name(&config.scenario)),
                    Cell::number(f64::from(config.level)).with_text(config.level.to_string()),
                    Cell::text(&config.algo),
                    Cell::text(group.options_line(Some("constraints"))),
                    Cell::text(one.name()),
                    Cell::number(one.budget).with_text(one.budget.to_string()),
                    cell(Source::Evaluation),
                    cell(Source::Training),
                ]
            })
        })
        .collect();
    let heads = [
        "scenario",
        "level",
        "algorithm",
        "options",
        "constraint",
        "budget",
        "evaluation",
        "end of training",
    ]
    .map(String::from)
    .to_vec();
    let table = Table { caption: String::new(), spans: Vec::new(), heads, rows };
    Section {
        slug: "constraints".into(),
        title: "Constraints on cost terms".into(),
        text: vec!["Each constraint holds its own term against its own budget, in evaluation of the selected checkpoints and at the end of training.".into()],
        blocks: if table.rows.is_empty() { Vec::new() } else { vec![Block::Table(table)] },
    }
}
