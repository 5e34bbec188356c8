//! The networks of a policy side by side, seen as one: one output row, one flat parameter vector.
//!
//! Long because acting and learning go through the same list of networks, and their columns must match.

use std::ops::Range;

use hasard_envs::ActionSpace;

use crate::config::{NetworkConfig, Reflected, reflections};
use crate::error::LearnError;
#[cfg(feature = "graphics")]
use crate::networks::burn_network::BurnNetwork;
use crate::networks::cpu::network::{CpuActor, CpuLearner};
use crate::networks::critic_heads::CriticHeads;
use crate::networks::device::ComputeDevice;
use crate::networks::distribution::ActionShape;
use crate::networks::in_parts::InParts;
use crate::networks::layers::ImageShape;
use crate::networks::mirror::{MirroredActor, MirroredLearner};
use crate::networks::network::{
    ActingNetwork, LearningNetwork, Place, Published, RecordedLane, Recording, Sequences, states_of,
};
use crate::networks::pixels::PixelScale;
use crate::networks::shape::NetworkShape;
use crate::networks::shared_network::SharedNetwork;
use crate::team::Team;

/// Shape of a policy with its critics. An output row holds the policy's numbers, the value, and the
/// value of each cost, whether one network makes them all or each has its own.
#[derive(Clone, PartialEq, Debug)]
pub struct ModelShape {
    /// The networks.
    pub networks: Vec<NetworkShape>,
    /// The actions.
    pub action: ActionShape,
    /// Number of cost critics.
    pub cost_critics: usize,
    /// Privileged inputs of the critics.
    pub critic_inputs: usize,
    /// Outputs of a last head of the first network that predicts what the picture shows; in no
    /// output row.
    pub auxiliary: usize,
}

impl ModelShape {
    /// The model for an image, actions and a number of cost critics.
    pub fn new(
        image: ImageShape,
        action: ActionShape,
        cost_critics: usize,
        extra_inputs: usize,
        config: &NetworkConfig,
    ) -> Result<ModelShape, LearnError> {
        let network = |heads: Vec<usize>| NetworkShape {
            image,
            convolutions: if config.residual.is_empty() {
                config.convolutions.clone()
            } else {
                vec![]
            },
            residual: config.residual.clone(),
            dense: config.dense.clone(),
            extra_inputs,
            recurrent: config.recurrent,
            cell: config.cell,
            heads,
            mirror: vec![],
        };
        let heads =
            std::iter::once(action.parameters()).chain(std::iter::repeat_n(1, 1 + cost_critics));
        let networks = if config.separate {
            heads.map(|head| network(vec![head])).collect()
        } else {
            vec![network(heads.collect())]
        };
        let shape = ModelShape { networks, action, cost_critics, critic_inputs: 0, auxiliary: 0 };
        shape.networks.iter().try_for_each(NetworkShape::check)?;
        Ok(shape)
    }

    /// The same with critics that see so many privileged inputs.
    pub fn with_critic_inputs(mut self, inputs: usize) -> Result<ModelShape, LearnError> {
        self.critic_inputs = inputs;
        for (index, network) in self.networks.iter_mut().enumerate() {
            network
                .heads
                .iter_mut()
                .skip(usize::from(index == 0))
                .for_each(|head| *head = 1 + inputs);
            network.check()?;
        }
        Ok(self)
    }

    /// The same with a head of so many outputs that predicts what the picture shows.
    pub fn with_auxiliary(mut self, outputs: usize) -> Result<ModelShape, LearnError> {
        if outputs > 0 {
            self.auxiliary = outputs;
            self.networks[0].heads.push(outputs);
            self.networks[0].check()?;
        }
        Ok(self)
    }

    /// The same with networks that see each picture's mirror image too, if that is wanted, given the
    /// buttons behind the actions.
    ///
    /// # Errors
    /// When these are unknown, or have a side without the other.
    pub fn with_mirror(
        mut self,
        wanted: bool,
        space: Option<&ActionSpace>,
    ) -> Result<ModelShape, LearnError> {
        if wanted {
            let unknown = || {
                LearnError::Config(
                    "network.mirror is on, but the buttons of these worlds are unknown; use false"
                        .into(),
                )
            };
            let mut policy = reflections(space.ok_or_else(unknown)?)?;
            for network in &mut self.networks {
                let own = (policy.len()..network.outputs())
                    .map(|column| Reflected { column, opposite: false });
                network.mirror = std::mem::take(&mut policy).into_iter().chain(own).collect();
            }
        }
        Ok(self)
    }

