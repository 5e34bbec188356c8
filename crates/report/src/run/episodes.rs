//! Finished episodes, as `hasard rollout --json` and `hasard eval --json` print them and episode
//! files keep them.

use super::{Config, Constraint, FRAME_SKIP, Warning};
use serde_json::Value;
use std::collections::HashSet;
use std::path::Path;

/// What is known of a finished episode.
#[derive(Clone, PartialEq, Debug)]
pub struct EpisodeResult {
    /// Id of the environment; empty if the line does not say.
    pub env: String,
    /// Sum of rewards.
    pub episode_return: f64,
    /// Sum of costs.
    pub cost: f64,
    /// Sum of each cost term, where they are reported.
    pub costs: Vec<(String, f64)>,
    /// What the scenario counted, by name.
    pub stats: Vec<(String, f64)>,
    /// The rule set, if the line says.
    pub rules: Option<String>,
    /// Whether it was played under the hard constraint, if the line says.
    pub hard: Option<bool>,
    /// Whether it was played in the full action space.
    pub full_actions: bool,
    /// Tics that each action was held.
    pub frame_skip: u64,
    /// Whether it was played in other maps than the built-in ones.
    pub maps: bool,
    /// Whether it met the creatures of the paper's first runs.
    pub early_creatures: bool,
    /// Policy steps, if known.
    pub length: Option<f64>,
    /// What it began from, if the line says.
    pub seed: Option<u64>,
}

/// The episodes that are of a run's own task, or of one of its several, each seed of a task once; a
/// line says how many of a file are not.
pub fn own_episodes(
    episodes: Vec<EpisodeResult>,
    config: &Config,
    path: &Path,
    warnings: &mut Vec<Warning>,
) -> Vec<EpisodeResult> {
    let all = episodes.len();
    let mut seen = HashSet::new();
    let own = |one: &EpisodeResult| {
        (one.env.is_empty() || config.env.split(',').any(|task| task.trim() == one.env))
            && one
                .rules
                .as_deref()
                .is_none_or(|rules| config.rules().is_none_or(|own| own == rules))
            && one.hard.is_none_or(|hard| hard == config.hard())
    };
    let mut kept: Vec<EpisodeResult> = episodes.into_iter().filter(own).collect();
    let others = all - kept.len();
    kept.retain(|one| one.seed.is_none_or(|seed| seen.insert((one.env.clone(), seed))));
    let again = all - others - kept.len();
    for (count, what) in [
        (others, "of another environment or other rules than the run's"),
        (again, "of a seed that stands there before"),
    ] {
        if count > 0 {
            let problem = format!("{count} of {all} episodes are {what}; left out");
            warnings.push(Warning { path: path.to_owned(), line: 0, problem });
        }
    }
    kept
}

impl EpisodeResult {
    /// What it cost under a constraint; `None` if its term was not reported.
    #[must_use]
    pub fn cost_of(&self, constraint: &Constraint) -> Option<f64> {
        match &constraint.term {
            None => Some(self.cost),
            Some(term) => self.costs.iter().find(|(name, _)| name == term).map(|(_, cost)| *cost),
        }
    }
}

fn named(line: &Value, key: &str) -> Vec<(String, f64)> {
    let named = line.get(key).and_then(Value::as_object).into_iter().flatten();
    named.filter_map(|(name, cost)| Some((name.clone(), cost.as_f64()?))).collect()
}

/// Understands lines of JSON that have `return` and `cost`; summaries (lines with `summary`) are
/// passed over in silence, since they are made of the others, and damaged lines with a warning.
pub fn read_episode_lines(
    text: &str,
    path: &Path,
    warnings: &mut Vec<Warning>,
) -> Vec<EpisodeResult> {
    let mut episodes = Vec::new();
    for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let value = serde_json::from_str::<Value>(line).unwrap_or(Value::Null);
        if value.get("summary").is_some() {
            continue;
        }
        let number = |key: &str| value.get(key).and_then(Value::as_f64);
        let is = |key: &str| value.get(key).and_then(Value::as_bool).unwrap_or(false);
        match (number("return"), number("cost")) {
            (Some(episode_return), Some(cost)) => episodes.push(EpisodeResult {
                env: value.get("env").and_then(Value::as_str).unwrap_or_default().to_owned(),
                episode_return,
                cost,
                costs: named(&value, "costs"),
                stats: named(&value, "stats"),
                rules: value.get("rules").and_then(Value::as_str).map(String::from),
                hard: value.get("hard").and_then(Value::as_bool),
                full_actions: is("full_actions"),
                frame_skip: value.get("frame_skip").and_then(Value::as_u64).unwrap_or(FRAME_SKIP),
                maps: is("maps"),
                early_creatures: is("early_creatures"),
                length: number("length"),
                seed: value.get("seed").and_then(Value::as_u64),
            }),
            _ => warnings.push(Warning {
                path: path.to_owned(),
                line: index + 1,
                problem: "is no episode with a return and a cost; line passed over".into(),
            }),
        }
    }
    episodes
}
