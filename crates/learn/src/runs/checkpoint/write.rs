//! A checkpoint in memory, and its files.

use crate::error::LearnError;
use crate::learning::learner::Learner;
use crate::networks::ModelShape;
use crate::runs::checkpoint::blocks::{Block, doubles, floats, serialise, words};
use crate::runs::checkpoint::progress::{FORMAT, Progress, STATE, StateFile, TRAINING, WEIGHTS};
use crate::runs::checksum::crc32c;
use crate::runs::run_directory::write_through;
use crate::sampling::sampler::SamplerState;
use safetensors::tensor::Dtype;
use std::fs;
use std::fs::File;
use std::path::Path;

/// A checkpoint in memory, ready to be written.
pub struct Checkpoint {
    pub(super) weights: Vec<u8>,
    pub(super) training: Vec<u8>,
    pub(super) progress: Progress,
}

/// Names of all parameters: those of a model of several networks begin with the network's number.
pub(crate) fn parameter_names(
    shape: &ModelShape,
) -> Vec<(String, Vec<usize>, std::ops::Range<usize>)> {
    let mut names = Vec::new();
    for (index, network) in shape.networks.iter().enumerate() {
        let start = shape.parameter_range(index).start;
        for parameter in network.parameters() {
            let range = start + parameter.offset..start + parameter.offset + parameter.size();
            names.push((
                format!("network{index}.{}", parameter.name),
                parameter.shape.clone(),
                range,
            ));
        }
    }
    names
}

impl Checkpoint {
    /// Takes down where everything is.
    pub fn take(
        learner: &Learner,
        samplers: &[SamplerState],
        progress: Progress,
    ) -> Result<Checkpoint, LearnError> {
        let mut weights = Vec::new();
        for (name, shape, range) in parameter_names(learner.shape()) {
            weights.push((name, floats(&learner.parameters[range], shape)));
        }
        let pixels = learner.pixels.mean.len();
        weights.push(("pixels.mean".into(), doubles(&learner.pixels.mean, vec![pixels])));
        weights.push(("pixels.variance".into(), doubles(&learner.pixels.variance, vec![pixels])));
        let mut training = Vec::new();
        for (index, adam) in learner.optimisers.iter().enumerate() {
            training
                .push((format!("adam{index}.first"), floats(&adam.first, vec![adam.first.len()])));
            training.push((
                format!("adam{index}.second"),
                floats(&adam.second, vec![adam.second.len()]),
            ));
        }
        for (index, sampler) in samplers.iter().enumerate() {
            for (network, state) in sampler.state.iter().enumerate() {
                training.push((
                    format!("sampler{index}.state{network}"),
                    floats(state, vec![state.len()]),
                ));
            }
            let numbers: Vec<u64> = sampler
                .worlds
                .iter()
                .flat_map(|lane| {
                    [lane.seeds, lane.seed, lane.actions.len() as u64, lane.deltas.len() as u64]
                })
                .collect();
            let actions: Vec<u8> =
                sampler.worlds.iter().flat_map(|lane| lane.actions.iter().copied()).collect();
            let deltas: Vec<f32> =
                sampler.worlds.iter().flat_map(|lane| lane.deltas.iter().copied()).collect();
            training.push((
                format!("sampler{index}.lanes"),
                words(&numbers, vec![sampler.worlds.len(), 4]),
            ));
            let actions = Block { kind: Dtype::U8, shape: vec![actions.len()], bytes: actions };
            training.push((format!("sampler{index}.actions"), actions));
            training.push((format!("sampler{index}.deltas"), floats(&deltas, vec![deltas.len()])));
        }
        Ok(Checkpoint { weights: serialise(&weights)?, training: serialise(&training)?, progress })
    }

    /// Writes it as a directory that appears under its name all at once.
    pub fn write(&self, directory: &Path) -> Result<(), LearnError> {
        let temporary = directory.with_extension("partial");
        if temporary.exists() {
            fs::remove_dir_all(&temporary).map_err(LearnError::file(&temporary, "remove"))?;
        }
        // The folder alone: its parent is the run's, and is not made again where that was moved.
        fs::create_dir(&temporary).map_err(LearnError::file(&temporary, "create"))?;
        let state = StateFile {
            format: FORMAT,
            program: env!("CARGO_PKG_VERSION").into(),
            weights_checksum: crc32c(&self.weights),
            training_checksum: crc32c(&self.training),
            progress: self.progress.clone(),
        }
        .text()?;
        let written = [(WEIGHTS, &self.weights), (TRAINING, &self.training), (STATE, &state)]
            .into_iter()
            .try_for_each(|(name, bytes)| {
                let path = temporary.join(name);
                write_through(&path, bytes).map_err(LearnError::file(&path, "write"))
            });
        if let Err(error) = written {
            // Half a checkpoint on a full disk helps nobody.
            let _ = fs::remove_dir_all(&temporary);
            return Err(error);
        }
        if directory.exists() {
            fs::remove_dir_all(directory).map_err(LearnError::file(directory, "replace"))?;
        }
        fs::rename(&temporary, directory)
            .map_err(LearnError::file(directory, "rename into place"))?;
        if let Some(parent) = directory.parent() {
            // Makes the new name last through a power cut; not all systems can.
            let _ = File::open(parent).and_then(|parent| parent.sync_all());
        }
        Ok(())
    }
}