    /// What becomes of a network's outputs.
    fn critic_heads(&self, network: usize) -> CriticHeads {
        let policy = if network == 0 { self.action.parameters() } else { 0 };
        CriticHeads {
            policy,
            outputs: self.networks[network].outputs(),
            inputs: self.critic_inputs,
            auxiliary: if network == 0 { self.auxiliary } else { 0 },
        }
    }

    /// Length of an output row.
    #[must_use]
    pub fn outputs(&self) -> usize {
        self.action.parameters() + 1 + self.cost_critics
    }

    /// Column of the value; those of the cost critics follow.
    #[must_use]
    pub fn value_column(&self) -> usize {
        self.action.parameters()
    }

    /// Number of parameters of all networks.
    #[must_use]
    pub fn parameter_count(&self) -> usize {
        self.networks.iter().map(NetworkShape::parameter_count).sum()
    }

    /// Where a network's parameters lie in the flat vector.
    #[must_use]
    pub fn parameter_range(&self, network: usize) -> Range<usize> {
        let start = self.networks[..network].iter().map(NetworkShape::parameter_count).sum();
        start..start + self.networks[network].parameter_count()
    }

    /// Values of an observation.
    #[must_use]
    pub fn pixels(&self) -> usize {
        self.networks[0].image.size()
    }

    /// Extra inputs of a row.
    #[must_use]
    pub fn extra_inputs(&self) -> usize {
        self.networks[0].extra_inputs
    }

    /// States of a number of lanes, zeroed: one vector a network.
    #[must_use]
    pub fn zero_state(&self, lanes: usize) -> Vec<Vec<f32>> {
        self.networks.iter().map(|network| vec![0.0; lanes * network.state_size()]).collect()
    }
}

/// Copies a network's outputs into their columns of the model's rows.
fn place_columns(rows: &mut [f32], width: usize, first: usize, from: &[f32], count: usize) {
    for (row, values) in rows.chunks_exact_mut(width).zip(from.chunks_exact(count)) {
        row[first..first + count].copy_from_slice(values);
    }
}

/// Where the networks of a model note a step.
#[derive(Debug)]
pub struct Notes<'a> {
    /// One a network, or none at all.
    pub recordings: &'a mut [Recording],
    /// Steps of each recording.
    pub steps: usize,
    /// Lanes of each recording.
    pub all_lanes: usize,
    /// The step.
    pub step: usize,
}

impl Notes<'_> {
    fn place(&mut self, network: usize, lanes: &Range<usize>) -> Option<Place<'_>> {
        let recording = self.recordings.get_mut(network)?;
        Some(Place {
            recording,
            steps: self.steps,
            all_lanes: self.all_lanes,
            step: self.step,
            lanes: lanes.clone(),
        })
    }
}

/// All networks of a model, acting.
pub struct Actor {
    shape: ModelShape,
    networks: Vec<Box<dyn ActingNetwork>>,
    outputs: Vec<f32>,
    version: Option<u64>,
}

impl Actor {
    /// An actor on a device.
    #[must_use]
    pub fn new(shape: &ModelShape, device: &ComputeDevice) -> Actor {
        let plain = |shape: &NetworkShape| -> Box<dyn ActingNetwork> {
            match device {
                ComputeDevice::Processor(kernels) => Box::new(CpuActor::new(*kernels, shape)),
                #[cfg(feature = "graphics")]
                ComputeDevice::Burn(device) => Box::new(BurnNetwork::new(shape, device)),
            }
        };
        let network = |shape: &NetworkShape| -> Box<dyn ActingNetwork> {
            if shape.mirror.is_empty() {
                return plain(shape);
            }
            Box::new(MirroredActor::new(shape, plain(&shape.plain())))
        };
        Actor {
            networks: shape.networks.iter().map(network).collect(),
            shape: shape.clone(),
            outputs: Vec::new(),
            version: None,
        }
    }

    /// Takes over published weights, if they are others than before.
    pub fn load(&mut self, published: &Published) {
        if self.version == Some(published.version) {
            return;
        }
        self.version = Some(published.version);
        for (network, weights) in self.networks.iter_mut().zip(&published.networks) {
            network.load(weights);
        }
    }

