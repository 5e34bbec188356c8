//! What the agents that come with the program are worth, as their files say.

use std::path::Path;
use std::sync::OnceLock;

use super::agent_file::AgentFile;
use super::zoo::{PREFIX, bytes, names};

/// What one of them is worth: means over the episodes that closed its training.
#[derive(Clone, Debug)]
pub struct ZooResult {
    /// Its name: `zoo:NAME` plays it.
    pub name: String,
    /// What it was trained by.
    pub algorithm: String,
    /// The id of the environment that it was trained in.
    pub env: String,
    /// Sum of rewards of an episode.
    pub episode_return: f64,
    /// Sum of costs of an episode.
    pub cost: f64,
    /// Cost that an episode may have.
    pub budget: f64,
}

/// What all of them are worth; their files are read once.
pub fn results() -> &'static [ZooResult] {
    static RESULTS: OnceLock<Vec<ZooResult>> = OnceLock::new();
    let of = |name: &str| {
        let bytes = bytes(Path::new(&format!("{PREFIX}{name}")))?;
        let card = AgentFile::parse(bytes).ok()?.card;
        let found = card.selection?;
        let evaluation = found.evaluation();
        Some(ZooResult {
            name: name.to_string(),
            algorithm: card.config.algorithm.name().to_string(),
            env: card.config.env.id.clone(),
            episode_return: evaluation.episode_return.mean,
            cost: evaluation.cost.mean,
            budget: card.config.constraints.first()?.budget,
        })
    };
    RESULTS.get_or_init(|| names().filter_map(of).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_agent_of_the_program_says_what_it_is_worth() {
        let all = results();
        assert_eq!(all.len(), names().count());
        for one in all {
            assert_eq!(one.env, format!("{}-v0", one.name));
            assert!(one.episode_return > 0.0 && one.cost <= one.budget, "{one:?}");
        }
    }
}
