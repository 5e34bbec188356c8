//! The sections of the report, each made from all experiments.

mod aggregates;
mod baselines;
mod behaviour;
mod beside_paper;
mod calibration;
mod comparison;
mod constraints;
mod curves;
mod efficiency;
mod equal_frames;
mod heatmaps;
mod main_results;
mod marks;
mod missing;
mod pareto;
mod players;
mod runs;
mod safety;
mod selected;
mod unlike;
mod witness;

use crate::document::{Document, Section, count};
use crate::group::Group;
use crate::run::{Found, Warning};
use std::collections::BTreeMap;

pub(crate) use baselines::{Baselines, judged_by, judged_metric};

/// Makes the report of what was found. `warnings` grows by what is noticed on the way.
#[must_use]
pub fn document(
    title: &str,
    found: &Found,
    groups: &[Group],
    warnings: &mut Vec<Warning>,
) -> Document {
    let frames: f64 =
        groups.iter().flat_map(|group| &group.runs).map(crate::run::Run::frames).sum();
    let run_count: usize = groups.iter().map(|group| group.runs.len()).sum();
    let baselines = Baselines::new(found, groups);
    let mut sections = vec![
        main_results::section(groups),
        selected::section(groups),
        safety::section(groups, &baselines),
        beside_paper::section(groups),
        aggregates::section(groups, &baselines),
        pareto::section(groups),
        curves::section(groups),
        constraints::section(groups),
    ];
    sections.extend(comparison::sections(groups));
    sections.push(heatmaps::section(groups, warnings));
    sections.push(efficiency::section(groups));
    sections.push(players::human(found));
    sections.push(behaviour::section(found, groups));
    sections.push(witness::section(found));
    sections.push(calibration::section(groups));
    sections.push(players::section(found, groups));
    sections.push(unlike::section(groups));
    sections.push(runs::experiments(groups));
    sections.push(runs::runs(groups));
    sections.push(missing::section(&sections));
    sections.push(runs::warnings(warnings));
    sections.retain(|section: &Section| {
        !section.blocks.is_empty() || section.slug == "paper" && !section.text.is_empty()
    });
    sections.push(method());
    Document {
        title: title.to_owned(),
        subtitle: format!(
            "{} of {}, {} frames in all",
            count(run_count, "run"),
            count(groups.len(), "experiment"),
            crate::document::frames(frames)
        ),
        sections,
    }
}

fn method() -> Section {
    Section {
        slug: "method".into(),
        title: "How these numbers are made".into(),
        text: [
            "A run is one seed. An experiment is all runs whose configuration is equal but for the seed, for what does not change learning \
             (such as threads and reports) and for how it was evaluated; nothing else is ever averaged.",
            "A value of the selected checkpoints is of their closing episodes. A value of the end of training is, for each seed, the mean over the last ten of five hundred points at equal distances in frames (each \
             the mean over recently finished training episodes, on the line between the reports around it), then the mean over seeds. ± is half the 95 % interval of Student's t distribution with n - 1 in the deviation's denominator; \
             n is the number of seeds. With one seed there is no interval.",
            "Green ground: the upper end of the cost's 95 % interval over seeds is within the budget (of a single evaluated seed, over its \
             episodes); green letters: the mean is. With several constraints, each within its own. Bold: the best return among those \
             on green ground, or if there are none among those within by their mean, and all that cannot be distinguished from it; if none is within, the least cost.",
            "Curves show the mean over seeds (line), its 95 % interval (band) and each seed (thin lines). Means end where the shortest run \
             ends, and no curve is stretched or smoothed; reports within one 240th of the axis are averaged.",
            "Returns and costs are always those of the environment, never reshaped by an algorithm.",
            "The paper's values stand only beside runs under `--rules tables`, the rules that its tables were made under. Where the paper's \
             scripts added back the wrong multiple of the cost, the corrected return is given; its tables print no intervals.",
        ]
        .map(String::from)
        .to_vec(),
        blocks: Vec::new(),
    }
}

/// Options that an experiment of the paper varies: they have sections of their own and stay out of
/// the main tables.
pub(crate) const VARIED: [&str; 6] =
    ["safety_budget", "cost_scale", "full_actions", "observation", "curriculum", "hard"];

/// The experiments without any varied option, by what else they were run under, those with the
/// longest runs first: what was only tried for a moment comes last.
fn main_groups(groups: &[Group]) -> Vec<(String, Vec<&Group>)> {
    let mut settings: BTreeMap<String, Vec<&Group>> = BTreeMap::new();
    for group in groups {
        if !VARIED.iter().any(|key| group.config().options.contains_key(*key)) {
            settings.entry(setting(group)).or_default().push(group);
        }
    }
    let mut settings: Vec<_> = settings.into_iter().flat_map(kept_apart).collect();
    let longest =
        |members: &[&Group]| members.iter().map(|group| group.frames_span().1).fold(0.0, f64::max);
    settings.sort_by(|a, b| longest(&b.1).total_cmp(&longest(&a.1)));
    settings
}

/// A table has a cell for an algorithm in an environment. Where experiments of a setting differ in
/// what the setting does not show, frames that are rounded alike or one of two usual budgets, the
/// further ones get a table each that says so.
fn kept_apart((setting, members): (String, Vec<&Group>)) -> Vec<(String, Vec<&Group>)> {
    let cell = |group: &Group| {
        let config = group.config();
        (config.env.clone(), config.algo.to_ascii_lowercase())
    };
    let mut first: Vec<&Group> = Vec::new();
    let mut apart: BTreeMap<String, Vec<&Group>> = BTreeMap::new();
    for group in members {
        let Some(there) = first.iter().find(|one| cell(one) == cell(group)) else {
            first.push(group);
            continue;
        };
        let (own, other) = (group.config(), there.config());
        let mut name = setting.clone();
        if let Some(frames) = own.frames.filter(|_| own.frames != other.frames) {
            name += &format!(", exactly {frames}");
        }
        if own.safety_budget != other.safety_budget {
            name += &format!(", budget {}", own.safety_budget);
        }
        apart.entry(name).or_default().push(group);
    }
    [(setting, first)].into_iter().chain(apart).collect()
}

/// Everything that an experiment was run under, for people.
fn setting(group: &Group) -> String {
    let mut parts = vec![group.options_line(None)];
    parts.extend(
        group.config().frames.map(|frames| format!("{} frames", crate::document::frames(frames))),
    );
    parts.retain(|part| !part.is_empty());
    if parts.is_empty() { "default options".into() } else { parts.join(", ") }
}

/// The values of `items` under `key`, in order, without repeats.
fn distinct<T, K: Ord>(items: &[T], key: impl Fn(&T) -> K) -> Vec<K> {
    let mut keys: Vec<K> = items.iter().map(key).collect();
    keys.sort();
    keys.dedup();
    keys
}
