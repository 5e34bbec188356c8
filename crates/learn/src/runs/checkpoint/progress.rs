//! Counters and small state of a run, and the file that holds them.

use crate::error::LearnError;
use crate::learning::metrics::Means;
use crate::learning::normaliser::Moments;
use crate::runs::run_directory::read_regular;
use crate::runs::selection::{Candidate, Candidates};
use crate::runs::watch::Watch;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Counters and small state of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Progress {
    /// Frames learned from.
    pub frames: u64,
    /// Rollouts learned from.
    pub rollouts: u64,
    /// The lesson of a curriculum that the samplers are in.
    #[serde(default)]
    pub lesson: usize,
    /// Updates.
    pub updates: u64,
    /// Seconds of work so far, those before a resume too.
    pub wall_seconds: f64,
    /// The best evaluated checkpoints so far.
    #[serde(default)]
    pub candidates: Candidates,
    /// The best alone, as versions that kept no others wrote it; never written any more.
    #[serde(default, rename = "hand_out", skip_serializing)]
    pub sole_candidate: Option<Candidate>,
    /// The run was stopped in the midst of this moment's evaluation, which is still to be made.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub owes_evaluation: bool,
    /// What that moment's row says of learning, where the evaluation is still to be made.
    #[serde(default, skip_serializing_if = "Means::is_empty")]
    pub learning: Means,
    /// Statistics of each critic's returns.
    pub returns: Vec<Moments>,
    /// Steps of each optimiser.
    pub optimiser_steps: Vec<u64>,
    /// State of the algorithm.
    pub algorithm: serde_json::Value,
    /// Latest episodes.
    pub watch: Watch,
    /// Steps that each sampler's lanes have made, and their safety states.
    pub samplers: Vec<(u64, Vec<f64>)>,
    /// What each sampler's lanes have cost in their episodes so far, where critics see it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spent: Vec<Vec<f64>>,
    /// Frames that the pixel statistics have seen.
    pub pixel_count: f64,
}

impl Progress {
    /// The candidates, that of an older version among them.
    #[must_use]
    pub fn all_candidates(&self) -> Candidates {
        let mut all = self.candidates.clone();
        if all.ranked.is_empty() {
            all.ranked.extend(self.sole_candidate.clone());
        }
        all
    }
}

#[derive(Serialize, Deserialize)]
pub(super) struct StateFile {
    pub(super) format: u32,
    pub(super) program: String,
    pub(super) weights_checksum: u32,
    pub(super) training_checksum: u32,
    pub(super) progress: Progress,
}

impl StateFile {
    pub(super) fn read(path: &Path) -> Result<StateFile, LearnError> {
        let text = read_regular(path)?;
        serde_json::from_slice(&text)
            .map_err(|error| LearnError::content(path, format!("damaged: {error}")))
    }

    pub(super) fn text(&self) -> Result<Vec<u8>, LearnError> {
        serde_json::to_vec_pretty(self).map_err(|error| {
            LearnError::Config(format!("the run's state cannot be written: {error}"))
        })
    }
}

pub(super) const FORMAT: u32 = 1;
pub(super) const WEIGHTS: &str = "weights.safetensors";
pub(super) const TRAINING: &str = "training.safetensors";
pub(super) const STATE: &str = "state.json";

pub(super) fn read_state(directory: &Path) -> Result<StateFile, LearnError> {
    let path = directory.join(STATE);
    let state = StateFile::read(&path)?;
    if state.format != FORMAT {
        let problem =
            format!("checkpoint format {}; this program reads format {FORMAT}", state.format);
        return Err(LearnError::content(&path, problem));
    }
    Ok(state)
}

pub(super) fn read_progress(directory: &Path) -> Result<Progress, LearnError> {
    Ok(read_state(directory)?.progress)
}
