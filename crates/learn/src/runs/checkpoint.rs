//! Checkpoints: everything that a run needs to go on as if it had never stopped.
//!
//! A checkpoint is a directory with `weights.safetensors` (the networks' parameters by name and the
//! pixel statistics: all that acting needs), `training.safetensors` (moments of the optimiser,
//! states of the lanes) and `state.json` (counters, multipliers, statistics, and a checksum of the
//! other two). It is written under another name and renamed when complete and on the disk, so that
//! under its own name it is whole, whenever the machine may stop.

use std::borrow::Cow;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};

use hasard_envs::LaneState;
use safetensors::tensor::{Dtype, SafeTensors, TensorView, View, serialize};
use serde::{Deserialize, Serialize};

use crate::error::LearnError;
use crate::learning::learner::Learner;
use crate::learning::normaliser::Moments;
use crate::networks::ModelShape;
use crate::runs::checksum::crc32c;
use crate::runs::run_directory::read_selection;
use crate::runs::selection::{Candidate, Candidates};
use crate::runs::watch::Watch;
use crate::sampling::sampler::SamplerState;

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
    #[serde(default, skip_serializing)]
    pub hand_out: Option<Candidate>,
    /// The run was stopped in the midst of this moment's evaluation, which is still to be made.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub owes_evaluation: bool,
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
            all.ranked.extend(self.hand_out.clone());
        }
        all
    }
}

#[derive(Serialize, Deserialize)]
struct StateFile {
    format: u32,
    program: String,
    weights_checksum: u32,
    training_checksum: u32,
    progress: Progress,
}

impl StateFile {
    fn read(path: &Path) -> Result<StateFile, LearnError> {
        let text = fs::read(path).map_err(LearnError::file(path, "read"))?;
        serde_json::from_slice(&text)
            .map_err(|error| LearnError::content(path, format!("damaged: {error}")))
    }

    fn text(&self) -> Result<Vec<u8>, LearnError> {
        serde_json::to_vec_pretty(self).map_err(|error| {
            LearnError::Config(format!("the run's state cannot be written: {error}"))
        })
    }
}

const FORMAT: u32 = 1;
const WEIGHTS: &str = "weights.safetensors";
const TRAINING: &str = "training.safetensors";
const STATE: &str = "state.json";

/// A named block of numbers.
struct Block {
    kind: Dtype,
    shape: Vec<usize>,
    bytes: Vec<u8>,
}

impl View for &Block {
    fn dtype(&self) -> Dtype {
        self.kind
    }

    fn shape(&self) -> &[usize] {
        &self.shape
    }

    fn data(&self) -> Cow<'_, [u8]> {
        Cow::Borrowed(&self.bytes)
    }

    fn data_len(&self) -> usize {
        self.bytes.len()
    }
}

/// Refuses a block of another kind or number of values.
fn check_block(
    view: &TensorView<'_>,
    kind: Dtype,
    length: usize,
    name: &str,
) -> Result<(), String> {
    let count = 8 * view.data().len() / kind.bitsize();
    if view.dtype() != kind || count != length {
        return Err(format!("'{name}' has {count} values of {:?}, not {length}", view.dtype()));
    }
    Ok(())
}

macro_rules! block {
    ($name:ident, $parse:ident, $type:ty, $kind:ident) => {
        fn $name(values: &[$type], shape: Vec<usize>) -> Block {
            Block {
                kind: Dtype::$kind,
                shape,
                bytes: values.iter().flat_map(|value| value.to_le_bytes()).collect(),
            }
        }

        fn $parse(view: &TensorView<'_>, length: usize, name: &str) -> Result<Vec<$type>, String> {
            check_block(view, Dtype::$kind, length, name)?;
            let (chunks, _) = view.data().as_chunks::<{ size_of::<$type>() }>();
            Ok(chunks.iter().map(|bytes| <$type>::from_le_bytes(*bytes)).collect())
        }
    };
}
block!(floats, parse_floats, f32, F32);
block!(doubles, parse_doubles, f64, F64);
block!(words, parse_words, u64, U64);

/// A checkpoint in memory, ready to be written.
pub struct Checkpoint {
    weights: Vec<u8>,
    training: Vec<u8>,
    progress: Progress,
}

