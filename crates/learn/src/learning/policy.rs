//! Policy outputs as distributions, for losses: every number that a loss needs, with its gradient
//! in the outputs.
//!
//! The gradients are closed forms a line or two long; a test holds each against central differences
//! in 64 bits.

use std::ops::Range;

use crate::learning::dual_number::DualNumber;
use crate::networks::distribution::{ActionShape, LOG_DEVIATION, LOG_ROOT_TAU};

/// Actions that were taken, a row a sample.
#[derive(Clone, Debug, Default)]
pub struct Taken {
    /// Choice of each categorical.
    pub actions: Vec<u8>,
    /// Value of each normal.
    pub deltas: Vec<f32>,
}

/// A number of every row, and how it changes with the row's outputs.
#[derive(Clone, Debug)]
pub struct Column {
    /// The numbers.
    pub values: Vec<f64>,
    /// The outputs of a row that they depend on.
    outputs: Range<usize>,
    /// Derivatives in those outputs, row by row.
    slopes: Vec<f64>,
}

impl Column {
    /// One of the outputs itself.
    #[must_use]
    pub fn of_output(rows: &[f32], width: usize, output: usize) -> Column {
        let values: Vec<f64> =
            rows.iter().skip(output).step_by(width).map(|&value| f64::from(value)).collect();
        Column { slopes: vec![1.0; values.len()], values, outputs: output..output + 1 }
    }

    /// A function of the numbers, given the row as well.
    #[must_use]
    pub fn map(&self, function: impl Fn(usize, DualNumber<1>) -> DualNumber<1>) -> Column {
        let mut mapped = self.clone();
        let width = self.outputs.len();
        for (row, value) in mapped.values.iter_mut().enumerate() {
            let DualNumber { value: number, slopes: [derivative] } =
                function(row, DualNumber::variable(*value, 0));
            *value = number;
            mapped.slopes[row * width..(row + 1) * width]
                .iter_mut()
                .for_each(|slope| *slope *= derivative);
        }
        mapped
    }

    /// Adds the gradient of a row's number, times a factor, to the gradient of something in the
    /// row's outputs.
    pub fn add_slopes(&self, row: usize, factor: f64, gradient: &mut [f64]) {
        let width = self.outputs.len();
        let slopes = &self.slopes[row * width..(row + 1) * width];
        for (sum, slope) in gradient[self.outputs.clone()].iter_mut().zip(slopes) {
            *sum += factor * slope;
        }
    }

    /// The mean of the numbers.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.values.iter().sum::<f64>() / self.values.len() as f64
    }
}

/// Policy outputs as distributions, one a row.
#[derive(Clone, Debug)]
pub struct Policy {
    shape: ActionShape,
    /// As the outputs, with log-probabilities in place of logits and deviations within their
    /// bounds.
    rows: Vec<f64>,
}

/// A normal: mean and logarithm of the deviation.
#[derive(Clone, Copy)]
struct Normal {
    mean: f64,
    log_deviation: f64,
}

impl Normal {
    fn variance(self) -> f64 {
        libm::exp(2.0 * self.log_deviation)
    }
}

impl Policy {
    /// The distributions of rows whose first outputs are the policy's.
    #[must_use]
    pub fn new(shape: &ActionShape, outputs: &[f32], width: usize) -> Policy {
        let own = outputs.chunks_exact(width).flat_map(|row| &row[..shape.parameters()]);
        Policy::from_rows(shape, own.map(|&value| f64::from(value)).collect())
    }

    fn from_rows(shape: &ActionShape, mut rows: Vec<f64>) -> Policy {
        for row in rows.chunks_exact_mut(shape.parameters()) {
            let mut rest = row;
            for &size in &shape.sizes {
                let (logits, after) = rest.split_at_mut(size);
                let largest = logits.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                let total = largest
                    + libm::log(logits.iter().map(|logit| libm::exp(logit - largest)).sum::<f64>());
                logits.iter_mut().for_each(|logit| *logit -= total);
                rest = after;
            }
            for log_deviation in rest.iter_mut().skip(1).step_by(2) {
                *log_deviation = log_deviation.clamp(-LOG_DEVIATION, LOG_DEVIATION);
            }
        }
        Policy { shape: shape.clone(), rows }
    }

