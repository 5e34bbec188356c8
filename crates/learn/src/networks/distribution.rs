//! The distribution of actions: a tuple of independent categoricals, followed by independent
//! normals.
//!
//! A row of policy outputs holds the logits of each categorical one after the other, then mean and
//! logarithm of the deviation of each normal. Here is what acting needs of it; what losses need is
//! in [`crate::learning::policy`].

use hasard_envs::ActionSpace;
use serde::{Deserialize, Serialize};

use crate::random::Stream;

/// Sizes of the parts.
#[derive(Clone, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct ActionShape {
    /// Choices of each categorical.
    pub sizes: Vec<usize>,
    /// Number of normals.
    pub deltas: usize,
}

impl From<&ActionSpace> for ActionShape {
    fn from(space: &ActionSpace) -> ActionShape {
        ActionShape { sizes: space.sizes(), deltas: space.deltas.len() }
    }
}

/// Half of the logarithm of two pi.
pub(crate) const LOG_ROOT_TAU: f64 = 0.918_938_533_204_672_7;
/// Bounds of the logarithm of a deviation: 1e-4 and 1e4.
pub(crate) const LOG_DEVIATION: f64 = 9.210_340_371_976_184;

impl ActionShape {
    /// Length of a row of policy outputs.
    #[must_use]
    pub fn parameters(&self) -> usize {
        self.sizes.iter().sum::<usize>() + 2 * self.deltas
    }

    /// Draws an action, writing its parts, and returns the logarithm of its probability (density).
    pub fn sample(
        &self,
        row: &[f32],
        stream: &mut Stream,
        actions: &mut [u8],
        deltas: &mut [f32],
    ) -> f32 {
        let mut log_probability = 0.0;
        let mut first = 0;
        for (&size, action) in self.sizes.iter().zip(actions) {
            let logits = &row[first..first + size];
            let draw = stream.uniform();
            let (largest, sum) = softmax_parts(logits);
            let mut passed = 0.0;
            let mut choice = size - 1;
            for (index, &logit) in logits.iter().enumerate() {
                passed += libm::exp(f64::from(logit - largest)) / sum;
                if draw < passed {
                    choice = index;
                    break;
                }
            }
            *action = choice as u8;
            log_probability += f64::from(logits[choice] - largest) - libm::log(sum);
            first += size;
        }
        for (parameters, delta) in row[first..self.parameters()].chunks_exact(2).zip(deltas) {
            let log_deviation = f64::from(parameters[1]).clamp(-LOG_DEVIATION, LOG_DEVIATION);
            let draw = stream.normal();
            *delta = (f64::from(parameters[0]) + draw * libm::exp(log_deviation)) as f32;
            log_probability += -0.5 * draw * draw - log_deviation - LOG_ROOT_TAU;
        }
        log_probability as f32
    }

    /// Probability of each choice of each categorical.
    #[must_use]
    pub fn probabilities(&self, row: &[f32]) -> Vec<Vec<f32>> {
        let mut rest = row;
        let of = |&size: &usize| {
            let (logits, after) = rest.split_at(size);
            rest = after;
            let (largest, sum) = softmax_parts(logits);
            logits
                .iter()
                .map(|logit| (libm::exp(f64::from(logit - largest)) / sum) as f32)
                .collect()
        };
        self.sizes.iter().map(of).collect()
    }

    /// The most probable action.
    pub fn greedy(&self, row: &[f32], actions: &mut [u8], deltas: &mut [f32]) {
        let mut first = 0;
        for (&size, action) in self.sizes.iter().zip(actions) {
            let logits = &row[first..first + size];
            *action = (1..size)
                .fold(0, |best, index| if logits[index] > logits[best] { index } else { best })
                as u8;
            first += size;
        }
        for (parameters, delta) in row[first..self.parameters()].chunks_exact(2).zip(deltas) {
            *delta = parameters[0];
        }
    }
}

fn softmax_parts(logits: &[f32]) -> (f32, f64) {
    let largest = logits.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    (largest, logits.iter().map(|&logit| libm::exp(f64::from(logit - largest))).sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Purpose;

    #[test]
    fn sampled_actions_have_the_probabilities_that_are_reported() {
        let shape = ActionShape { sizes: vec![3, 2], deltas: 1 };
        let row = [0.3f32, -0.7, 1.1, 0.2, 0.9, 0.4, -0.5];
        let exp: Vec<f64> = row[..5].iter().map(|&l| f64::from(l).exp()).collect();
        let p = |i: usize, j: usize| {
            exp[i] / exp[..3].iter().sum::<f64>() * exp[3 + j] / exp[3..].iter().sum::<f64>()
        };
        let mut counts = [[0u32; 2]; 3];
        let (mut sum, mut squares) = (0.0, 0.0);
        let mut stream = Stream::new(1, Purpose::Actions, 0, 0);
        let draws = 20_000;
        for draw in 0..draws {
            let (mut actions, mut deltas) = ([0u8; 2], [0.0f32; 1]);
            let log_probability = shape.sample(&row, &mut stream, &mut actions, &mut deltas);
            counts[actions[0] as usize][actions[1] as usize] += 1;
            sum += f64::from(deltas[0]);
            squares += f64::from(deltas[0]).powi(2);
            if draw < 50 {
                let normal = (f64::from(deltas[0]) - 0.4) / (-0.5f64).exp();
                let density = -0.5 * normal * normal + 0.5 - 0.5 * std::f64::consts::TAU.ln();
                let expected = p(actions[0].into(), actions[1].into()).ln() + density;
                assert!((expected - f64::from(log_probability)).abs() < 1e-5);
            }
        }
        for (i, counts) in counts.iter().enumerate() {
            for (j, &count) in counts.iter().enumerate() {
                let p = p(i, j);
                let error = (p * (1.0 - p) / f64::from(draws)).sqrt();
                assert!((f64::from(count) / f64::from(draws) - p).abs() < 4.0 * error, "{i} {j}");
            }
        }
        let mean = sum / f64::from(draws);
        let deviation = (squares / f64::from(draws) - mean * mean).sqrt();
        assert!(
            (mean - 0.4).abs() < 0.02 && (deviation - (-0.5f64).exp()).abs() < 0.02,
            "{mean} {deviation}"
        );
        let (mut actions, mut deltas) = ([0u8; 2], [0.0f32; 1]);
        shape.greedy(&row, &mut actions, &mut deltas);
        assert_eq!((actions, deltas), ([2, 1], [0.4]));
    }
}
