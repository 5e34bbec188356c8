//! An agent as one small file, to be handed to others: its settings, what it is worth, and weights
//! of four or eight bits.
//!
//! The file is safetensors, its weights rounded to codes (rounding.rs). Small tensors
//! take eight bits a code. So do large ones where the file stays within `LIMIT`; otherwise four.
//! Statistics of pixels take sixteen bits. What is lost is about what a step of training changes;
//! what the agent is worth with it, `hasard eval FILE` shows.

use std::collections::{BTreeMap, HashMap};
use std::fs;
use std::path::Path;

use hasard_media::files::{NO_FILE, is_special};
use safetensors::tensor::{Dtype, SafeTensors, TensorView, serialize};
use serde::{Deserialize, Serialize};

use crate::config::TrainConfig;
use crate::error::LearnError;
use crate::learning::learner::Learner;
use crate::learning::normaliser::Moments;
use crate::networks::ModelShape;
use crate::runs::checkpoint::{Loaded, Store, parameter_names};
use crate::runs::rounding::{bits_of, round, unround};
use crate::runs::run_directory::{GONE, go_on, read_config, read_selection, spoiled_selection};
use crate::runs::selection::Candidate;
use crate::runs::temperature::Temperature;
use crate::runs::zoo;
use crate::sampling::auxiliary::Auxiliary;

/// Bytes that a file is to stay within, where four bits a weight suffice for it.
const LIMIT: usize = 2_000_000;
/// Tensors of fewer weights always take eight bits a code: early layers, heads and biases.
const SMALL: usize = 100_000;
/// Bytes of the largest file that is read.
const LARGEST: u64 = 256 << 20;
/// Layout of the file.
const FORMAT: u32 = 1;
/// The same of an agent with a temperature, which a program that knows of none must not play.
const TEMPERED: u32 = 2;
/// Name of the file's own entry among its metadata.
const CARD: &str = "hasard";

/// What a file says of its agent, beside the weights.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Card {
    format: u32,
    /// Version of the program that wrote it.
    pub program: String,
    /// Settings of the run that it comes from.
    pub config: TrainConfig,
    /// What the run said when it selected it, before its weights were rounded.
    #[serde(alias = "hand_out")]
    pub selection: Option<Candidate>,
    /// What the policy's logits are divided by as it acts.
    #[serde(default, skip_serializing_if = "Temperature::is_as_trained")]
    pub temperature: Temperature,
    /// Statistics of each critic's returns, in whose units the critics' values are; none in files
    /// of programs that did not write them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub returns: Vec<Moments>,
}

impl Card {
    /// The card of the same weights at this temperature.
    fn at(self, temperature: Temperature) -> Card {
        if temperature == self.temperature {
            return self;
        }
        let format = if temperature.is_as_trained() { FORMAT } else { TEMPERED };
        Card { format, temperature, selection: None, ..self }
    }
}

/// An agent read from a file.
pub struct AgentFile {
    /// What the file says of it.
    pub card: Card,
    /// Codes and scales by the names of the tensors; how many weights they stand for, the network's
    /// shape says.
    codes: HashMap<String, (Vec<u8>, Vec<f32>)>,
    pixel_mean: Vec<f64>,
    pixel_variance: Vec<f64>,
}

/// The file of the agent that a run selects.
pub fn export(run: &Path) -> Result<Vec<u8>, LearnError> {
    let config = read_config(run)?;
    let store = Store::new(run, 1);
    let best = store.read_selected().map_err(|error| spoiled_selection(&error))?;
    let (_, checkpoint) = best.ok_or_else(|| {
        if store.has_judged() {
            return LearnError::content(run, GONE);
        }
        let command = format!("{} --eval-every {}", go_on(&config, run), config.frames);
        LearnError::content(
            run,
            format!("no checkpoint was selected yet; let the run be evaluated: {command}"),
        )
    })?;
    // A run that went on since it was selected may have dropped that checkpoint: what is known of
    // another says nothing of this one.
    let frames = checkpoint.progress.frames;
    let closed = read_selection(run).map(|selection| selection.selected);
    let known = closed.into_iter().chain(checkpoint.progress.all_candidates().ranked);
    let selection = known.into_iter().find(|one| one.frames == frames);
    pack(&config, selection, &checkpoint)
}

