//! A setting that changed in the course of a run.

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// A setting that was given another value when the run was resumed.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Change {
    /// Frames after which it holds.
    pub frames: u64,
    /// Name of the setting, as in `config.json`.
    pub setting: String,
    /// What it was before.
    pub from: Value,
    /// What it is since.
    pub to: Value,
}