    /// The distributions of some of the rows.
    #[must_use]
    pub fn of_rows(&self, rows: impl Iterator<Item = usize>) -> Policy {
        let width = self.shape.parameters();
        let rows =
            rows.flat_map(|row| &self.rows[row * width..(row + 1) * width]).copied().collect();
        Policy { shape: self.shape.clone(), rows }
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows.len() / self.shape.parameters()
    }

    /// A sum over the parts of every row's distribution. Each part is given its row, its number
    /// among its kind, itself (log-probabilities, or a normal) and where it stands in the row, and
    /// writes its derivatives.
    fn sum_over_parts(
        &self,
        categorical: impl Fn(usize, usize, &[f64], usize, &mut [f64]) -> f64,
        normal: impl Fn(usize, usize, Normal, usize, &mut [f64]) -> f64,
    ) -> Column {
        let width = self.shape.parameters();
        let mut slopes = vec![0.0; self.rows.len()];
        let mut values = Vec::with_capacity(self.rows());
        for (row, (numbers, slopes)) in
            self.rows.chunks_exact(width).zip(slopes.chunks_exact_mut(width)).enumerate()
        {
            let (mut first, mut sum) = (0, 0.0);
            for (index, &size) in self.shape.sizes.iter().enumerate() {
                let part = first..first + size;
                sum += categorical(row, index, &numbers[part.clone()], first, &mut slopes[part]);
                first += size;
            }
            for index in 0..self.shape.deltas {
                let one = Normal { mean: numbers[first], log_deviation: numbers[first + 1] };
                sum += normal(row, index, one, first, &mut slopes[first..first + 2]);
                if one.log_deviation.abs() >= LOG_DEVIATION {
                    slopes[first + 1] = 0.0;
                }
                first += 2;
            }
            values.push(sum);
        }
        Column { values, outputs: 0..width, slopes }
    }

    /// Logarithm of the probability (density) of actions.
    #[must_use]
    pub fn log_probability(&self, taken: &Taken) -> Column {
        let (groups, deltas) = (self.shape.sizes.len(), self.shape.deltas);
        self.sum_over_parts(
            |row, index, logs, _, slopes| {
                let choice = usize::from(taken.actions[row * groups + index]);
                slopes.iter_mut().zip(logs).for_each(|(slope, log)| *slope = -libm::exp(*log));
                slopes[choice] += 1.0;
                logs[choice]
            },
            |row, index, normal, _, slopes| {
                let deviation = libm::exp(normal.log_deviation);
                let draw =
                    (f64::from(taken.deltas[row * deltas + index]) - normal.mean) / deviation;
                slopes.copy_from_slice(&[draw / deviation, draw * draw - 1.0]);
                -0.5 * draw * draw - normal.log_deviation - LOG_ROOT_TAU
            },
        )
    }

    /// Entropy of each row's distribution.
    #[must_use]
    pub fn entropy(&self) -> Column {
        self.sum_over_parts(
            |_, _, logs, _, slopes| {
                let entropy = -logs.iter().map(|log| libm::exp(*log) * log).sum::<f64>();
                slopes
                    .iter_mut()
                    .zip(logs)
                    .for_each(|(slope, log)| *slope = -libm::exp(*log) * (log + entropy));
                entropy
            },
            |_, _, normal, _, slopes| {
                slopes[1] = 1.0;
                normal.log_deviation + 0.5 + LOG_ROOT_TAU
            },
        )
    }

