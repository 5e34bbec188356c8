//! What a run writes, and when.

use serde::{Deserialize, Serialize};

/// What a run writes, and when.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct ReportingConfig {
    /// Seconds between reports; 0 reports after every rollout.
    pub report_seconds: f64,
    /// Seconds between checkpoints; 0 writes one after every rollout that the disk keeps up with.
    pub checkpoint_seconds: f64,
    /// Checkpoints that are kept beside the candidates (`evaluation.candidates`).
    pub keep: usize,
    /// Episodes that means are taken over, and the deviation and the tail of costs that budgets and
    /// multipliers follow.
    pub window: usize,
}
