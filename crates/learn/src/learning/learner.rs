//! The learner: networks, optimiser and running statistics, and what an algorithm does with them.

use std::ops::Range;

use crate::config::{Optimiser, TrainConfig};
use crate::error::LearnError;
use crate::learning::gather::gather;
use crate::learning::loss::{Heads, Loss};
use crate::learning::metrics::Means;
pub use crate::learning::minibatch::{Critic, Minibatch};
use crate::learning::muon::Block;
use crate::learning::normaliser::{Moments, PixelNormaliser, PixelSums};
use crate::learning::optimiser::Adam;
use crate::learning::policy::Policy;
use crate::learning::popart::preserve_outputs;
pub use crate::learning::targets::Prepared;
use crate::learning::targets::prepare;
use crate::networks::cpu::vectors::Vectors;
use crate::networks::device::ComputeDevice;
use crate::networks::{ModelShape, Published, Stack};
use crate::sampling::auxiliary::Auxiliary;
use crate::sampling::rollout::Rollout;
use crate::team::Team;
use hasard_engine::simd::Simd;

/// Rows that a network of a learner of long rollouts computes at once: it bounds the memory of
/// activations, some 50 kB a row of the smallest network of the presets and 110 kB of the largest.
const MOST_ROWS: usize = 2048;

/// The same for every learner on a card, whose buffers have a greatest size: pixels of so many
/// pictures of 160x120 are 1.9 GB, as 32-bit numbers.
const MOST_ROWS_ON_A_CARD: usize = 8192;

/// Networks, optimisers and running statistics.
pub struct Learner {
    shape: ModelShape,
    networks: Stack,
    /// Flat parameters of all networks.
    pub parameters: Vec<f32>,
    /// One optimiser a network; for algorithms of two steps, those of the second after those of the
    /// first.
    pub optimisers: Vec<Adam>,
    /// Statistics of pixels.
    pub pixels: PixelNormaliser,
    /// Statistics of each critic's returns.
    pub returns: Vec<Moments>,
    /// Updates so far.
    pub version: u64,
    /// Learning rate of the next update.
    pub rate: f64,
    /// Weight of the exploration loss of the next update.
    pub exploration_coefficient: f64,
    /// Settings.
    pub config: TrainConfig,
    /// What the network predicts beside.
    auxiliary: Auxiliary,
    /// What computes everything but the networks on a card.
    kernels: Simd,
    /// The policy network in float32 where products are rounded, for [`Learner::fisher_outputs`].
    fisher: Option<Stack>,
    gradient: Vec<f32>,
    /// Which networks do not hold the present parameters.
    stale: Vec<bool>,
    /// Nor the present statistics of pixels.
    stale_pixels: bool,
    /// The workers that learn together.
    team: Team,
}

impl Learner {
    /// A learner with fresh weights.
    pub fn new(config: &TrainConfig, shape: &ModelShape, device: &ComputeDevice) -> Learner {
        let scheme = config.network.initialisation;
        let mut parameters: Vec<f32> = shape
            .networks
            .iter()
            .enumerate()
            .flat_map(|(index, network)| {
                network.initial_parameters(scheme, config.seed, index as u64)
            })
            .collect();
        // The policy is the first head of the first network, at the front of the vector.
        shape.networks[0].scale_head(0, config.network.policy_scale as f32, &mut parameters);
        let passes = shape.networks[0].passes();
        let stack = |shape: &ModelShape, device: &ComputeDevice| {
            let whole = Stack::new(shape, device, config.learning.threads);
            match (config.learning.recurrence, device.is_card()) {
                (Some(_), _) => whole.in_parts(MOST_ROWS / passes),
                (None, true) => whole.in_parts(MOST_ROWS_ON_A_CARD / passes),
                (None, false) => whole,
            }
        };
        Learner {
            networks: stack(shape, device),
            fisher: device.unrounded().filter(|_| config.algorithm.is_second_order()).map(
                |unrounded| {
                    let policy = vec![shape.networks[0].clone()];
                    stack(&ModelShape { networks: policy, ..shape.clone() }, &unrounded)
                },
            ),
            optimisers: std::iter::repeat_n(&shape.networks, config.algorithm.optimisers())
                .flatten()
                .map(|network| {
                    let blocks = match config.learning.optimiser {
                        Optimiser::Adam => vec![],
                        Optimiser::Muon => Block::all(network),
                    };
                    Adam::new(network.parameter_count(), blocks)
                })
                .collect(),
            pixels: PixelNormaliser::new(shape.pixels()),
            returns: vec![Moments::default(); 1 + shape.cost_critics],
            version: 0,
            rate: config.learning.rate,
            exploration_coefficient: config.learning.exploration_coefficient,
            config: config.clone(),
            auxiliary: Auxiliary::new(config),
            kernels: device.kernels(),
            gradient: vec![0.0; parameters.len()],
            parameters,
            shape: shape.clone(),
            stale: vec![true; shape.networks.len()],
            stale_pixels: true,
            team: Team::default(),
        }
    }