    /// Output rows of one step for the lanes `lanes` of `state`, which becomes the state after.
    #[allow(clippy::too_many_arguments, reason = "what a step reads and what it writes")]
    pub fn act(
        &mut self,
        observations: &[u8],
        extra: &[f32],
        privileged: &[f32],
        state: &mut [Vec<f32>],
        lanes: Range<usize>,
        rows: &mut [f32],
        mut notes: Option<Notes<'_>>,
    ) {
        let mut first = 0;
        let networks = self.networks.iter_mut().zip(&self.shape.networks).zip(state).enumerate();
        for (index, ((network, shape), state)) in networks {
            let place = notes.as_mut().and_then(|notes| notes.place(index, &lanes));
            let units = shape.state_size();
            let state = &mut state[lanes.start * units..lanes.end * units];
            let heads = self.shape.critic_heads(index);
            if self.shape.networks.len() == 1 && heads.are_plain() {
                return network.act(observations, extra, state, rows, place);
            }
            self.outputs.resize(lanes.len() * shape.outputs(), 0.0);
            network.act(observations, extra, state, &mut self.outputs, place);
            let count = heads.columns();
            if heads.are_plain() {
                place_columns(rows, self.shape.outputs(), first, &self.outputs, count);
            } else {
                let mut own = vec![0.0; lanes.len() * count];
                heads.combine(&self.outputs, privileged, &mut own);
                place_columns(rows, self.shape.outputs(), first, &own, count);
            }
            first += count;
        }
    }
}

/// Trajectories for all networks of a model.
pub struct ModelSequences<'a> {
    /// Everything but the state and what was recorded, which the networks have apart.
    pub sequences: Sequences<'a>,
    /// State before the first step, one vector a network.
    pub initial_state: Vec<Vec<f32>>,
    /// What was recorded of each lane, one vector a network; empty if nothing was.
    pub recorded: Vec<Vec<RecordedLane<'a>>>,
    /// Privileged inputs of each row.
    pub privileged: Vec<f32>,
}

impl<'a> ModelSequences<'a> {
    /// As one network has them.
    fn of(&mut self, network: usize) -> &Sequences<'a> {
        self.sequences.initial_state.clone_from(&self.initial_state[network]);
        self.sequences.recorded.clear();
        self.sequences.recorded.extend(self.recorded.get(network).into_iter().flatten());
        &self.sequences
    }

    /// The trajectories of some lanes, given which lanes these are of the batch.
    #[must_use]
    pub fn of_lanes(&self, shape: &ModelShape, lanes: &[usize]) -> ModelSequences<'a> {
        let states = |(network, states): (&NetworkShape, &Vec<f32>)| {
            states_of(states, network.state_size(), lanes)
        };
        ModelSequences {
            sequences: self.sequences.of_lanes(shape.extra_inputs(), lanes),
            initial_state: shape.networks.iter().zip(&self.initial_state).map(states).collect(),
            privileged: self
                .sequences
                .rows_of(lanes)
                .flat_map(|row| {
                    &self.privileged[row * shape.critic_inputs..(row + 1) * shape.critic_inputs]
                })
                .copied()
                .collect(),
            recorded: self
                .recorded
                .iter()
                .map(|all| lanes.iter().filter_map(|&lane| all.get(lane).copied()).collect())
                .collect(),
        }
    }
}

/// All networks of a model, learning.
pub struct Stack {
    shape: ModelShape,
    networks: Vec<Box<dyn LearningNetwork>>,
    /// What the last forward pass of the first network predicted, row by row.
    predicted: Vec<f32>,
}

impl Stack {
    /// Networks on a device; on the processor they use `threads` threads.
    #[must_use]
    pub fn new(shape: &ModelShape, device: &ComputeDevice, threads: usize) -> Stack {
        let plain = |shape: &NetworkShape| -> Box<dyn LearningNetwork> {
            match device {
                ComputeDevice::Processor(kernels) => {
                    Box::new(CpuLearner::new(*kernels, shape, threads))
                }
                #[cfg(feature = "graphics")]
                ComputeDevice::Burn(device) => Box::new(BurnNetwork::new(shape, device)),
            }
        };
        let network = |shape: &NetworkShape| -> Box<dyn LearningNetwork> {
            if shape.mirror.is_empty() {
                return plain(shape);
            }
            Box::new(MirroredLearner::new(shape, plain(&shape.plain())))
        };
        Stack {
            networks: shape.networks.iter().map(network).collect(),
            shape: shape.clone(),
            predicted: Vec::new(),
        }
    }

