//! Steps of the second order: the natural gradient and a line search within a trust region.
//!
//! The Fisher matrix F of the policy network is never built. Its product with a vector is J' M J v,
//! where J is the network's Jacobian and M the Fisher matrix of the action distribution in its own
//! numbers, known in closed form. J v is the difference of the outputs a little way along v from
//! those at the origin, and J' the backward pass there: one pass of each kind a product, of a share
//! of the trajectories. A test holds the product against a dense Fisher matrix.

use crate::algorithms::surrogate::note_policy;
use crate::config::TrainConfig;
use crate::error::LearnError;
use crate::learning::learner::{Learner, Minibatch};
use crate::learning::loss::{Heads, Loss};
use crate::learning::metrics::Means;
use crate::learning::policy::Policy;
use crate::networks::ModelSequences;
use crate::random::{Purpose, Stream};

/// Norm of the step of the difference: far above rounding, far below the curvature of the network.
const DIFFERENCE: f64 = 1e-2;

/// Settings of second-order steps.
#[derive(Clone, Debug)]
pub struct TrustRegion {
    /// Bound of the mean divergence.
    pub radius: f64,
    iterations: usize,
    fraction: f64,
    damping: f64,
    search_steps: usize,
    search_factor: f64,
}

/// Where a step starts from: the policy network's parameters and what they say about a minibatch.
pub struct Origin<'a> {
    /// Parameters.
    pub parameters: Vec<f32>,
    /// The policy.
    pub heads: Heads,
    /// The trajectories that the Fisher matrix is taken over.
    sample: ModelSequences<'a>,
    /// The policy on them, and its outputs.
    sample_policy: Policy,
    sample_outputs: Vec<f32>,
}

/// A direction x that solves F x = b, and F x as far as it was solved.
pub struct Solution {
    /// x.
    pub direction: Vec<f32>,
    /// F x.
    pub product: Vec<f32>,
}

impl TrustRegion {
    /// The settings of a run.
    #[must_use]
    pub fn new(config: &TrainConfig) -> TrustRegion {
        let settings = &config.algorithm_settings;
        TrustRegion {
            radius: settings.trust_radius,
            iterations: settings.conjugate_iterations,
            fraction: settings.fisher_fraction,
            damping: settings.fisher_damping,
            search_steps: settings.line_search_steps,
            search_factor: settings.line_search_factor,
        }
    }

