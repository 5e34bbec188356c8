//! A checkpoint read back and found whole.

use crate::error::LearnError;
use crate::learning::learner::Learner;
use crate::networks::ModelShape;
use crate::runs::checkpoint::blocks::{check_block, parse_doubles, parse_floats, parse_words};
use crate::runs::checkpoint::progress::{Progress, TRAINING, WEIGHTS, read_state};
use crate::runs::checkpoint::write::{Checkpoint, parameter_names};
use crate::runs::checksum::{crc32c, sha256};
use crate::runs::run_directory::read_regular;
use crate::sampling::sampler::SamplerState;
use hasard_envs::LaneState;
use safetensors::tensor::{Dtype, SafeTensors};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// A checkpoint read back and found whole.
#[derive(Serialize, Deserialize)]
pub struct Loaded {
    pub(super) weights: Vec<u8>,
    pub(super) training: Vec<u8>,
    /// Counters and small state.
    #[serde(with = "as_text")]
    pub progress: Progress,
}

/// Multipliers are of many shapes, which only a format that describes itself can hold.
mod as_text {
    use super::Progress;
    use serde::de::Error as _;
    use serde::ser::Error as _;
    use serde::{Deserialize, Deserializer, Serializer};

    pub fn serialize<S: Serializer>(progress: &Progress, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(&serde_json::to_string(progress).map_err(S::Error::custom)?)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Progress, D::Error> {
        serde_json::from_str(&String::deserialize(from)?).map_err(D::Error::custom)
    }
}

impl Loaded {
    /// Reads a checkpoint and verifies its checksums.
    pub fn read(directory: &Path) -> Result<Loaded, LearnError> {
        let state = read_state(directory)?;
        let read = |name: &str, checksum: u32| {
            let path = directory.join(name);
            let bytes = read_regular(&path)?;
            if crc32c(&bytes) != checksum {
                return Err(LearnError::content(
                    &path,
                    "damaged: its checksum is not the one noted when it was written",
                ));
            }
            Ok(bytes)
        };
        Ok(Loaded {
            weights: read(WEIGHTS, state.weights_checksum)?,
            training: read(TRAINING, state.training_checksum)?,
            progress: state.progress,
        })
    }

    /// The same, ready to be written again with other counters.
    #[must_use]
    pub fn with(&self, progress: Progress) -> Checkpoint {
        Checkpoint { weights: self.weights.clone(), training: self.training.clone(), progress }
    }

    /// SHA-256 of the networks' parameters and the statistics of pixels.
    pub(crate) fn weights_sha256(&self) -> String {
        sha256(&self.weights)
    }

    /// The networks' parameters and the statistics of pixels, by name.
    pub fn tensors(&self) -> Result<SafeTensors<'_>, String> {
        SafeTensors::deserialize(&self.weights).map_err(|error| error.to_string())
    }

    /// Refuses a shape of other weights than the checkpoint's.
    pub(crate) fn check_fits(&self, shape: &ModelShape) -> Result<(), LearnError> {
        let misfit =
            |problem: String| LearnError::Config(format!("the checkpoint does not fit: {problem}"));
        let tensors = self.tensors().map_err(misfit)?;
        for (name, _, range) in parameter_names(shape) {
            let found =
                tensors.tensor(&name).map_err(|error| misfit(format!("{name}: {error}")))?;
            check_block(&found, Dtype::F32, range.len(), &name).map_err(misfit)?;
        }
        Ok(())
    }

    /// Puts weights and normalisers into a learner: all that acting needs, and what a new run may
    /// begin with.
    pub fn restore_weights(&self, learner: &mut Learner) -> Result<(), LearnError> {
        self.weights_into(learner).map_err(|problem| {
            LearnError::Config(format!("the checkpoint does not fit: {problem}"))
        })
    }

    /// Puts weights and normalisers into a learner that is to learn on.
    pub(crate) fn begin(&self, learner: &mut Learner) -> Result<(), LearnError> {
        self.weights_into(learner).map_err(|_| LearnError::no_beginning("run"))
    }