    /// From now on it learns with the other workers of its run, from rollouts of which each has the
    /// pixels of its own lanes.
    pub fn join(&mut self, team: &Team) {
        if !team.is_alone() {
            self.networks.share(team);
            if let Some(fisher) = &mut self.fisher {
                fisher.share(team);
            }
            self.team = team.clone();
        }
    }

    /// The model's shape.
    #[must_use]
    pub fn shape(&self) -> &ModelShape {
        &self.shape
    }

    /// The kernels of the processor that compute it, or what comes before and after a card does.
    #[must_use]
    pub fn kernels(&self) -> Simd {
        self.kernels
    }

    /// What computes with vectors as long as a network.
    #[must_use]
    pub fn vectors(&self) -> Vectors {
        Vectors { kernels: self.kernels, threads: self.config.learning.threads }
    }

    /// The present weights for samplers.
    pub fn publish(&mut self) -> Published {
        self.refresh();
        self.networks.publish(self.version)
    }

    /// Takes over the statistics of a rollout's pixels: before it is learned from, as in the
    /// original, or after, where the first forward pass is to be the actors' own
    /// ([`LearningConfig::reuse_forward`](crate::config::LearningConfig)).
    pub fn absorb(&mut self, rollout: &Rollout) -> Result<(), LearnError> {
        let mut sums = PixelSums::of(
            self.kernels,
            &rollout.frames(),
            self.shape.pixels(),
            self.config.learning.threads,
        );
        self.team.sum_whole(&mut sums.0)?;
        self.pixels.merge(&sums);
        self.stale_pixels = true;
        Ok(())
    }

