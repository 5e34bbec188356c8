//! The learner: networks, optimiser and running statistics, and what an algorithm does with them.

use std::ops::Range;

use crate::config::{ReturnNormaliser, TrainConfig};
use crate::error::LearnError;
use crate::learning::advantage::{Lane, generalised_advantages};
use crate::learning::loss::{Heads, Loss};
use crate::learning::metrics::Means;
pub use crate::learning::minibatch::{Critic, Minibatch};
use crate::learning::normaliser::{CLIP, Moments, PixelNormaliser, PixelSums};
use crate::learning::optimiser::Adam;
use crate::learning::policy::{Policy, Taken};
use crate::learning::popart::preserve_outputs;
use crate::networks::cpu::vectors::Vectors;
use crate::networks::device::ComputeDevice;
use crate::networks::{ModelSequences, ModelShape, Published, RecordedLane, Sequences, Stack};
use crate::sampling::rollout::Rollout;
use crate::team::Team;
use hasard_engine::simd::Simd;

/// Rows that a network of a learner of long rollouts computes at once: it bounds the memory of
/// activations, some 50 kB a row of the smallest network of the presets and 110 kB of the largest.
const MOST_ROWS: usize = 2048;

/// A rollout with advantages and targets. Critic 0 is that of the reward, the others are those of
/// the costs; values of lane `l` at step `t` are at `l * steps + t`.
pub struct Prepared<'a> {
    /// The rollout.
    pub rollout: &'a Rollout,
    /// Advantages of each critic, in raw units.
    pub advantages: Vec<Vec<f32>>,
    /// Normalised returns of each critic.
    pub targets: Vec<Vec<f32>>,
    /// Normalised values of each critic when the actions were taken.
    pub old_values: Vec<Vec<f32>>,
    /// Mean cost of each constraint per step.
    pub mean_costs: Vec<f64>,
}

impl Prepared<'_> {
    /// Share of the variance of each critic's targets that its values explain: 1 is perfect, 0 no
    /// better than their mean.
    #[must_use]
    pub fn explained_variances(&self, config: &TrainConfig) -> Vec<(String, f64)> {
        let variance = |values: &mut dyn Iterator<Item = f64>| {
            let (count, sum, squares) =
                values.fold((0.0, 0.0, 0.0), |(n, s, q), v| (n + 1.0, s + v, q + v * v));
            squares / count - (sum / count) * (sum / count)
        };
        let share = |(critic, (targets, values)): (usize, (&Vec<f32>, &Vec<f32>))| {
            let all = variance(&mut targets.iter().map(|&target| f64::from(target)));
            let rest = variance(
                &mut targets.iter().zip(values).map(|(target, value)| f64::from(target - value)),
            );
            (critic_name("explained_variance", config, critic), 1.0 - rest / all)
        };
        self.targets.iter().zip(&self.old_values).enumerate().map(share).collect()
    }
}