/// The file of the agent of a run's latest checkpoint; it says what the policy at the end of the
/// run is worth, if that is the one. `warn` gets a line for each damaged checkpoint that is passed
/// over.
pub fn export_latest(run: &Path, warn: &mut dyn FnMut(String)) -> Result<Vec<u8>, LearnError> {
    let config = read_config(run)?;
    let checkpoint = Store::new(run, 1)
        .newest(warn)?
        .ok_or_else(|| LearnError::content(run, "no checkpoint was written yet; let it train"))?;
    let last = read_selection(run).and_then(|selection| selection.last);
    let selection = last.filter(|last| last.frames == checkpoint.progress.frames).map(|last| {
        let closing = Some(last.closing.clone());
        Candidate { closing, ..Candidate::new(last.frames, last.closing) }
    });
    pack(&config, selection, &checkpoint)
}

/// The file of the agent of a checkpoint.
fn pack(
    config: &TrainConfig,
    selection: Option<Candidate>,
    checkpoint: &Loaded,
) -> Result<Vec<u8>, LearnError> {
    let wrong = |error: &dyn std::fmt::Display| {
        LearnError::Config(format!("the checkpoint cannot become an agent file: {error}"))
    };
    let tensors = checkpoint.tensors().map_err(|error| wrong(&error))?;
    let card = Card {
        format: FORMAT,
        program: env!("CARGO_PKG_VERSION").into(),
        config: config.clone(),
        selection,
        temperature: Temperature::default(),
        returns: checkpoint.progress.returns.clone(),
    };
    let card = serde_json::to_string(&card).map_err(|error| wrong(&error))?;
    let mut file = Vec::new();
    for bits in [8, 4] {
        let mut blocks: BTreeMap<String, (Dtype, Vec<u8>)> = BTreeMap::new();
        for (name, view) in tensors.iter().filter(|(name, _)| !predicts(config, name)) {
            if name.starts_with("pixels.") {
                blocks.insert(
                    name.into(),
                    (Dtype::U16, sixteen_bits(&view, name == "pixels.variance")),
                );
                continue;
            }
            let (words, _) = view.data().as_chunks::<4>();
            let weights: Vec<f32> = words.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
            let (codes, scales) = round(&weights, if weights.len() < SMALL { 8 } else { bits });
            blocks.insert(name.into(), (Dtype::U8, codes));
            blocks.insert(
                format!("{name}.scale"),
                (Dtype::F32, scales.iter().flat_map(|scale| scale.to_le_bytes()).collect()),
            );
        }
        let views = blocks.iter().map(|(name, (kind, bytes))| {
            let width = match kind {
                Dtype::U8 => 1,
                Dtype::U16 => 2,
                _ => 4,
            };
            TensorView::new(*kind, vec![bytes.len() / width], bytes)
                .map(|view| (name.clone(), view))
        });
        let views: Vec<_> = views.collect::<Result<_, _>>().map_err(|error| wrong(&error))?;
        let metadata = HashMap::from([(CARD.to_string(), card.clone())]);
        file = serialize(views, Some(metadata)).map_err(|error| wrong(&error))?;
        if file.len() <= LIMIT {
            break;
        }
    }
    Ok(file)
}