    /// Symmetric divergence from the uniform distribution, half of each direction; for a normal,
    /// whose uniform twin does not exist, from the standard normal.
    #[must_use]
    pub fn symmetric_divergence_from_uniform(&self) -> Column {
        self.sum_over_parts(
            |_, _, logs, _, slopes| {
                // Half of KL(p, u) + KL(u, p): the constants ln(size) cancel.
                let uniform = 1.0 / logs.len() as f64;
                let mean_log = logs.iter().map(|log| libm::exp(*log) * log).sum::<f64>();
                for (slope, log) in slopes.iter_mut().zip(logs) {
                    let p = libm::exp(*log);
                    *slope = 0.5 * (p * (log - mean_log) + p - uniform);
                }
                0.5 * (mean_log - uniform * logs.iter().sum::<f64>())
            },
            |_, _, normal, _, slopes| {
                // KL(p, n) + KL(n, p) with n standard: the logarithms of the deviations cancel.
                let (mean, variance) = (normal.mean, normal.variance());
                let raised = (mean * mean + 1.0) / variance;
                slopes
                    .copy_from_slice(&[0.5 * (mean + mean / variance), 0.5 * (variance - raised)]);
                0.25 * (variance + mean * mean + raised - 2.0)
            },
        )
    }

    /// Divergence of `other` as seen from this distribution, KL(this, other): the mean, under this
    /// one, of the log-ratio to the other. The slopes are in this one's outputs.
    #[must_use]
    pub fn divergence(&self, other: &Policy) -> Column {
        let width = self.shape.parameters();
        self.sum_over_parts(
            |row, _, logs, first, slopes| {
                let others = &other.rows[row * width + first..];
                let sum = logs
                    .iter()
                    .zip(others)
                    .map(|(log, other)| libm::exp(*log) * (log - other))
                    .sum::<f64>();
                for ((slope, log), other) in slopes.iter_mut().zip(logs).zip(others) {
                    *slope = libm::exp(*log) * (log - other - sum);
                }
                sum
            },
            |row, _, normal, first, slopes| {
                let at = row * width + first;
                let other = Normal { mean: other.rows[at], log_deviation: other.rows[at + 1] };
                let distance = normal.mean - other.mean;
                let scaled = normal.variance() / other.variance();
                slopes.copy_from_slice(&[distance / other.variance(), scaled - 1.0]);
                other.log_deviation - normal.log_deviation
                    + 0.5 * (scaled + distance * distance / other.variance() - 1.0)
            },
        )
    }

    /// Divergence of this distribution as seen from an older one, KL(old, this). The slopes are in
    /// this one's outputs.
    #[must_use]
    pub fn divergence_seen_from(&self, old: &Policy) -> Column {
        let width = self.shape.parameters();
        self.sum_over_parts(
            |row, _, logs, first, slopes| {
                let olds = &old.rows[row * width + first..];
                for ((slope, log), old) in slopes.iter_mut().zip(logs).zip(olds) {
                    *slope = libm::exp(*log) - libm::exp(*old);
                }
                logs.iter().zip(olds).map(|(log, old)| libm::exp(*old) * (old - log)).sum()
            },
            |row, _, normal, first, slopes| {
                let at = row * width + first;
                let old = Normal { mean: old.rows[at], log_deviation: old.rows[at + 1] };
                let distance = normal.mean - old.mean;
                let scaled = (old.variance() + distance * distance) / normal.variance();
                slopes.copy_from_slice(&[distance / normal.variance(), 1.0 - scaled]);
                normal.log_deviation - old.log_deviation + 0.5 * (scaled - 1.0)
            },
        )
    }

    /// The Fisher matrix of each row's distribution, in its outputs, times a vector a row.
    #[must_use]
    pub fn fisher_times(&self, vectors: &[f32]) -> Vec<f32> {
        let width = self.shape.parameters();
        // The products stand where derivatives would; the sum that goes with them is of no
        // interest.
        let products = self.sum_over_parts(
            |row, _, logs, first, products| {
                let vector = &vectors[row * width + first..];
                let mean: f64 =
                    logs.iter().zip(vector).map(|(log, v)| libm::exp(*log) * f64::from(*v)).sum();
                for ((product, log), v) in products.iter_mut().zip(logs).zip(vector) {
                    *product = libm::exp(*log) * (f64::from(*v) - mean);
                }
                0.0
            },
            |row, _, normal, first, products| {
                let vector = &vectors[row * width + first..][..2];
                products.copy_from_slice(&[
                    f64::from(vector[0]) / normal.variance(),
                    2.0 * f64::from(vector[1]),
                ]);
                0.0
            },
        );
        products.slopes.iter().map(|&value| value as f32).collect()
    }
}

#[cfg(test)]
mod tests;