fn serialise(blocks: &[(String, Block)]) -> Result<Vec<u8>, LearnError> {
    serialize(blocks.iter().map(|(name, block)| (name.as_str(), block)), None).map_err(|error| {
        LearnError::Config(format!("weights cannot be written as safetensors: {error}"))
    })
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
        fs::create_dir_all(&temporary).map_err(LearnError::file(&temporary, "create"))?;
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
            .try_for_each(|(name, bytes)| write_through(&temporary.join(name), bytes));
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

/// Writes a file and waits until it is on the disk.
fn write_through(path: &Path, bytes: &[u8]) -> Result<(), LearnError> {
    let write = || {
        let mut file = File::create(path)?;
        file.write_all(bytes)?;
        file.sync_all()
    };
    write().map_err(LearnError::file(path, "write"))
}

/// A checkpoint read back and found whole.
#[derive(Serialize, Deserialize)]
pub struct Loaded {
    weights: Vec<u8>,
    training: Vec<u8>,
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

fn read_state(directory: &Path) -> Result<StateFile, LearnError> {
    let path = directory.join(STATE);
    let state = StateFile::read(&path)?;
    if state.format != FORMAT {
        let problem =
            format!("checkpoint format {}; this program reads format {FORMAT}", state.format);
        return Err(LearnError::content(&path, problem));
    }
    Ok(state)
}

fn read_progress(directory: &Path) -> Result<Progress, LearnError> {
    Ok(read_state(directory)?.progress)
}

impl Loaded {
    /// Reads a checkpoint and verifies its checksums.
    pub fn read(directory: &Path) -> Result<Loaded, LearnError> {
        let state = read_state(directory)?;
        let read = |name: &str, checksum: u32| {
            let path = directory.join(name);
            let bytes = fs::read(&path).map_err(LearnError::file(&path, "read"))?;
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

    fn weights_into(&self, learner: &mut Learner) -> Result<(), String> {
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
        if self.progress.returns.len() == learner.returns.len() {
            learner.returns.clone_from(&self.progress.returns);
        }
        learner.replaced();
        Ok(())
    }

    /// Puts everything into a learner, and gives back where the samplers were.
    pub fn restore(&self, learner: &mut Learner) -> Result<Vec<SamplerState>, LearnError> {
        self.all_into(learner).map_err(|problem| {
            LearnError::Config(format!("the checkpoint does not fit: {problem}"))
        })
    }

    fn all_into(&self, learner: &mut Learner) -> Result<Vec<SamplerState>, String> {
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
            // Whoever wrote the file may have meant harm: lengths that add up only by wrapping
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

fn remove(path: &Path) -> Result<(), LearnError> {
    fs::remove_dir_all(path).map_err(LearnError::file(path, "remove"))
}

/// The checkpoints of a run.
#[derive(Clone, Debug)]
pub struct Store {
    directory: PathBuf,
    keep: usize,
}

impl Store {
    /// The store in a run's directory.
    #[must_use]
    pub fn new(run: &Path, keep: usize) -> Store {
        Store { directory: run.join("checkpoints"), keep }
    }

    /// The checkpoint that the run selects, or would as far as it has come; `None` if it was never
    /// evaluated.
    #[must_use]
    pub fn selected(&self) -> Option<PathBuf> {
        let kept = self.numbered("best_");
        let closed = self
            .directory
            .parent()
            .and_then(read_selection)
            .map(|selection| self.best_of(selection.selected.frames));
        if let Some(closed) = closed.filter(|path| kept.contains(path)) {
            return Some(closed);
        }
        // The newest candidate knows of those before it. Files of older versions, which kept one,
        // say nothing of it.
        let newest = kept.into_iter().next()?;
        let known = read_progress(&newest)
            .ok()
            .and_then(|progress| Some(self.best_of(progress.candidates.ranked.first()?.frames)));
        Some(known.filter(|path| path.is_dir()).unwrap_or(newest))
    }

    /// All checkpoints to go on from, newest first.
    #[must_use]
    pub fn all(&self) -> Vec<PathBuf> {
        self.numbered("frames_")
    }

    fn numbered(&self, beginning: &str) -> Vec<PathBuf> {
        let Ok(entries) = fs::read_dir(&self.directory) else { return Vec::new() };
        let mut found: Vec<(u64, PathBuf)> = entries
            .filter_map(|entry| {
                let path = entry.ok()?.path();
                let frames = path.file_name()?.to_str()?.strip_prefix(beginning)?.parse().ok()?;
                Some((frames, path))
            })
            .collect();
        found.sort();
        found.into_iter().rev().map(|(_, path)| path).collect()
    }

    /// Writes a checkpoint to go on from; older ones beyond the number to keep go, and so do those
    /// that are no candidates any more by what it knows. Not earlier: whenever the run is killed,
    /// the candidates of its newest checkpoint are there.
    pub fn write(&self, checkpoint: &Checkpoint) -> Result<(), LearnError> {
        checkpoint
            .write(&self.directory.join(format!("frames_{:012}", checkpoint.progress.frames)))?;
        self.all().into_iter().skip(self.keep).try_for_each(|old| remove(&old))?;
        self.keep_candidates(&checkpoint.progress.candidates)
    }

    /// Writes the checkpoint of a candidate.
    pub fn write_best(&self, checkpoint: &Checkpoint) -> Result<(), LearnError> {
        checkpoint.write(&self.best_of(checkpoint.progress.frames))
    }

    /// Replaces what the checkpoint of so many frames says of itself, all at once; weights and
    /// states stay as they are.
    pub fn amend(&self, progress: &Progress) -> Result<(), LearnError> {
        let path = self.directory.join(format!("frames_{:012}", progress.frames)).join(STATE);
        let state = StateFile { progress: progress.clone(), ..StateFile::read(&path)? };
        let temporary = path.with_extension("partial");
        write_through(&temporary, &state.text()?)?;
        fs::rename(&temporary, &path).map_err(LearnError::file(&path, "write"))
    }

    /// Where the candidate of so many frames is.
    #[must_use]
    pub fn best_of(&self, frames: u64) -> PathBuf {
        self.directory.join(format!("best_{frames:012}"))
    }

    fn keep_candidates(&self, candidates: &Candidates) -> Result<(), LearnError> {
        let kept: Vec<PathBuf> =
            candidates.ranked.iter().map(|one| self.best_of(one.frames)).collect();
        if kept.is_empty() {
            return Ok(());
        }
        self.keep_only(&kept)
    }

    /// Removes all candidates but some.
    pub fn keep_only(&self, kept: &[PathBuf]) -> Result<(), LearnError> {
        self.numbered("best_")
            .into_iter()
            .filter(|path| !kept.contains(path))
            .try_for_each(|old| remove(&old))
    }

    /// Makes the directory agree with a checkpoint that the run goes on from, and gives its
    /// candidates so far: what a killed run left half-written goes, and so does what was a
    /// candidate in a future that will not be.
    pub fn go_back_to(&self, progress: &Progress) -> Result<Candidates, LearnError> {
        if let Ok(entries) = fs::read_dir(&self.directory) {
            let half = entries.filter_map(|entry| Some(entry.ok()?.path()));
            half.filter(|path| path.extension().is_some_and(|ending| ending == "partial"))
                .try_for_each(|path| remove(&path))?;
        }
        let mut known = progress.all_candidates();
        let had_any = !known.ranked.is_empty();
        known.ranked.retain(|one| self.best_of(one.frames).is_dir());
        if known.ranked.is_empty()
            && had_any
            && let Some(left) = self.numbered("best_").into_iter().next()
        {
            // The newer checkpoints were damaged, but a candidate is whole: better than nothing.
            known = Loaded::read(&left)?.progress.all_candidates();
            known.ranked.retain(|one| self.best_of(one.frames).is_dir());
        }
        let kept: Vec<PathBuf> = known.ranked.iter().map(|one| self.best_of(one.frames)).collect();
        self.keep_only(&kept)?;
        Ok(known)
    }

    /// The newest whole checkpoint; `warn` is told of each damaged one that is passed over.
    pub fn newest(&self, warn: &mut dyn FnMut(String)) -> Result<Option<Loaded>, LearnError> {
        let all = self.all();
        for path in &all {
            match Loaded::read(path) {
                Ok(loaded) => return Ok(Some(loaded)),
                Err(error) => warn(format!("{error}; going back to the checkpoint before it")),
            }
        }
        if all.is_empty() {
            return Ok(None);
        }
        Err(LearnError::content(
            &self.directory,
            "every checkpoint is damaged; start a new run, or copy a whole checkpoint here",
        ))
    }
}
