//! The distribution of actions: a tuple of independent categoricals, followed by independent normals.
//!
//! A row of policy outputs holds the logits of each categorical one after the other, then mean and logarithm of the
//! deviation of each normal. Log-probabilities, entropies and divergences are sums over the parts. The functions on
//! rows serve acting; those on tensors serve losses and are differentiable.

use burn::tensor::activation::log_softmax;
use burn::tensor::{Int, Tensor};
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

const LOG_ROOT_TAU: f64 = 0.918_938_533_204_672_7;
/// Bounds of the logarithm of a deviation: 1e-4 and 1e4.
const LOG_DEVIATION: f32 = 9.210_34;

impl ActionShape {
    /// Length of a row of policy outputs.
    #[must_use]
    pub fn parameters(&self) -> usize {
        self.sizes.iter().sum::<usize>() + 2 * self.deltas
    }

    /// Draws an action, writing its parts, and returns the logarithm of its probability (density).
    pub fn sample(&self, row: &[f32], stream: &mut Stream, actions: &mut [u8], deltas: &mut [f32]) -> f32 {
        let mut log_probability = 0.0;
        let mut first = 0;
        for (&size, action) in self.sizes.iter().zip(actions) {
            let logits = &row[first..first + size];
            let draw = stream.uniform();
            let (largest, sum) = softmax_parts(logits);
            let mut passed = 0.0;
            let mut choice = size - 1;
            for (index, &logit) in logits.iter().enumerate() {
                passed += f64::from(logit - largest).exp() / sum;
                if draw < passed {
                    choice = index;
                    break;
                }
            }
            *action = choice as u8;
            log_probability += f64::from(logits[choice] - largest) - sum.ln();
            first += size;
        }
        for (parameters, delta) in row[first..self.parameters()].chunks_exact(2).zip(deltas) {
            let log_deviation = f64::from(parameters[1].clamp(-LOG_DEVIATION, LOG_DEVIATION));
            let draw = stream.normal();
            *delta = (f64::from(parameters[0]) + draw * log_deviation.exp()) as f32;
            log_probability += -0.5 * draw * draw - log_deviation - LOG_ROOT_TAU;
        }
        log_probability as f32
    }

    /// The most probable action.
    pub fn greedy(&self, row: &[f32], actions: &mut [u8], deltas: &mut [f32]) {
        let mut first = 0;
        for (&size, action) in self.sizes.iter().zip(actions) {
            let logits = &row[first..first + size];
            *action = (1..size).fold(0, |best, index| if logits[index] > logits[best] { index } else { best }) as u8;
            first += size;
        }
        for (parameters, delta) in row[first..self.parameters()].chunks_exact(2).zip(deltas) {
            *delta = parameters[0];
        }
    }
}

impl ActionShape {
    /// The Fisher matrix of each row's distribution, in its outputs, times a vector a row.
    #[must_use]
    pub fn fisher_times(&self, outputs: &[f32], vectors: &[f32]) -> Vec<f32> {
        let mut products = vec![0.0; vectors.len()];
        let width = self.parameters();
        let rows = outputs.chunks_exact(width).zip(vectors.chunks_exact(width)).zip(products.chunks_exact_mut(width));
        for ((row, vector), product) in rows {
            let mut first = 0;
            for &size in &self.sizes {
                let (logits, vector) = (&row[first..first + size], &vector[first..first + size]);
                let (largest, sum) = softmax_parts(logits);
                let p = |index: usize| f64::from(logits[index] - largest).exp() / sum;
                let mean: f64 = (0..size).map(|index| p(index) * f64::from(vector[index])).sum();
                for index in 0..size {
                    product[first + index] = (p(index) * (f64::from(vector[index]) - mean)) as f32;
                }
                first += size;
            }
            for at in (first..width).step_by(2) {
                let log_deviation = row[at + 1].clamp(-LOG_DEVIATION, LOG_DEVIATION);
                product[at] = vector[at] * (-2.0 * log_deviation).exp();
                product[at + 1] = if log_deviation == row[at + 1] { 2.0 * vector[at + 1] } else { 0.0 };
            }
        }
        products
    }
}

fn softmax_parts(logits: &[f32]) -> (f32, f64) {
    let largest = logits.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    (largest, logits.iter().map(|&logit| f64::from(logit - largest).exp()).sum())
}

/// Policy outputs as a distribution, one row a sample.
#[derive(Clone, Debug)]
pub struct Policy {
    /// Log-probabilities of each categorical.
    choices: Vec<Tensor<2>>,
    /// Mean and logarithm of the deviation of each normal.
    normals: Vec<(Tensor<2>, Tensor<2>)>,
}