/// What a number of a critic is called in reports: that of a cost says so, that of a named cost
/// says which.
fn critic_name(what: &str, config: &TrainConfig, critic: usize) -> String {
    match critic.checked_sub(1).map(|index| &config.constraints[index].term) {
        None => what.into(),
        Some(None) => format!("cost_{what}"),
        Some(Some(term)) => format!("cost_{what}/{term}"),
    }
}

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
    /// What computes everything but the networks on a card.
    kernels: Simd,
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
        let parameters: Vec<f32> = shape
            .networks
            .iter()
            .enumerate()
            .flat_map(|(index, network)| {
                network.initial_parameters(scheme, config.seed, index as u64)
            })
            .collect();
        Learner {
            networks: match config.learning.recurrence {
                None => Stack::new(shape, device, config.learning.threads),
                Some(_) => Stack::new(shape, device, config.learning.threads).in_parts(MOST_ROWS),
            },
            optimisers: std::iter::repeat_n(&shape.networks, config.algorithm.optimisers())
                .flatten()
                .map(|network| Adam::new(network.parameter_count()))
                .collect(),
            pixels: PixelNormaliser::new(shape.pixels()),
            returns: vec![Moments::default(); 1 + shape.cost_critics],
            version: 0,
            rate: config.learning.rate,
            exploration_coefficient: config.learning.exploration_coefficient,
            config: config.clone(),
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
        let (steps, lanes) = (rollout.steps(), rollout.lanes());
        let (width, first) = (self.shape.outputs(), self.shape.value_column());
        let constraints = self.config.constraints.len();
        let settings = &self.config.learning;
        let mut prepared = Prepared {
            rollout,
            advantages: Vec::new(),
            targets: Vec::new(),
            old_values: Vec::new(),
            mean_costs: vec![0.0; constraints],
        };
        let popart = settings.normaliser == ReturnNormaliser::PopArt;
        let shared = settings.cost_uses_reward_normaliser;
        let mut moved = Vec::new();
        for critic in 0..self.returns.len() {
            let moments = &mut self.returns[if shared { 0 } else { critic }];
            let raw = |moments: &Moments, value: f32| match () {
                () if shared && critic > 0 => value.clamp(-CLIP, CLIP),
                () if popart => moments.scale_up(value),
                () => moments.denormalise(value),
            };
            let mut advantages = vec![0.0; steps * lanes];
            let mut returns = vec![0.0; steps * lanes];
            let mut old_values = vec![0.0; steps * lanes];
            for lane in 0..lanes {
                let (part, own) = rollout.find(lane);
                let row = |step: usize| step * part.lanes + own;
                let normalised: Vec<f32> = (0..=steps)
                    .map(|step| part.outputs[row(step) * width + first + critic])
                    .collect();
                let values: Vec<f32> =
                    normalised.iter().map(|&value| raw(moments, value)).collect();
                let rewards: Vec<f32> = (0..steps)
                    .map(|step| match critic {
                        0 => part.rewards[row(step)],
                        cost => part.costs[row(step) * constraints + cost - 1],
                    })
                    .collect();
                let done: Vec<bool> = (0..steps).map(|step| part.done[row(step)]).collect();
                let mut cut_off_values = vec![0.0; steps];
                if settings.bootstraps(critic > 0) {
                    for (cut, outputs) in
                        part.cut_off.iter().filter(|(cut, _)| cut % part.lanes == own)
                    {
                        cut_off_values[cut / part.lanes] = raw(moments, outputs[first + critic]);
                    }
                }
                let out = &mut advantages[lane * steps..(lane + 1) * steps];
                let lane_values = Lane {
                    rewards: &rewards,
                    done: &done,
                    cut_off_values: &cut_off_values,
                    values: &values,
                };
                let gamma = if critic == 0 {
                    settings.gamma
                } else {
                    settings.cost_gamma.unwrap_or(settings.gamma)
                };
                generalised_advantages(lane_values, gamma as f32, settings.gae_lambda as f32, out);
                for step in 0..steps {
                    returns[lane * steps + step] = out[step] + values[step];
                    old_values[lane * steps + step] = normalised[step];
                }
            }
            if popart {
                let before = *moments;
                moments.update_forgetting(&returns, settings.normaliser_horizon);
                old_values
                    .iter_mut()
                    .for_each(|value| *value = moments.scale_down(before.scale_up(*value)));
                prepared
                    .targets
                    .push(returns.iter().map(|&value| moments.scale_down(value)).collect());
                moved.push((critic, before, *moments));
            } else {
                moments.update(&returns);
                prepared
                    .targets
                    .push(returns.iter().map(|&value| moments.normalise(value)).collect());
            }
            prepared.advantages.push(advantages);
            prepared.old_values.push(old_values);
        }
        for (critic, before, after) in moved {
            let network =
                preserve_outputs(&self.shape, critic, &before, &after, &mut self.parameters);
            self.stale[network] = true;
        }
        let all: Vec<usize> = (0..rollout.trajectories()).collect();
        prepared.mean_costs = mean_costs(rollout, &all, constraints);
        prepared
    }

    /// Some trajectories.
    #[must_use]
    pub fn minibatch<'a>(&self, prepared: &Prepared<'a>, trajectories: &[usize]) -> Minibatch<'a> {
        let rollout = prepared.rollout;
        let steps = rollout.trajectory_steps();
        let places: Vec<(usize, usize)> =
            trajectories.iter().map(|&number| rollout.trajectory(number)).collect();
        // Each row's step of its trajectory, its step of the rollout, and its lane.
        let rows = || {
            (0..steps).flat_map(|step| {
                places.iter().map(move |&(lane, first)| (step, first + step, lane))
            })
        };
        let shape = &self.shape;
        let (width, action, extra) = (shape.outputs(), &shape.action, shape.extra_inputs());
        let mut sequences = Sequences {
            steps,
            lanes: places.len(),
            observations: Vec::with_capacity(steps * places.len()),
            extra: Vec::new(),
            initial_state: Vec::new(),
            reset: Vec::with_capacity(steps * places.len()),
            recorded: Vec::new(),
        };
        let (seen, mut privileged) = (shape.critic_inputs, Vec::new());
        let (mut actions, mut deltas, mut logs, mut policy) =
            (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        for (own_step, step, lane) in rows() {
            let (part, own) = rollout.find(lane);
            let row = step * part.lanes + own;
            sequences.observations.push(part.frame(step, own));
            sequences.extra.extend_from_slice(&part.extra[row * extra..(row + 1) * extra]);
            privileged.extend_from_slice(&part.privileged[row * seen..(row + 1) * seen]);
            sequences.reset.push(own_step > 0 && part.done[row - part.lanes]);
            let (count, continuous) = (action.sizes.len(), action.deltas);
            actions.extend_from_slice(&part.actions[row * count..(row + 1) * count]);
            deltas.extend_from_slice(&part.deltas[row * continuous..(row + 1) * continuous]);
            logs.push(f64::from(part.log_probabilities[row]));
            policy.extend_from_slice(&part.outputs[row * width..row * width + action.parameters()]);
        }
        let state = |network: usize| -> Vec<f32> {
            let units = shape.networks[network].state_size();
            trajectories
                .iter()
                .flat_map(|&number| rollout.initial_state(network, units, number))
                .copied()
                .collect()
        };
        let initial_state = (0..shape.networks.len()).map(state).collect();
        let recorded = |network: usize| -> Vec<RecordedLane<'a>> {
            let of = |&(lane, _): &(usize, usize)| {
                let (part, own) = rollout.find(lane);
                Some(RecordedLane { recording: part.recordings.get(network)?, lane: own })
            };
            places.iter().filter_map(of).collect()
        };
        let recorded = (0..shape.networks.len()).map(recorded).collect();
        let length = rollout.steps();
        let pick = |values: &[f32]| -> Vec<f32> {
            rows().map(|(_, step, lane)| values[lane * length + step]).collect()
        };
        let critic = |index: usize| Critic {
            loss_name: critic_name("value_loss", &self.config, index),
            advantages: pick(&prepared.advantages[index]),
            old_values: pick(&prepared.old_values[index]),
            targets: pick(&prepared.targets[index]),
        };
        Minibatch {
            batch: ModelSequences { sequences, initial_state, recorded, privileged },
            taken: Taken { actions, deltas },
            old_log_probability: logs,
            old_policy: Policy::new(action, &policy, action.parameters()),
            critics: (0..self.returns.len()).map(critic).collect(),
            mean_costs: mean_costs(rollout, trajectories, self.config.constraints.len()),
            exploration_coefficient: self.exploration_coefficient,
        }
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
            self.networks.load_pixels(&self.pixels.scale());
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
        means.add("loss", loss.value);
        if !loss.value.is_finite() {
            return Err(diverged("loss", loss.value));
        }
        let mut gradient = std::mem::take(&mut self.gradient);
        self.networks.backward(networks, &mut minibatch.batch, &loss.rows(), &mut gradient);
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

    /// The policy network's outputs under its present parameters: where actors recorded them, they
    /// are not computed anew.
    pub fn present_outputs(&mut self, batch: &mut ModelSequences<'_>) -> Vec<f32> {
        self.refresh();
        self.networks.forward_network(0, batch)
    }

    /// Policy outputs under other parameters of the policy network.
    pub fn policy_outputs(
        &mut self,
        batch: &mut ModelSequences<'_>,
        parameters: &[f32],
    ) -> Vec<f32> {
        self.refresh_pixels();
        self.stale[0] = true;
        self.networks.load_network(0, parameters);
        self.networks.forward_network(0, batch)
    }

    /// The policy that some outputs of its network are, as heads without values.
    #[must_use]
    pub fn policy_heads(&self, minibatch: &Minibatch<'_>, outputs: &[f32]) -> Heads {
        Heads::new(&self.shape, outputs, self.shape.action.parameters(), minibatch)
    }

    /// The gradient in the policy network's parameters from that of its outputs of the last forward
    /// pass.
    pub fn policy_backward(
        &mut self,
        batch: &mut ModelSequences<'_>,
        rows: &[f32],
        gradient: &mut [f32],
    ) {
        self.networks.backward_network(0, batch, rows, gradient);
    }

    /// Replaces the policy network's parameters.
    pub fn set_policy_parameters(&mut self, parameters: &[f32]) {
        let range = self.shape.parameter_range(0);
        self.parameters[range].copy_from_slice(parameters);
        self.stale[0] = true;
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

    /// Tells the learner that parameters or statistics were replaced from outside.
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

/// Mean cost of each constraint over the steps of some trajectories.
fn mean_costs(rollout: &Rollout, trajectories: &[usize], constraints: usize) -> Vec<f64> {
    let mut sums = vec![0.0; constraints];
    let steps = rollout.trajectory_steps();
    for (lane, first) in trajectories.iter().map(|&number| rollout.trajectory(number)) {
        let (part, own) = rollout.find(lane);
        for step in first..first + steps {
            let row = (step * part.lanes + own) * constraints;
            for (sum, &cost) in sums.iter_mut().zip(&part.costs[row..row + constraints]) {
                *sum += f64::from(cost);
            }
        }
    }
    let count = (trajectories.len() * steps) as f64;
    sums.iter().map(|sum| sum / count).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algorithms::small;
    use crate::config::AlgorithmKind;

    /// As the code of PPOLag's tables had it: values of costs as the network says them, within +-5;
    /// their returns normalised by the moments of the reward's returns, which have taken both in;
    /// moments of their own never moved. Returns by the recursion of GAE (Schulman et al. 2016),
    /// here with gamma and lambda 1, where they are plain sums up to the value after the last step.
    #[test]
    fn costs_may_use_the_rewards_normaliser() {
        let mut config = small::config(AlgorithmKind::PpoLag);
        (config.learning.gamma, config.learning.gae_lambda) = (1.0, 1.0);
        let make = |shared: bool| {
            let mut config = config.clone();
            config.learning.cost_uses_reward_normaliser = shared;
            let (mut learner, rollout) = small::learner(&config);
            learner.returns[0] = Moments { count: 50.0, mean: 2.0, variance: 9.0 };
            let prepared = learner.prepare(&rollout);
            let (targets, moments) = (prepared.targets.clone(), learner.returns.clone());
            let part = &rollout.parts[0];
            let width = part.outputs.len() / ((small::STEPS + 1) * small::LANES);
            let mut sums = Vec::new();
            for lane in 0..small::LANES {
                for step in 0..small::STEPS {
                    let costs: f32 = (step..small::STEPS)
                        .map(|later| part.costs[later * small::LANES + lane])
                        .sum();
                    let last =
                        part.outputs[(small::STEPS * small::LANES + lane) * width + width - 1];
                    sums.push(costs + last.clamp(-5.0, 5.0));
                }
            }
            (targets, moments, sums)
        };
        let (targets, moments, sums) = make(true);
        let (_, plain, _) = make(false);
        let mut both = plain[0];
        both.update(&sums);
        assert!(
            (moments[0].mean - both.mean).abs() < 1e-5
                && (moments[0].variance - both.variance).abs() < 1e-5
        );
        assert_eq!((moments[0].count, moments[1]), (both.count, Moments::default()));
        assert_ne!(plain[1], Moments::default());
        for (target, sum) in targets[1].iter().zip(&sums) {
            assert!(
                (target - both.normalise(*sum)).abs() < 1e-5,
                "{target} against {}",
                both.normalise(*sum)
            );
        }
    }
}
