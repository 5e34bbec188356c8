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
        // Spread over all lanes; which ones does not matter, for each is in another episode.
        let sampled: Vec<usize> = (0..count).map(|index| index * lanes / count).collect();
        let mut sample = minibatch.batch.of_lanes(learner.shape(), &sampled);
        let sample_outputs = learner.present_outputs(&mut sample);
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
        let moved = learner.policy_outputs(&mut origin.sample, product);
        let change: Vec<f32> = moved
            .iter()
            .zip(&origin.sample_outputs)
            .map(|(there, here)| (f64::from(there - here) / step) as f32)
            .collect();
        let mut rows = origin.sample_policy.fisher_times(&change);
        let count = origin.sample.sequences.rows() as f32;
        rows.iter_mut().for_each(|value| *value /= count);
        learner.policy_backward(&mut origin.sample, &rows, product);
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
mod tests {
    use super::*;
    use crate::algorithms::small;
    use crate::config::AlgorithmKind;
    use crate::random::{Purpose, Stream};

    /// The product against the dense Fisher matrix by its definition: the mean over samples and
    /// actions of the outer product of the gradient of the log-probability, gradients by the
    /// backward pass.
    #[test]
    fn fisher_products_equal_those_of_the_dense_matrix() {
        let config = small::config(AlgorithmKind::Trpo);
        let (mut learner, rollout) = small::learner(&config);
        // As in the middle of a run, where pixels have been seen.
        learner.absorb(&rollout).unwrap();
        let prepared = learner.prepare(&rollout);
        let mut minibatch = learner.minibatch(&prepared, &[0, 1, 2, 3]);
        let region = TrustRegion::new(&config);
        let mut origin = region.origin(&mut learner, &mut minibatch);
        let (count, width) = (origin.parameters.len(), learner.shape().action.parameters());
        let outputs = learner.policy_outputs(&mut minibatch.batch, &origin.parameters);
        let rows = outputs.len() / width;
        let mut fisher = vec![0.0f64; count * count];
        let mut add = |gradient: &[f32], weight: f64| {
            for (i, &a) in gradient.iter().enumerate().filter(|(_, a)| **a != 0.0) {
                for (j, &b) in gradient.iter().enumerate() {
                    fisher[i * count + j] += weight * f64::from(a) * f64::from(b);
                }
            }
        };
        for row in 0..rows {
            let outputs = &outputs[row * width..(row + 1) * width];
            let mut gradient_of = |direction: &[f64]| {
                let _ = learner.policy_outputs(&mut minibatch.batch, &origin.parameters);
                let mut seeds = vec![0.0; rows * width];
                for (seed, value) in seeds[row * width..].iter_mut().zip(direction) {
                    *seed = *value as f32;
                }
                let mut gradient = vec![0.0; count];
                learner.policy_backward(&mut minibatch.batch, &seeds, &mut gradient);
                gradient
            };
            for (first, size) in [(0, 3), (3, 2)] {
                let exp: Vec<f64> =
                    outputs[first..first + size].iter().map(|&l| f64::from(l).exp()).collect();
                let p: Vec<f64> = exp.iter().map(|e| e / exp.iter().sum::<f64>()).collect();
                for action in 0..size {
                    let mut direction = vec![0.0; width];
                    for index in 0..size {
                        direction[first + index] = f64::from(u8::from(index == action)) - p[index];
                    }
                    add(&gradient_of(&direction), p[action] / rows as f64);
                }
            }
            // A normal's log-probability has gradient z/sigma in the mean and z^2 - 1 in the
            // logarithm of the deviation, whose products have the means 1/sigma^2, 2 and 0.
            let sigma = f64::from(outputs[6]).exp();
            let (mut mean, mut log) = (vec![0.0; width], vec![0.0; width]);
            (mean[5], log[6]) = (1.0 / sigma, 2.0f64.sqrt());
            add(&gradient_of(&mean), 1.0 / rows as f64);
            add(&gradient_of(&log), 1.0 / rows as f64);
        }
        let mut stream = Stream::new(4, Purpose::Evaluation, 0, 0);
        for _ in 0..3 {
            let vector: Vec<f32> = (0..count).map(|_| stream.normal() as f32).collect();
            let mut product = vec![0.0; count];
            region.fisher_times(&mut learner, &mut origin, &vector, &mut product);
            let expected: Vec<f64> = (0..count)
                .map(|i| {
                    let row = &fisher[i * count..(i + 1) * count];
                    let damped = 0.1 * f64::from(vector[i]);
                    damped + row.iter().zip(&vector).map(|(f, v)| f * f64::from(*v)).sum::<f64>()
                })
                .collect();
            let largest = expected.iter().fold(0.0f64, |most, value| most.max(value.abs()));
            for (i, (found, expected)) in product.iter().zip(&expected).enumerate() {
                let error = (f64::from(*found) - expected).abs();
                assert!(
                    error < 2e-3 * largest,
                    "{i}: {found} against {expected} (largest {largest})"
                );
            }
        }
        // And the solution of F x = b, put back in, gives b.
        let b: Vec<f32> = (0..count).map(|_| stream.normal() as f32).collect();
        let region = TrustRegion { iterations: 60, ..region };
        let x = region.solve(&mut learner, &mut origin, &b);
        let mut back = vec![0.0; count];
        region.fisher_times(&mut learner, &mut origin, &x.direction, &mut back);
        let squares = |a: &[f32], b: &[f32]| {
            a.iter().zip(b).map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>()
        };
        let (rest, all) = (squares(&back, &b), squares(&b, &vec![0.0; count]));
        assert!(rest < 1e-3 * all, "{rest} of {all}");
        assert!(squares(&back, &x.product) < 1e-3 * all, "the product that is reported");
    }

