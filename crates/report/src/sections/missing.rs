//! What the paper has and this report has not, with the command that fills it.

use crate::document::{Block, Cell, Section, Table};

/// Every section that stands for a table or figure of the paper: its name, what it shows, and what
/// fills it.
const WANTED: [(&str, &str, &str); 17] = [
    ("main", "main tables", "hasard sweep main"),
    ("curves", "training curves", "hasard sweep main"),
    ("paper", "published values beside ours", "hasard train ENV --rules tables --out runs/..."),
    (
        "selected",
        "evaluation of selected checkpoints",
        "hasard train ENV, or hasard eval RUN --json > RUN/eval.jsonl",
    ),
    ("safety-bounds", "tighter and looser budgets", "hasard sweep safety-bounds"),
    ("cost-scale", "PPOCost's cost scales", "hasard sweep cost-scale"),
    ("curriculum", "levels in turn against the last alone", "hasard sweep curriculum"),
    ("segmentation", "segmented observations (+21 % in the paper)", "hasard sweep segmentation"),
    ("depth", "depth as a further channel (+34 % in the paper)", "hasard sweep depth"),
    ("hard", "the hard constraint", "hasard sweep hard"),
    ("full-actions", "the full action space", "hasard sweep full-actions"),
    ("heatmaps", "where agents go", "hasard sweep heatmaps"),
    ("efficiency", "frames and updates a second", "hasard sweep efficiency"),
    ("human", "human results", "hasard sweep human"),
    ("behaviour", "discards, decoys, goggles, barrels", "hasard sweep behaviour"),
    ("calibration", "cost critics: predicted against observed", "hasard train ENV"),
    ("witness", "episodes with reward at cost 0", "hasard sweep witness"),
];

/// A row for each section that is empty.
pub(super) fn section(present: &[Section]) -> Section {
    let filled = |slug: &str| {
        present.iter().any(|section| section.slug == slug && !section.blocks.is_empty())
    };
    let rows: Vec<Vec<Cell>> = WANTED
        .iter()
        .filter(|(slug, ..)| !filled(slug))
        .map(|(slug, what, command)| {
            vec![Cell::text(*slug), Cell::text(*what), Cell::text(*command)]
        })
        .collect();
    let heads = ["section", "what it shows", "filled by"].map(String::from).to_vec();
    let blocks = if rows.is_empty() {
        Vec::new()
    } else {
        vec![Block::Table(Table { heads, rows, ..Table::default() })]
    };
    Section {
        slug: "missing".into(),
        title: "Not here yet".into(),
        text: vec![
            "Tables and figures of the paper for which no run was found below the named folders."
                .into(),
        ],
        blocks,
    }
}
