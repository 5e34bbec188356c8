//! The weights that a run began with, where they are not its own.

use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// Weights of another run or of an agent, by which a run began.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct InitFrom {
    /// Where they are: a run's directory, an agent's file or `zoo:NAME`.
    #[serde(with = "crate::config::place::known")]
    pub place: PathBuf,
    /// SHA-256 of the agent's file, or of the weights of the run's newest checkpoint.
    pub sha256: String,
}