    /// A step along a direction, halved until it is accepted: one that raises the divergence too
    /// far is shortened to one that does not, and one that nothing accepts leaves every bit as it
    /// was. Parameters move by the reported share of the step.
    #[test]
    fn a_search_ends_in_an_accepted_step_or_where_it_began() {
        let config = small::config(AlgorithmKind::Trpo);
        let (mut learner, rollout) = small::learner(&config);
        learner.absorb(&rollout).unwrap();
        let prepared = learner.prepare(&rollout);
        let mut minibatch = learner.minibatch(&prepared, &[0, 1, 2, 3]);
        // The rollout's outputs are noise: the policy that acted is the present one here.
        let outputs = learner.policy_outputs(&mut minibatch.batch, &learner.policy_parameters());
        minibatch.old_policy =
            Policy::new(&learner.shape().action, &outputs, learner.shape().action.parameters());
        let region =
            TrustRegion { search_steps: 30, search_factor: 0.5, ..TrustRegion::new(&config) };
        let origin = region.origin(&mut learner, &mut minibatch);
        let step: Vec<f32> =
            (0..origin.parameters.len()).map(|index| (index as f32).sin() * 3.0).collect();
        let mut means = Means::default();
        let mut asked = Vec::new();
        region.search(&mut learner, &mut minibatch, &origin, &step, &mut means, |_, divergence| {
            asked.push(divergence);
            divergence <= 0.01
        });
        let share = means.get("step_share").unwrap();
        assert!(asked.len() > 1 && share == 0.5f64.powi(asked.len() as i32 - 1), "{asked:?}");
        assert!(asked[0] > 0.01 && *asked.last().unwrap() <= 0.01, "{asked:?}");
        let parameters = learner.policy_parameters();
        for ((now, then), step) in parameters.iter().zip(&origin.parameters).zip(&step) {
            assert!((f64::from(now - then) - share * f64::from(*step)).abs() < 1e-6);
        }
        let divergence = learner.policy(&mut minibatch);
        let divergence = minibatch.old_policy.divergence(&divergence).mean();
        assert!((divergence - asked.last().unwrap()).abs() < 1e-9, "the accepted policy acts");
        let mut means = Means::default();
        region.search(&mut learner, &mut minibatch, &origin, &step, &mut means, |_, _| false);
        assert_eq!(means.get("step_share"), Some(0.0));
        assert_eq!(learner.policy_parameters(), origin.parameters);
    }

    /// Schulman et al. 2015, appendix C: the step's length is such that half its quadratic form
    /// with the Fisher matrix is the radius, and the line search never ends beyond it.
    #[test]
    fn trpo_moves_to_the_edge_of_its_region_and_not_beyond() {
        use crate::algorithms::trpo::Trpo;
        for radius in [1e-4, 1e-3, 1e-2] {
            let mut config = small::config(AlgorithmKind::Trpo);
            config.algorithm_settings.trust_radius = radius;
            let (mut learner, rollout) = small::learner(&config);
            learner.absorb(&rollout).unwrap();
            let prepared = learner.prepare(&rollout);
            let mut minibatch = learner.minibatch(&prepared, &[0, 1, 2, 3]);
            let outputs =
                learner.policy_outputs(&mut minibatch.batch, &learner.policy_parameters());
            let action = learner.shape().action.clone();
            let before = Policy::new(&action, &outputs, action.parameters());
            minibatch.old_policy = before.clone();
            let taken = &minibatch.taken;
            minibatch.old_log_probability = before.log_probability(taken).values;
            let (mixed, mut means) = (minibatch.advantages().to_vec(), Means::default());
            Trpo::new(&config).step(&mut learner, &mut minibatch, mixed, &mut means).unwrap();
            let share = means.get("step_share").unwrap();
            let divergence = before.divergence(&learner.policy(&mut minibatch)).mean();
            assert!(share > 0.0 && divergence <= radius, "radius {radius}: {divergence}");
            // The damping takes a part of the form, and the search another.
            let reached = divergence / (radius * share * share);
            assert!((0.3..1.3).contains(&reached), "radius {radius}: {reached} of it, {share}");
        }
    }
}
