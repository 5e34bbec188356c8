//! Our values beside the published ones, a row each.

use super::setting;
use crate::document::{Block, Cell, Section, Table, frames};
use crate::group::{Group, Source, scenario_name};
use crate::published::{published, withheld};
use std::collections::BTreeMap;

pub(super) fn section(groups: &[Group]) -> Section {
    let mut rows = Vec::new();
    let mut notes: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for group in groups {
        let Some(paper) = published(group.config()) else { continue };
        let config = group.config();
        for note in &paper.notes {
            let cell =
                format!("{} {} {}", scenario_name(&config.scenario), config.level, paper.algorithm);
            notes.entry(note).or_default().push(cell);
        }
        // The paper's values are of the end of training. A selected checkpoint's would flatter ours.
        let source = match group.final_samples("return_mean")[..] {
            [] => Source::Evaluation,
            _ => Source::Training,
        };
        let (return_estimate, cost_estimate) =
            (group.estimate(source, "return_mean"), group.estimate(source, "cost_mean"));
        let ratio = |ours: Option<f64>, theirs: Option<f64>| match (ours, theirs) {
            (Some(ours), Some(theirs)) if theirs != 0.0 => {
                Cell { text: format!("{:.2}", ours / theirs), ..Cell::number(ours / theirs) }
            }
            _ => Cell::text("-"),
        };
        let theirs = |value: f64| Cell { title: paper.note(), pale: true, ..Cell::number(value) };
        let (_, reached) = group.frames_span();
        rows.push(vec![
            Cell::text(scenario_name(&config.scenario)),
            Cell::number(f64::from(config.level)).with_text(config.level.to_string()),
            Cell::text(&config.algo),
            Cell::text(setting(group)),
            Cell::number(reached).with_text(frames(reached)),
            Cell::text(if source == Source::Evaluation { "evaluation" } else { "training" }),
            Cell::estimate(return_estimate, &group.samples(source, "return_mean")),
            theirs(paper.episode_return),
            ratio(return_estimate.map(|e| e.mean), Some(paper.episode_return)),
            Cell::estimate(cost_estimate, &group.samples(source, "cost_mean")),
            theirs(paper.cost),
            ratio(cost_estimate.map(|e| e.mean), Some(paper.cost)),
        ]);
    }
    let heads = [
        "scenario",
        "level",
        "algorithm",
        "options",
        "frames",
        "by",
        "return",
        "paper",
        "ratio",
        "cost",
        "paper",
        "ratio",
    ];
    let table = Table {
        caption: String::new(),
        spans: Vec::new(),
        heads: heads.map(String::from).to_vec(),
        rows,
    };
    let mut text = Vec::new();
    if !table.rows.is_empty() {
        text.push(
            "Both are of the end of training, as the paper measures it; a run that has no points of training is shown by its \
             evaluation. The paper trained for 500M frames (hard constraint and curriculum: 300M). A run of fewer frames can only be \
             held against the early part of its curves, in the section on training curves."
                .to_owned(),
        );
    }
    text.extend(withheld(groups));
    Section {
        slug: "paper".into(),
        title: "Beside the paper".into(),
        text,
        blocks: if table.rows.is_empty() {
            Vec::new()
        } else {
            vec![
                Block::Table(table.folded(&["level", "options", "by"])),
                Block::Table(notes_table(notes)),
            ]
        },
    }
}

/// What to know about the published values, with the cells that it is about.
fn notes_table(notes: BTreeMap<&str, Vec<String>>) -> Table {
    let which = |cells: Vec<String>| {
        if cells.len() > 6 { format!("{} rows", cells.len()) } else { cells.join(", ") }
    };
    let rows = notes
        .into_iter()
        .map(|(note, cells)| vec![Cell::text(note), Cell::text(which(cells))])
        .collect();
    let heads = ["note", "on"].map(String::from).to_vec();
    Table { caption: "Notes on the published values".into(), heads, rows, ..Table::default() }
}