/// Actions that were taken, one row a sample.
#[derive(Clone, Debug)]
pub struct Taken {
    /// Choice of each categorical.
    choices: Vec<Tensor<2, Int>>,
    /// Value of each normal.
    deltas: Vec<Tensor<2>>,
}

impl Taken {
    /// Actions and deltas in rows, as tensors on a device.
    #[must_use]
    pub fn new(shape: &ActionShape, actions: &[u8], deltas: &[f32], device: &burn::tensor::Device) -> Taken {
        let column = |index: usize| -> Vec<i32> {
            actions.iter().skip(index).step_by(shape.sizes.len()).map(|&action| i32::from(action)).collect()
        };
        let choices = (0..shape.sizes.len()).map(|index| {
            let values = column(index);
            let rows = values.len();
            Tensor::from_data(burn::tensor::TensorData::new(values, [rows, 1]), device)
        });
        let normals = (0..shape.deltas).map(|index| {
            let values: Vec<f32> = deltas.iter().skip(index).step_by(shape.deltas).copied().collect();
            let rows = values.len();
            Tensor::from_data(burn::tensor::TensorData::new(values, [rows, 1]), device)
        });
        Taken { choices: choices.collect(), deltas: normals.collect() }
    }
}

impl Policy {
    /// The distribution of rows of policy outputs.
    #[must_use]
    pub fn new(shape: &ActionShape, outputs: &Tensor<2>) -> Policy {
        let mut first = 0;
        let mut columns = |count: usize| {
            first += count;
            outputs.clone().narrow(1, first - count, count)
        };
        Policy {
            choices: shape.sizes.iter().map(|&size| log_softmax(columns(size), 1)).collect(),
            normals: (0..shape.deltas).map(|_| (columns(1), columns(1).clamp(-LOG_DEVIATION, LOG_DEVIATION))).collect(),
        }
    }

    /// Sum over the parts of a column a part.
    fn total(parts: impl Iterator<Item = Tensor<2>>) -> Tensor<1> {
        let parts: Vec<_> = parts.collect();
        Tensor::cat(parts, 1).sum_dim(1).squeeze_dim(1)
    }

    /// Logarithm of the probability of actions.
    #[must_use]
    pub fn log_probability(&self, taken: &Taken) -> Tensor<1> {
        let choices = self.choices.iter().zip(&taken.choices).map(|(logs, choice)| logs.clone().gather(1, choice.clone()));
        let normals = self.normals.iter().zip(&taken.deltas).map(|((mean, log_deviation), delta)| {
            let draw = (delta.clone() - mean.clone()) / log_deviation.clone().exp();
            draw.clone() * draw * -0.5 - log_deviation.clone() - LOG_ROOT_TAU
        });
        Policy::total(choices.chain(normals))
    }

    /// Entropy of each sample's distribution.
    #[must_use]
    pub fn entropy(&self) -> Tensor<1> {
        let choices = self.choices.iter().map(|logs| -(logs.clone().exp() * logs.clone()).sum_dim(1));
        let normals = self.normals.iter().map(|(_, log_deviation)| log_deviation.clone() + (0.5 + LOG_ROOT_TAU));
        Policy::total(choices.chain(normals))
    }

    /// Symmetric divergence from the uniform distribution, half of each direction; for a normal, whose uniform twin does
    /// not exist, from the standard normal.
    #[must_use]
    pub fn symmetric_divergence_from_uniform(&self) -> Tensor<1> {
        let choices = self.choices.iter().map(|logs| {
            let size = logs.dims()[1] as f64;
            // Half of KL(p, u) + KL(u, p): the constants ln(size) cancel.
            let forward = (logs.clone().exp() * logs.clone()).sum_dim(1);
            let backward = logs.clone().sum_dim(1) * (-1.0 / size);
            (forward + backward) * 0.5
        });
        let normals = self.normals.iter().map(|(mean, log_deviation)| {
            let variance = (log_deviation.clone() * 2.0).exp();
            let square = mean.clone() * mean.clone();
            // KL(p, n) + KL(n, p) with n standard: the logarithms of the deviations cancel.
            (variance.clone() + square.clone() + (square + 1.0) / variance - 2.0) * 0.25
        });
        Policy::total(choices.chain(normals))
    }