    pub(super) fn weights_into(&self, learner: &mut Learner) -> Result<(), String> {
        let tensors = self.tensors()?;
        let find = |name: &str| tensors.tensor(name).map_err(|error| format!("{name}: {error}"));
        for (name, _, range) in parameter_names(learner.shape()) {
            let values = parse_floats(&find(&name)?, range.len(), &name)?;
            learner.parameters[range].copy_from_slice(&values);
        }
        let pixels = learner.pixels.mean.len();
        learner.pixels.mean = parse_doubles(&find("pixels.mean")?, pixels, "pixels.mean")?;
        learner.pixels.variance =
            parse_doubles(&find("pixels.variance")?, pixels, "pixels.variance")?;
        learner.pixels.count = self.progress.pixel_count;
        learner.begin_with(&self.progress.returns);
        learner.replaced();
        Ok(())
    }

    /// Puts everything into a learner, and gives back where the samplers were.
    pub fn restore(&self, learner: &mut Learner) -> Result<Vec<SamplerState>, LearnError> {
        self.all_into(learner).map_err(|problem| {
            LearnError::Config(format!("the checkpoint does not fit: {problem}"))
        })
    }

    pub(super) fn all_into(&self, learner: &mut Learner) -> Result<Vec<SamplerState>, String> {
        self.weights_into(learner)?;
        let progress = &self.progress;
        if progress.returns.len() != learner.returns.len()
            || progress.optimiser_steps.len() != learner.optimisers.len()
        {
            return Err("it has another number of critics".into());
        }
        learner.version = progress.updates;
        let tensors =
            SafeTensors::deserialize(&self.training).map_err(|error| error.to_string())?;
        let find = |name: &str| tensors.tensor(name).map_err(|error| format!("{name}: {error}"));
        for (index, (adam, &steps)) in
            learner.optimisers.iter_mut().zip(&progress.optimiser_steps).enumerate()
        {
            for (name, values) in [("first", &mut adam.first), ("second", &mut adam.second)] {
                let name = format!("adam{index}.{name}");
                *values = parse_floats(&find(&name)?, values.len(), &name)?;
            }
            adam.steps = steps;
        }
        let mut samplers = Vec::new();
        for (index, (steps, safety)) in progress.samplers.iter().enumerate() {
            let lanes = safety.len();
            let mut state = Vec::new();
            for (network, shape) in learner.shape().networks.iter().enumerate() {
                let name = format!("sampler{index}.state{network}");
                state.push(parse_floats(&find(&name)?, lanes * shape.state_size(), &name)?);
            }
            let numbers =
                parse_words(&find(&format!("sampler{index}.lanes"))?, lanes * 4, "lanes")?;
            // The file may come from an attacker: lengths that add up only by wrapping
            // around are none.
            let count = |column: usize| {
                let mut lengths = numbers
                    .iter()
                    .skip(column)
                    .step_by(4)
                    .map(|&length| usize::try_from(length).ok());
                let sum = lengths.try_fold(0usize, |sum, length| sum.checked_add(length?));
                sum.ok_or_else(|| {
                    format!("the episodes of sampler {index} have impossible lengths")
                })
            };
            let (action_count, delta_count) = (count(2)?, count(3)?);
            let actions = find(&format!("sampler{index}.actions"))?;
            let deltas =
                parse_floats(&find(&format!("sampler{index}.deltas"))?, delta_count, "deltas")?;
            if actions.data().len() != action_count {
                return Err(format!(
                    "sampler {index} has {} actions, not {action_count}",
                    actions.data().len()
                ));
            }
            let (mut actions, mut deltas) = (actions.data(), &deltas[..]);
            let mut worlds = Vec::new();
            for lane in numbers.chunks_exact(4) {
                let (own, rest) = actions.split_at(lane[2] as usize);
                let (own_deltas, rest_deltas) = deltas.split_at(lane[3] as usize);
                worlds.push(LaneState {
                    seeds: lane[0],
                    seed: lane[1],
                    // The run's settings say of which.
                    env: 0,
                    actions: own.to_vec(),
                    deltas: own_deltas.to_vec(),
                });
                (actions, deltas) = (rest, rest_deltas);
            }
            let spent = progress.spent.get(index).cloned().unwrap_or_default();
            if !spent.is_empty() && (lanes == 0 || !spent.len().is_multiple_of(lanes)) {
                return Err(format!(
                    "the costs so far of sampler {index} are not those of {lanes} worlds"
                ));
            }
            samplers.push(SamplerState {
                worlds,
                state,
                safety: safety.clone(),
                spent,
                steps: *steps,
            });
        }
        Ok(samplers)
    }
}