    /// Where steps on a minibatch start from.
    #[must_use]
    pub fn origin<'a>(&self, learner: &mut Learner, minibatch: &mut Minibatch<'a>) -> Origin<'a> {
        let parameters = learner.policy_parameters();
        let lanes = minibatch.batch.sequences.lanes;
        let count = ((lanes as f64 * self.fraction).round() as usize).clamp(1, lanes);
        // Spread over all lanes and episodes.
        let sampled: Vec<usize> = (0..count).map(|index| index * lanes / count).collect();
        let mut sample = minibatch.batch.of_lanes(learner.shape(), &sampled);
        let sample_outputs = learner.fisher_origin(&mut sample);
        let action = &learner.shape().action;
        let sample_policy = Policy::new(action, &sample_outputs, action.parameters());
        let outputs = learner.present_outputs(&mut minibatch.batch);
        Origin {
            heads: learner.policy_heads(minibatch, &outputs),
            parameters,
            sample,
            sample_policy,
            sample_outputs,
        }
    }

    /// Gradient, in the policy network's parameters, of a loss of the policy at the origin. It must
    /// come right after the origin itself or another forward pass there.
    pub fn gradient(
        &self,
        learner: &mut Learner,
        minibatch: &mut Minibatch<'_>,
        loss: &Loss,
    ) -> Vec<f32> {
        let mut gradient = vec![0.0; learner.shape().parameter_range(0).len()];
        learner.policy_backward(&mut minibatch.batch, &loss.rows(), &mut gradient);
        gradient
    }

    /// The damped Fisher matrix times a vector, written to `product`.
    pub fn fisher_times(
        &self,
        learner: &mut Learner,
        origin: &mut Origin<'_>,
        vector: &[f32],
        product: &mut [f32],
    ) {
        let vectors = learner.vectors();
        let norm = vectors.dot(vector, vector).sqrt();
        if norm == 0.0 {
            return product.fill(0.0);
        }
        let step = DIFFERENCE / norm;
        // What will hold the product holds the parameters a little way off first.
        vectors.set_sum(product, &origin.parameters, step, vector);
        let moved = learner.fisher_outputs(&mut origin.sample, product);
        let change: Vec<f32> = moved
            .iter()
            .zip(&origin.sample_outputs)
            .map(|(there, here)| (f64::from(there - here) / step) as f32)
            .collect();
        let mut rows = origin.sample_policy.fisher_times(&change);
        let count = origin.sample.sequences.rows() as f32;
        rows.iter_mut().for_each(|value| *value /= count);
        learner.fisher_backward(&mut origin.sample, &rows, product);
        vectors.add_scaled(product, self.damping, vector);
    }

    /// Solves F x = b by conjugate gradients.
    #[must_use]
    pub fn solve(&self, learner: &mut Learner, origin: &mut Origin<'_>, b: &[f32]) -> Solution {
        let vectors = learner.vectors();
        let (mut x, mut product) = (vec![0.0; b.len()], vec![0.0; b.len()]);
        let (mut rest, mut direction) = (b.to_vec(), b.to_vec());
        let mut size = vectors.dot(&rest, &rest);
        for _ in 0..self.iterations {
            if size < 1e-10 {
                break;
            }
            self.fisher_times(learner, origin, &direction, &mut product);
            let curvature = vectors.dot(&direction, &product);
            if curvature <= 0.0 {
                break;
            }
            let length = size / curvature;
            vectors.add_scaled(&mut x, length, &direction);
            vectors.add_scaled(&mut rest, -length, &product);
            let smaller = vectors.dot(&rest, &rest);
            vectors.scale_and_add(&mut direction, smaller / size, &rest);
            size = smaller;
        }
        vectors.set_sum(&mut product, b, -1.0, &rest);
        Solution { direction: x, product }
    }

    /// Shortens a step until it is accepted; `accept` is asked about the policy after it and its
    /// mean divergence from the policy that acted. Reports the step, and the share of it that was
    /// made: 0 if none was.
    pub fn search(
        &self,
        learner: &mut Learner,
        minibatch: &mut Minibatch<'_>,
        origin: &Origin<'_>,
        step: &[f32],
        means: &mut Means,
        mut accept: impl FnMut(&Heads, f64) -> bool,
    ) {
        let clip = learner.config.learning.clip_ratio;
        let mut share = 1.0;
        let mut parameters = vec![0.0; step.len()];
        for _ in 0..self.search_steps {
            learner.vectors().set_sum(&mut parameters, &origin.parameters, share, step);
            let outputs = learner.policy_outputs(&mut minibatch.batch, &parameters);
            let heads = learner.policy_heads(minibatch, &outputs);
            let divergence = minibatch.old_policy.divergence(&heads.policy).mean();
            if divergence.is_finite() && accept(&heads, divergence) {
                learner.set_policy_parameters(&parameters);
                note_policy(&heads, minibatch, clip, means);
                means.add("step_share", share);
                return;
            }
            share *= self.search_factor;
        }
        learner.set_policy_parameters(&origin.parameters);
        note_policy(&origin.heads, minibatch, clip, means);
        means.add("step_share", 0.0);
    }
}

/// Steps of Adam for the critics, down their squared errors. `critics` counts the reward's as 0.
///
/// A step of the policy is one of many samples. Critics that made a single step on them too would
/// lag behind every policy, and advantages would be those of an older one; so they go through the
/// same samples in smaller parts, dealt anew each time.
pub fn train_critics(
    learner: &mut Learner,
    minibatch: &mut Minibatch<'_>,
    critics: usize,
    means: &mut Means,
) -> Result<(), LearnError> {
    let settings = &learner.config.algorithm_settings;
    let (count, seed) = (settings.critic_steps, learner.config.seed);
    let (steps, lanes) = (minibatch.batch.sequences.steps, minibatch.batch.sequences.lanes);
    let share =
        settings.critic_batch.map_or(lanes, |samples| samples / steps.max(1)).clamp(1, lanes);
    if share == lanes {
        return (0..count).try_for_each(|_| critic_step(learner, minibatch, critics, means));
    }
    // Counted by updates, so that a resumed run deals as the one that went straight through.
    let (update, mut dealt) = (learner.version, Vec::new());
    for step in 0..count {
        if dealt.len() < share {
            dealt = (0..lanes).collect();
            Stream::new(seed, Purpose::Shuffle, update, step as u64).shuffle(&mut dealt);
        }
        let part = dealt.split_off(dealt.len() - share);
        critic_step(learner, &mut minibatch.of_lanes(learner.shape(), &part), critics, means)?;
    }
    Ok(())
}

/// One of these steps, on all of a minibatch.
fn critic_step(
    learner: &mut Learner,
    minibatch: &mut Minibatch<'_>,
    critics: usize,
    means: &mut Means,
) -> Result<(), LearnError> {
    let loss = |heads: &Heads, batch: &Minibatch<'_>, means: &mut Means| {
        let losses =
            heads.values.iter().zip(&batch.critics).take(critics).map(|(value, critic)| {
                let loss = heads.mean([value], |row, [value]| {
                    (value - f64::from(critic.targets[row])).square()
                });
                means.add(critic.loss_name.clone(), loss.value);
                loss
            });
        losses.reduce(|sum, loss| sum + loss).expect("the reward has a critic")
    };
    learner.descend_networks(1..1 + critics, 0, minibatch, loss, means)
}

#[cfg(test)]
mod tests;
