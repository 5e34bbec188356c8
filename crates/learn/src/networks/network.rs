//! What can be done with a network, whatever device it lives on.

use std::ops::Range;
use std::sync::Arc;

use crate::networks::cpu::tape::Tape;
use crate::networks::cpu::weights::PackedWeights;
use crate::networks::pixels::PixelScale;
use crate::networks::shape::NetworkShape;

/// Trajectories of equal length for a forward pass. Step `t` of lane `l` is row `t * lanes + l`
/// everywhere.
#[derive(Clone, Debug)]
pub struct Sequences<'a> {
    /// Steps of each trajectory.
    pub steps: usize,
    /// Number of trajectories.
    pub lanes: usize,
    /// One image a row.
    pub observations: Vec<&'a [u8]>,
    /// Extra inputs, `extra_inputs` a row.
    pub extra: Vec<f32>,
    /// State of each lane before its first step.
    pub initial_state: Vec<f32>,
    /// Rows before which the state is reset to zero, because the episode before has ended.
    pub reset: Vec<bool>,
    /// What was computed of each lane when it was acted in; empty if nothing was kept.
    pub recorded: Vec<RecordedLane<'a>>,
}

impl<'a> Sequences<'a> {
    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.steps * self.lanes
    }

    /// The rows of some lanes, as a batch of those lanes has them.
    pub(crate) fn rows_of(&self, lanes: &[usize]) -> impl Iterator<Item = usize> {
        (0..self.steps).flat_map(move |step| lanes.iter().map(move |lane| step * self.lanes + lane))
    }

    /// The trajectories of some lanes, each with `extra` extra inputs a row; states and what was
    /// recorded are left out.
    pub(crate) fn of_lanes(&self, extra: usize, lanes: &[usize]) -> Sequences<'a> {
        Sequences {
            steps: self.steps,
            lanes: lanes.len(),
            observations: self.rows_of(lanes).map(|row| self.observations[row]).collect(),
            extra: self
                .rows_of(lanes)
                .flat_map(|row| &self.extra[row * extra..(row + 1) * extra])
                .copied()
                .collect(),
            initial_state: Vec::new(),
            reset: self.rows_of(lanes).map(|row| self.reset[row]).collect(),
            recorded: Vec::new(),
        }
    }
}

impl<'a> Sequences<'a> {
    /// The trajectories of some lanes, with their states and what was recorded of them, if that was
    /// of all.
    pub(crate) fn part(&self, shape: &NetworkShape, lanes: &[usize]) -> Sequences<'a> {
        let whole = self.recorded.len() == self.lanes;
        Sequences {
            initial_state: states_of(&self.initial_state, shape.state_size(), lanes),
            recorded: if whole {
                lanes.iter().map(|&lane| self.recorded[lane]).collect()
            } else {
                Vec::new()
            },
            ..self.of_lanes(shape.extra_inputs, lanes)
        }
    }
}

/// The states of some lanes, each of `units` numbers.
pub(crate) fn states_of(states: &[f32], units: usize, lanes: &[usize]) -> Vec<f32> {
    lanes.iter().flat_map(|lane| &states[lane * units..(lane + 1) * units]).copied().collect()
}

/// Weights of one network for acting: immutable and shared.
#[derive(Clone, Debug)]
pub enum NetworkWeights {
    /// As the processor's kernels read them.
    Packed {
        /// Weights.
        weights: Arc<PackedWeights>,
        /// How pixels enter, in the order of the first layer's stored input.
        pixels: Arc<PixelScale>,
    },
    /// As a flat vector.
    Plain {
        /// Parameters.
        parameters: Arc<Vec<f32>>,
        /// How pixels enter, in the image's order.
        pixels: Arc<PixelScale>,
    },
}

/// A set of weights that samplers may use, numbered.
#[derive(Clone, Debug)]
pub struct Published {
    /// Number of the update that made it.
    pub version: u64,
    /// Weights of each network of the model.
    pub networks: Vec<NetworkWeights>,
}

/// What an acting network computed in a rollout. A learner that holds the very same weights need
/// not compute it again: outputs of a row depend neither on the rows beside it nor on who computes
/// them, bit for bit.
#[derive(Clone, Debug, Default)]
pub struct Recording {
    pub(crate) tape: Tape,
    /// What all steps were computed with.
    made_with: Option<(Arc<PackedWeights>, Arc<PixelScale>)>,
    /// They were not computed with one set of weights.
    mixed: bool,
}

impl Recording {
    /// Forgets what was recorded, and keeps the memory.
    pub fn clear(&mut self) {
        (self.made_with, self.mixed) = (None, false);
    }

    /// Notes what a step is computed with.
    pub(crate) fn note(&mut self, weights: &Arc<PackedWeights>, pixels: &Arc<PixelScale>) {
        self.mixed |= self.made_with.is_some() && !self.holds(weights, pixels);
        self.made_with = Some((Arc::clone(weights), Arc::clone(pixels)));
    }

    /// Whether all of it was computed with these very weights.
    pub(crate) fn holds(&self, weights: &Arc<PackedWeights>, pixels: &Arc<PixelScale>) -> bool {
        let same = |own: &(Arc<PackedWeights>, Arc<PixelScale>)| {
            Arc::ptr_eq(&own.0, weights) && Arc::ptr_eq(&own.1, pixels)
        };
        !self.mixed && self.made_with.as_ref().is_some_and(same)
    }
}

/// One lane of a recording.
#[derive(Clone, Copy, Debug)]
pub struct RecordedLane<'a> {
    /// The recording.
    pub recording: &'a Recording,
    /// The lane's number in it.
    pub lane: usize,
}

/// Where an acting network notes a step.
#[derive(Debug)]
pub struct Place<'a> {
    /// In which recording, of how many steps and lanes.
    pub recording: &'a mut Recording,
    /// Steps of the recording.
    pub steps: usize,
    /// Lanes of the recording.
    pub all_lanes: usize,
    /// Which step.
    pub step: usize,
    /// Which lanes.
    pub lanes: Range<usize>,
}

/// A network that acts: one step at a time.
pub trait ActingNetwork: Send {
    /// Takes over weights.
    fn load(&mut self, weights: &NetworkWeights);

    /// Outputs for one step of some lanes; `state` is replaced by the state after. Networks that
    /// can do so note in `place` what a backward pass needs.
    fn act(
        &mut self,
        observations: &[u8],
        extra: &[f32],
        state: &mut [f32],
        outputs: &mut [f32],
        place: Option<Place<'_>>,
    );
}

/// A network that learns.
pub trait LearningNetwork: Send {
    /// Its shape.
    fn shape(&self) -> &NetworkShape;

    /// Takes over weights.
    fn load(&mut self, parameters: &[f32]);

    /// Takes over how pixels enter.
    fn load_pixels(&mut self, pixels: &PixelScale);

    /// The weights for acting.
    fn publish(&self) -> NetworkWeights;

    /// Outputs of all rows, `shape().outputs()` a row; what a backward pass needs is kept.
    fn forward(&mut self, batch: &Sequences<'_>) -> Vec<f32>;

    /// The gradient of the parameters, written to `gradient`, from that of the outputs of the last
    /// forward pass.
    fn backward(&mut self, batch: &Sequences<'_>, output_gradient: &[f32], gradient: &mut [f32]);
}