    /// Computes a rollout's advantages and targets, and takes over the statistics of its returns.
    pub fn prepare<'a>(&mut self, rollout: &'a Rollout) -> Prepared<'a> {
        let (prepared, moved) = prepare(rollout, &self.shape, &self.config, &mut self.returns);
        for (critic, before, after) in moved {
            let network =
                preserve_outputs(&self.shape, critic, &before, &after, &mut self.parameters);
            self.stale[network] = true;
        }
        prepared
    }

    /// Some trajectories.
    #[must_use]
    pub fn minibatch<'a>(&self, prepared: &Prepared<'a>, trajectories: &[usize]) -> Minibatch<'a> {
        let mut minibatch = gather(prepared, &self.shape, &self.config, trajectories);
        minibatch.exploration_coefficient = self.exploration_coefficient;
        minibatch
    }

    fn refresh(&mut self) {
        for (network, stale) in self.stale.iter_mut().enumerate().filter(|(_, stale)| **stale) {
            self.networks
                .load_network(network, &self.parameters[self.shape.parameter_range(network)]);
            *stale = false;
        }
        self.refresh_pixels();
    }

    fn refresh_pixels(&mut self) {
        if self.stale_pixels {
            let scale = self.pixels.scale();
            for stack in std::iter::once(&mut self.networks).chain(&mut self.fisher) {
                stack.load_pixels(&scale);
            }
            self.stale_pixels = false;
        }
    }

    /// The gradient of a loss in the parameters of some networks. The loss must not depend on the
    /// columns of the others.
    pub fn gradient(
        &mut self,
        networks: Range<usize>,
        minibatch: &mut Minibatch<'_>,
        loss: impl FnOnce(&Heads, &Minibatch<'_>, &mut Means) -> Loss,
        means: &mut Means,
    ) -> Result<Vec<f32>, LearnError> {
        self.refresh();
        let outputs = self.networks.forward(networks.clone(), &mut minibatch.batch);
        let heads = Heads::new(&self.shape, &outputs, self.shape.outputs(), minibatch);
        let loss = loss(&heads, minibatch, means);
        // The worlds of an agent's learner show nothing, and its network predicts nothing.
        let (value, predicted) = if self.shape.auxiliary > 0 && networks.contains(&0) {
            self.auxiliary.loss(self.networks.predicted(), &minibatch.shown, means)
        } else {
            (0.0, Vec::new())
        };
        let value = loss.value + value;
        means.add("loss", value);
        if !value.is_finite() {
            return Err(diverged("loss", value));
        }
        let (rows, mut gradient) = (loss.rows(), std::mem::take(&mut self.gradient));
        self.networks.backward(networks, &mut minibatch.batch, &rows, &predicted, &mut gradient);
        Ok(gradient)
    }

    /// One step of Adam down a gradient, for some of the networks; its norm is cut down to the
    /// largest allowed. `set` counts the optimisers of algorithms of two steps.
    fn step(
        &mut self,
        set: usize,
        gradient: Vec<f32>,
        networks: Range<usize>,
        means: &mut Means,
    ) -> Result<(), LearnError> {
        let start = self.shape.parameter_range(networks.start).start;
        let end = self.shape.parameter_range(networks.end - 1).end;
        let norm =
            crate::networks::cpu::elementwise::sum_of_squares(self.kernels, &gradient[start..end])
                .sqrt();
        means.add("gradient_norm", norm);
        if !norm.is_finite() {
            return Err(diverged("gradient's norm", norm));
        }
        let settings = &self.config.learning;
        let largest = settings.max_gradient_norm;
        let scale = if largest > 0.0 { (largest / norm.max(1e-12)).min(1.0) } else { 1.0 };
        let count = self.shape.networks.len();
        for network in networks {
            self.stale[network] = true;
            let range = self.shape.parameter_range(network);
            let parameters = &mut self.parameters[range.clone()];
            let rate = match settings.critic_rate {
                Some(rate) if network > 0 => {
                    rate * self.rate / settings.rate.max(f64::MIN_POSITIVE)
                }
                _ => self.rate,
            };
            self.optimisers[set * count + network].step(
                self.kernels,
                &gradient[range],
                parameters,
                scale,
                rate,
                settings,
            );
        }
        self.gradient = gradient;
        self.version += 1;
        Ok(())
    }

    /// Gradient and step in one, for algorithms of the first order.
    pub fn descend(
        &mut self,
        minibatch: &mut Minibatch<'_>,
        loss: impl FnOnce(&Heads, &Minibatch<'_>, &mut Means) -> Loss,
        means: &mut Means,
    ) -> Result<(), LearnError> {
        self.descend_networks(0..self.shape.networks.len(), 0, minibatch, loss, means)
    }

    /// As [`Learner::descend`] for some of the networks, with one of the sets of optimisers.
    pub fn descend_networks(
        &mut self,
        networks: Range<usize>,
        set: usize,
        minibatch: &mut Minibatch<'_>,
        loss: impl FnOnce(&Heads, &Minibatch<'_>, &mut Means) -> Loss,
        means: &mut Means,
    ) -> Result<(), LearnError> {
        let gradient = self.gradient(networks.clone(), minibatch, loss, means)?;
        self.step(set, gradient, networks, means)
    }

    /// The policy at present, as it sees a minibatch.
    pub fn policy(&mut self, minibatch: &mut Minibatch<'_>) -> Policy {
        self.refresh();
        let width = self.shape.outputs();
        let outputs = self.networks.forward(0..1, &mut minibatch.batch);
        Policy::new(&self.shape.action, &outputs, width)
    }

    /// Mean divergence, over all of a rollout, of the policy at present from another, or else from
    /// the one that acted.
    pub fn divergence(&mut self, rollout: &Prepared<'_>, from: Option<&Policy>) -> f64 {
        let all: Vec<usize> = (0..rollout.rollout.trajectories()).collect();
        let mut minibatch = self.minibatch(rollout, &all);
        let present = self.policy(&mut minibatch);
        from.unwrap_or(&minibatch.old_policy).divergence(&present).mean()
    }

    /// The policy network's parameters. Only for models of separate networks, as all that follows.
    #[must_use]
    pub fn policy_parameters(&self) -> Vec<f32> {
        self.parameters[self.shape.parameter_range(0)].to_vec()
    }

    /// Takes over weights and normalisers of another learner of the same shape, and its count of
    /// updates.
    pub fn inherit(&mut self, other: &Learner) -> Result<(), LearnError> {
        let sizes = |learner: &Learner| {
            (learner.parameters.len(), learner.pixels.mean.len(), learner.returns.len())
        };
        if sizes(self) != sizes(other) {
            let problem = "the lessons of a curriculum must be alike in what is seen and done; these levels are not";
            return Err(LearnError::Config(problem.into()));
        }
        self.parameters.clone_from(&other.parameters);
        self.pixels = other.pixels.clone();
        self.returns.clone_from(&other.returns);
        self.version = other.version;
        self.replaced();
        Ok(())
    }

    /// Goes on with statistics of returns, if there are some for each critic.
    pub fn begin_with(&mut self, returns: &[Moments]) {
        if returns.len() == self.returns.len() {
            self.returns.copy_from_slice(returns);
        }
    }

    /// Notes that parameters or statistics were replaced from outside.
    pub fn replaced(&mut self) {
        self.stale.fill(true);
        self.stale_pixels = true;
    }
}

fn diverged(what: &str, value: f64) -> LearnError {
    LearnError::Diverged(format!(
        "the {what} became {value}: training has diverged; resume from the last checkpoint with a lower learning rate"
    ))
}

mod anew;
mod second_order;
#[cfg(test)]
mod tests;
