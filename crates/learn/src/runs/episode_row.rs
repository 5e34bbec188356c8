//! An episode as a line of JSON.

use hasard_envs::Episode;
use serde_json::{Value, json};

/// An episode of an environment, or of one of its several tasks, as files of episodes and `hasard
/// eval --json` have it.
#[must_use]
pub fn episode_row(env: &str, number: u64, episode: &Episode) -> Value {
    let named = |values: &mut dyn Iterator<Item = (&'static str, f64)>| -> Value {
        values
            .map(|(name, value)| (name.to_string(), json!(value)))
            .collect::<serde_json::Map<_, _>>()
            .into()
    };
    json!({
        "env": episode.task.unwrap_or(env),
        "episode": number,
        "seed": episode.seed,
        "return": episode.episode_return,
        "cost": episode.cost,
        "costs": named(&mut episode.costs.iter().map(|one| (one.name, one.cost))),
        "uncounted": episode.costs.iter().filter(|one| !one.counted).map(|one| one.name).collect::<Vec<_>>(),
        "length": episode.length,
        "terminated": episode.terminated,
        "truncated": episode.truncated,
        "stats": named(&mut episode.stats.iter().copied()),
    })
}