    /// From now on at most so many rows are computed at once.
    #[must_use]
    pub fn in_parts(mut self, most_rows: usize) -> Stack {
        let parts = |own| -> Box<dyn LearningNetwork> { Box::new(InParts::new(own, most_rows)) };
        self.networks = std::mem::take(&mut self.networks).into_iter().map(parts).collect();
        self
    }

    /// From now on each worker of the team computes the lanes whose pixels it has.
    pub fn share(&mut self, team: &Team) {
        let shared =
            |own| -> Box<dyn LearningNetwork> { Box::new(SharedNetwork::new(own, team.clone())) };
        self.networks = std::mem::take(&mut self.networks).into_iter().map(shared).collect();
    }

    /// Takes over weights of one network.
    pub fn load_network(&mut self, network: usize, parameters: &[f32]) {
        self.networks[network].load(parameters);
    }

    /// Takes over how pixels enter.
    pub fn load_pixels(&mut self, pixels: &PixelScale) {
        self.networks.iter_mut().for_each(|network| network.load_pixels(pixels));
    }

    /// The weights for acting.
    #[must_use]
    pub fn publish(&self, version: u64) -> Published {
        Published {
            version,
            networks: self.networks.iter().map(|network| network.publish()).collect(),
        }
    }

    /// Output rows; the columns of networks outside the range are zero.
    pub fn forward(&mut self, networks: Range<usize>, batch: &mut ModelSequences<'_>) -> Vec<f32> {
        let width = self.shape.outputs();
        let mut rows = vec![0.0; batch.sequences.rows() * width];
        let mut first = 0;
        for index in 0..self.networks.len() {
            let heads = self.shape.critic_heads(index);
            let count = heads.columns();
            if networks.contains(&index) {
                let mut outputs = self.forward_network(index, batch);
                if heads.auxiliary > 0 {
                    self.predicted = heads.predicted(&outputs);
                }
                if !heads.are_plain() {
                    let mut own = vec![0.0; batch.sequences.rows() * count];
                    heads.combine(&outputs, &batch.privileged, &mut own);
                    outputs = own;
                }
                if count == width {
                    return outputs;
                }
                place_columns(&mut rows, width, first, &outputs, count);
            }
            first += count;
        }
        rows
    }

    /// What the last forward pass predicted of what pictures show, row by row.
    #[must_use]
    pub fn predicted(&self) -> &[f32] {
        &self.predicted
    }

    /// Output rows of one network alone.
    pub fn forward_network(&mut self, network: usize, batch: &mut ModelSequences<'_>) -> Vec<f32> {
        self.networks[network].forward(batch.of(network))
    }

    /// The gradient of the parameters of some networks from that of the output rows of the last
    /// forward pass, and of what it predicted (nothing stands for zeros); what `gradient` holds of
    /// the others is left as it is.
    pub fn backward(
        &mut self,
        networks: Range<usize>,
        batch: &mut ModelSequences<'_>,
        rows: &[f32],
        predicted: &[f32],
        gradient: &mut [f32],
    ) {
        let width = self.shape.outputs();
        let mut first = 0;
        for index in 0..self.networks.len() {
            let heads = self.shape.critic_heads(index);
            let count = heads.columns();
            if networks.contains(&index) {
                let mut own: Vec<f32> = rows
                    .chunks_exact(width)
                    .flat_map(|row| &row[first..first + count])
                    .copied()
                    .collect();
                if !heads.are_plain() {
                    own = heads.spread(&own, &batch.privileged, predicted);
                }
                self.backward_network(
                    index,
                    batch,
                    &own,
                    &mut gradient[self.shape.parameter_range(index)],
                );
            }
            first += count;
        }
    }

    /// The gradient of one network's parameters.
    pub fn backward_network(
        &mut self,
        network: usize,
        batch: &mut ModelSequences<'_>,
        rows: &[f32],
        gradient: &mut [f32],
    ) {
        self.networks[network].backward(batch.of(network), rows, gradient);
    }
}
