//! The weights that a run began with, where they are not its own.

use serde::{Deserialize, Serialize};

/// Weights of another run or of an agent, by which a run began.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct InitFrom {
    /// Where they were, as it was written: a run's directory, an agent's file or `zoo:NAME`.
    pub place: String,
    /// SHA-256 of the agent's file, or of the weights of the run's newest checkpoint.
    pub sha256: String,
}
