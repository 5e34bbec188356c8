//! Settings in which experiments that stand beside each other differ, though nothing in their place
//! says so.

use super::{VARIED, distinct, main_groups};
use crate::document::{Block, Cell, Section, Table};
use crate::group::Group;
use crate::run::{Config, SHOWN};
use std::collections::{BTreeMap, BTreeSet};

/// A setting, its values, and who has each.
type Unlike = BTreeMap<String, BTreeMap<String, BTreeSet<String>>>;

/// What follows from the length, which stands beside every experiment.
const OF_LENGTH: &str = "learning.schedule_frames";

fn value(config: &Config, key: &str) -> String {
    config.options.get(key).cloned().unwrap_or_else(|| "not given".into())
}

/// The settings in which experiments differ, but for one and what follows from the length.
pub(super) fn differing(members: &[&Group], but: &str) -> Vec<String> {
    let keys: BTreeSet<&String> =
        members.iter().flat_map(|group| group.config().options.keys()).collect();
    let first = members.first().map(|group| group.config());
    keys.into_iter()
        .filter(|key| *key != but && *key != OF_LENGTH)
        .filter(|key| {
            first.is_some_and(|first| {
                members.iter().any(|group| value(group.config(), key) != value(first, key))
            })
        })
        .cloned()
        .collect()
}

/// An experiment's values of some settings, as one line.
pub(super) fn values_of(group: &Group, keys: &[String]) -> String {
    let one = |key: &String| format!("{key} {}", value(group.config(), key));
    keys.iter().map(one).collect::<Vec<_>>().join(", ")
}

/// The settings, beside the algorithm's own, that the algorithms of a table do not share. What an
/// option of a table's name says, or a section compares, is left out.
pub(super) fn section(groups: &[Group]) -> Section {
    let mut blocks = Vec::new();
    for (setting, members) in main_groups(groups) {
        let mut found = Unlike::new();
        for env in distinct(&members, |group| group.config().env.clone()) {
            let here: Vec<&Group> =
                members.iter().copied().filter(|group| group.config().env == env).collect();
            let keys = differing(&here, "");
            for key in keys.into_iter().filter(|key| counts(key)) {
                for group in &here {
                    let config = group.config();
                    let of_key = found.entry(key.clone()).or_default();
                    of_key.entry(value(config, &key)).or_default().insert(config.algo.clone());
                }
            }
        }
        let row = |(key, values): (String, BTreeMap<String, BTreeSet<String>>)| {
            let one = |(value, algorithms): (&String, &BTreeSet<String>)| {
                format!("{value}: {}", algorithms.iter().cloned().collect::<Vec<_>>().join(", "))
            };
            let said = values.iter().map(one).collect::<Vec<_>>().join("; ");
            vec![Cell::text(key), Cell::text(said)]
        };
        let rows: Vec<Vec<Cell>> = found.into_iter().map(row).collect();
        if !rows.is_empty() {
            let heads = ["setting", "value and algorithms"].map(String::from).to_vec();
            blocks.push(Block::Table(Table { caption: setting, heads, rows, ..Table::default() }));
        }
    }
    Section {
        slug: "unlike".into(),
        title: "What the algorithms of a table do not share".into(),
        text: vec![
            "Settings that are not the same for all algorithms of an environment in the tables above, but for those of the algorithms \
             themselves (`algorithm_settings`). Most follow from the algorithm: those of the second order take longer rollouts in one \
             piece. What else stands here was set by hand, or is of another version of the preset."
                .into(),
        ],
        blocks,
    }
}

fn counts(key: &str) -> bool {
    !SHOWN.contains(&key) && !VARIED.contains(&key) && !key.starts_with("algorithm_settings.")
}