/// The bytes of an agent's file whose policy acts at this temperature, whatever the file's was. What
/// its run said of it is not in the new file: it was of another policy.
///
/// # Errors
/// What is wrong with the file.
pub fn tempered(bytes: &[u8], temperature: Temperature) -> Result<Vec<u8>, String> {
    let card = AgentFile::parse(bytes)?.card.at(temperature);
    let tensors = SafeTensors::deserialize(bytes).map_err(|error| error.to_string())?;
    let card = serde_json::to_string(&card).map_err(|error| error.to_string())?;
    serialize(tensors.iter(), Some(HashMap::from([(CARD.to_string(), card)])))
        .map_err(|error| error.to_string())
}

/// Whether a tensor is of the head that predicts what pictures show, which nothing acts by: the one
/// behind those of the policy and of all critics.
fn predicts(config: &TrainConfig, tensor: &str) -> bool {
    let costs = if config.algorithm.has_cost_critics() { config.constraints.len() } else { 0 };
    let head = format!("network0.head{}.", 2 + costs);
    Auxiliary::new(config).outputs() > 0 && tensor.starts_with(&head)
}

/// Means, which lie between 0 and 1, and deviations, which lie between 0 and a half, in steps of
/// 1/65535.
fn sixteen_bits(view: &TensorView<'_>, squared: bool) -> Vec<u8> {
    let (words, _) = view.data().as_chunks::<8>();
    let numbers = words.iter().map(|bytes| f64::from_le_bytes(*bytes));
    let steps = numbers.map(|number| {
        (if squared { number.max(0.0).sqrt() } else { number } * 65535.0).round() as u16
    });
    steps.flat_map(u16::to_le_bytes).collect()
}

fn misfit(name: &str) -> LearnError {
    LearnError::Config(format!("the agent's file does not fit its own settings: {name}"))
}

impl AgentFile {
    /// The agent's file at a place: a file, or `zoo:NAME`, one that is part of the program. `None`
    /// for anything else, such as a run's directory.
    pub fn at(place: &Path) -> Result<Option<AgentFile>, LearnError> {
        AgentFile::is_at(place).then(|| AgentFile::read(place)).transpose()
    }

    /// Whether a place is that of a file, or of an agent of the program, rather than a run's.
    #[must_use]
    pub fn is_at(place: &Path) -> bool {
        zoo::bytes(place).is_some() || place.is_file()
    }

    /// Reads an agent's file.
    pub fn read(path: &Path) -> Result<AgentFile, LearnError> {
        AgentFile::read_whole(path).map(|(_, file)| file)
    }

    /// Reads an agent's file, `zoo:NAME` among them, with its bytes.
    ///
    /// # Errors
    /// When it is not an agent's file.
    pub fn read_whole(path: &Path) -> Result<(Vec<u8>, AgentFile), LearnError> {
        if let Some(bytes) = zoo::bytes(path) {
            let file =
                AgentFile::parse(bytes).map_err(|problem| LearnError::content(path, problem))?;
            return Ok((bytes.to_vec(), file));
        }
        let kind = fs::metadata(path).map_err(LearnError::file(path, "read"))?;
        if is_special(&kind) {
            return Err(LearnError::content(path, NO_FILE));
        }
        if kind.len() > LARGEST {
            return Err(LearnError::content(
                path,
                "too large for an agent's file; give one that `hasard export-agent` wrote",
            ));
        }
        let bytes = fs::read(path).map_err(LearnError::file(path, "read"))?;
        let file = AgentFile::parse(&bytes).map_err(|problem| {
            LearnError::content(
                path,
                format!(
                    "not an agent's file ({problem}); give one that `hasard export-agent` wrote"
                ),
            )
        })?;
        Ok((bytes, file))
    }