    /// Divergence of `other` as seen from this distribution: the mean, under this one, of the log-ratio to the other.
    #[must_use]
    pub fn divergence(&self, other: &Policy) -> Tensor<1> {
        let choices = self
            .choices
            .iter()
            .zip(&other.choices)
            .map(|(own, other)| (own.clone().exp() * (own.clone() - other.clone())).sum_dim(1));
        let normals = self.normals.iter().zip(&other.normals).map(|((mean, log), (other_mean, other_log))| {
            let distance = mean.clone() - other_mean.clone();
            let scaled = ((log.clone() * 2.0).exp() + distance.clone() * distance) / (other_log.clone() * 2.0).exp();
            other_log.clone() - log.clone() + scaled * 0.5 - 0.5
        });
        Policy::total(choices.chain(normals))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Purpose;
    use burn::tensor::{Device, TensorData};

    fn rows(values: Vec<f32>, width: usize) -> Tensor<2> {
        let count = values.len() / width;
        Tensor::from_data(TensorData::new(values, [count, width]), &Device::flex())
    }

    fn scalar(tensor: Tensor<1>) -> f64 {
        f64::from(tensor.into_scalar::<f32>())
    }

    /// `training.md` §10.
    #[test]
    fn divergence_from_uniform_and_entropy_equal_the_recorded_numbers() {
        for (logits, divergence, entropy) in
            [(vec![1.0, 0.0, -1.0], 0.287_605_191, 0.832_395_582), (vec![0.5, -0.5], 0.115_529_289, 0.582_203_109)]
        {
            let shape = ActionShape { sizes: vec![logits.len()], deltas: 0 };
            let width = logits.len();
            let policy = Policy::new(&shape, &rows(logits, width));
            assert!((scalar(policy.symmetric_divergence_from_uniform()) - divergence).abs() < 1e-6);
            assert!((scalar(policy.entropy()) - entropy).abs() < 1e-6);
        }
    }

    #[test]
    fn sampled_actions_have_the_probabilities_that_are_reported() {
        let shape = ActionShape { sizes: vec![3, 2], deltas: 1 };
        let row = [0.3f32, -0.7, 1.1, 0.2, 0.9, 0.4, -0.5];
        let policy = Policy::new(&shape, &rows(row.to_vec(), row.len()));
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
                let taken = Taken::new(&shape, &actions, &deltas, &Device::flex());
                assert!((scalar(policy.log_probability(&taken)) - f64::from(log_probability)).abs() < 1e-5);
            }
        }
        let exp: Vec<f64> = row[..5].iter().map(|&l| f64::from(l).exp()).collect();
        for (i, counts) in counts.iter().enumerate() {
            for (j, &count) in counts.iter().enumerate() {
                let p = exp[i] / exp[..3].iter().sum::<f64>() * exp[3 + j] / exp[3..].iter().sum::<f64>();
                let error = (p * (1.0 - p) / f64::from(draws)).sqrt();
                assert!((f64::from(count) / f64::from(draws) - p).abs() < 4.0 * error, "{i} {j}");
            }
        }
        let mean = sum / f64::from(draws);
        let deviation = (squares / f64::from(draws) - mean * mean).sqrt();
        assert!((mean - 0.4).abs() < 0.02 && (deviation - (-0.5f64).exp()).abs() < 0.02, "{mean} {deviation}");
        let (mut actions, mut deltas) = ([0u8; 2], [0.0f32; 1]);
        shape.greedy(&row, &mut actions, &mut deltas);
        assert_eq!((actions, deltas), ([2, 1], [0.4]));
    }

    /// Divergences by their definition, as sums and as an integral over a fine grid.
    #[test]
    fn divergences_follow_their_definition() {
        let shape = ActionShape { sizes: vec![3], deltas: 1 };
        let (a, b) = ([0.3f32, -0.7, 1.1, 0.4, -0.5], [0.1f32, 0.2, -0.3, -0.2, 0.3]);
        let (p, q) = (Policy::new(&shape, &rows(a.to_vec(), 5)), Policy::new(&shape, &rows(b.to_vec(), 5)));
        let log = |row: &[f32], delta: f64| -> Vec<f64> {
            let total: f64 = row[..3].iter().map(|&l| f64::from(l).exp()).sum();
            let mut logs: Vec<f64> = row[..3].iter().map(|&l| f64::from(l) - total.ln()).collect();
            let draw = (delta - f64::from(row[3])) / f64::from(row[4]).exp();
            logs.push(-0.5 * draw * draw - f64::from(row[4]) - LOG_ROOT_TAU);
            logs
        };
        let (discrete_p, discrete_q) = (log(&a, 0.0), log(&b, 0.0));
        let mut expected: f64 = (0..3).map(|i| discrete_p[i].exp() * (discrete_p[i] - discrete_q[i])).sum();
        let step = 1e-3;
        for index in -20_000..20_000 {
            let x = f64::from(index) * step;
            let (lp, lq) = (log(&a, x)[3], log(&b, x)[3]);
            expected += lp.exp() * (lp - lq) * step;
        }
        assert!((scalar(p.divergence(&q)) - expected).abs() < 1e-5);
        assert!(scalar(p.divergence(&p)).abs() < 1e-6);
    }
}
