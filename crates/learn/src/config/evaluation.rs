//! When a run's agent is evaluated, on episodes that it never learned from.

use serde::{Deserialize, Serialize};

/// When and how long a run's agent is evaluated.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(default)]
pub struct EvaluationConfig {
    /// Frames between evaluations, 0 for none; `null` for ten in the second half of the run, or as
    /// many as cost no more than a twentieth of its frames, and none in a short one.
    pub every: Option<u64>,
    /// Episodes of an evaluation.
    pub episodes: usize,
    /// Further episodes by which a checkpoint must prove itself before the run selects it, and of
    /// every closing evaluation; `null` for 100, or as many as take a twentieth of the run's
    /// frames, but no fewer than 10.
    pub confirming_episodes: Option<usize>,
    /// Checkpoints that are kept to choose from: so many confirmations there may be.
    pub candidates: usize,
    /// Only a checkpoint that is surely within its budgets is selected, where there is one that a
    /// confirmation shows to be.
    pub surely: bool,
}

impl Default for EvaluationConfig {
    fn default() -> EvaluationConfig {
        EvaluationConfig {
            every: None,
            episodes: 32,
            confirming_episodes: None,
            candidates: 5,
            surely: false,
        }
    }
}