    /// Understands the bytes of an agent's file.
    pub fn parse(bytes: &[u8]) -> Result<AgentFile, String> {
        let (_, metadata) =
            SafeTensors::read_metadata(bytes).map_err(|_| "it has no safetensors header")?;
        let card = metadata
            .metadata()
            .as_ref()
            .and_then(|all| all.get(CARD))
            .ok_or("its header describes no agent")?;
        let card: Card =
            serde_json::from_str(card).map_err(|error| format!("its card: {error}"))?;
        if !(FORMAT..=TEMPERED).contains(&card.format) {
            return Err(format!(
                "format {}, this program reads {FORMAT} and {TEMPERED}",
                card.format
            ));
        }
        card.config.check().map_err(|error| error.to_string())?;
        if !card.returns.iter().all(Moments::are_sound) {
            return Err("its card: statistics of returns that no returns have".into());
        }
        let tensors = SafeTensors::deserialize(bytes).map_err(|error| error.to_string())?;
        let mut codes = HashMap::new();
        for (name, view) in tensors.iter().filter(|(_, view)| view.dtype() == Dtype::U8) {
            let scales = tensors
                .tensor(&format!("{name}.scale"))
                .map_err(|error| format!("{name}: {error}"))?;
            let (words, _) = scales.data().as_chunks::<4>();
            let scales: Vec<f32> = words.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
            if !scales.iter().all(|scale| scale.is_finite()) {
                return Err(format!("{name}: a weight is no finite number"));
            }
            codes.insert(name.to_string(), (view.data().to_vec(), scales));
        }
        let pixels = |name: &str| -> Result<Vec<f64>, String> {
            let view = tensors.tensor(name).map_err(|error| format!("{name}: {error}"))?;
            let (words, _) = view.data().as_chunks::<2>();
            Ok(words.iter().map(|bytes| f64::from(u16::from_le_bytes(*bytes)) / 65535.0).collect())
        };
        let pixel_mean = pixels("pixels.mean")?;
        let pixel_variance =
            pixels("pixels.variance")?.into_iter().map(|deviation| deviation * deviation).collect();
        Ok(AgentFile { card, codes, pixel_mean, pixel_variance })
    }

    /// Refuses a shape of other weights than the file's.
    pub(crate) fn check_fits(&self, shape: &ModelShape) -> Result<(), LearnError> {
        for (name, _, range) in parameter_names(shape) {
            let (bytes, scales) = self.codes.get(&name).ok_or_else(|| misfit(&name))?;
            bits_of(bytes, scales, range.len()).ok_or_else(|| misfit(&name))?;
        }
        Ok(())
    }

    /// Puts the weights into a learner, from which the agent acts.
    pub(crate) fn restore_weights(&self, learner: &mut Learner) -> Result<(), LearnError> {
        self.restore(learner, self.card.temperature)
    }

    fn restore(&self, learner: &mut Learner, temperature: Temperature) -> Result<(), LearnError> {
        let action = learner.shape().action.clone();
        for (name, _, range) in parameter_names(learner.shape()) {
            let (bytes, scales) = self.codes.get(&name).ok_or_else(|| misfit(&name))?;
            let mut weights = unround(bytes, scales, range.len()).ok_or_else(|| misfit(&name))?;
            temperature.apply(&action, &name, &mut weights);
            learner.parameters[range].copy_from_slice(&weights);
        }
        let pixels = learner.pixels.mean.len();
        if self.pixel_mean.len() != pixels || self.pixel_variance.len() != pixels {
            return Err(misfit("pixels"));
        }
        learner.pixels.mean.clone_from(&self.pixel_mean);
        learner.pixels.variance.clone_from(&self.pixel_variance);
        learner.replaced();
        Ok(())
    }

    /// Puts the weights into a learner that is to learn on: the statistics of pixels count as many
    /// pictures as the agent's own training saw. It begins with what was trained, whatever the
    /// temperature.
    pub(crate) fn begin(&self, learner: &mut Learner) -> Result<(), LearnError> {
        self.restore(learner, Temperature::default())
            .map_err(|_| LearnError::no_beginning("agent"))?;
        let config = &self.card.config;
        learner.pixels.count = (config.frames / u64::from(config.env.frame_skip).max(1)) as f64;
        learner.begin_with(&self.card.returns);
        Ok(())
    }
}
