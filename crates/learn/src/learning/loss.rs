//! Losses: means over the samples of formulas in what the networks say, with their gradients in the
//! networks' outputs.
//!
//! Three steps of the chain rule, each of which can be read alone: an algorithm writes its loss of
//! a sample in [`DualNumber`] numbers; policy and critics know how their numbers change with the
//! outputs ([`Column`]); the networks know how their outputs change with the parameters.

use std::ops::{Add, Mul};

use crate::learning::dual_number::DualNumber;
use crate::learning::minibatch::Minibatch;
use crate::learning::policy::{Column, Policy};
use crate::networks::ModelShape;

/// What the networks say about a minibatch.
pub struct Heads {
    /// The policy.
    pub policy: Policy,
    /// Logarithm of the probability of the actions taken.
    pub log_probability: Column,
    /// Probability of the actions taken over that when they were taken.
    pub ratio: Column,
    /// Value of each critic.
    pub values: Vec<Column>,
    /// Length of an output row.
    width: usize,
}

impl Heads {
    /// Reads output rows: the policy's numbers, followed by a value of each critic that is there.
    #[must_use]
    pub fn new(
        shape: &ModelShape,
        outputs: &[f32],
        width: usize,
        minibatch: &Minibatch<'_>,
    ) -> Heads {
        let policy = Policy::new(&shape.action, outputs, width);
        let log_probability = policy.log_probability(&minibatch.taken);
        let ratio =
            log_probability.map(|row, log| (log - minibatch.old_log_probability[row]).exp());
        let values = (shape.value_column()..width)
            .map(|column| Column::of_output(outputs, width, column))
            .collect();
        Heads { policy, log_probability, ratio, values, width }
    }

    /// The mean over all samples of a formula, given the sample's row and the numbers that it
    /// depends on.
    #[must_use]
    pub fn mean<const N: usize>(
        &self,
        columns: [&Column; N],
        formula: impl Fn(usize, [DualNumber<N>; N]) -> DualNumber<N>,
    ) -> Loss {
        let rows = self.policy.rows();
        let mut loss = Loss { value: 0.0, gradient: vec![0.0; rows * self.width] };
        for (row, gradient) in loss.gradient.chunks_exact_mut(self.width).enumerate() {
            let sample = formula(
                row,
                std::array::from_fn(|i| DualNumber::variable(columns[i].values[row], i)),
            );
            loss.value += sample.value / rows as f64;
            for (column, slope) in columns.iter().zip(sample.slopes) {
                column.add_slopes(row, slope / rows as f64, gradient);
            }
        }
        loss
    }

    /// The mean of a column.
    #[must_use]
    pub fn mean_of(&self, column: &Column) -> Loss {
        self.mean([column], |_, [number]| number)
    }
}

/// A number that depends on the networks' outputs, and its gradient in them, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Loss {
    /// The loss itself.
    pub value: f64,
    /// Its gradient.
    pub gradient: Vec<f64>,
}

impl Loss {
    /// The gradient as networks take it.
    #[must_use]
    pub fn rows(&self) -> Vec<f32> {
        self.gradient.iter().map(|&value| value as f32).collect()
    }

    /// The number if it is positive, and zero, whatever the outputs, if it is not.
    #[must_use]
    pub fn positive_part(self) -> Loss {
        if self.value > 0.0 { self } else { self * 0.0 }
    }

    /// At most so much; beyond it the outputs do not matter.
    #[must_use]
    pub fn at_most(self, most: f64) -> Loss {
        if self.value <= most { self } else { self * 0.0 + most }
    }
}

impl Add for Loss {
    type Output = Loss;

    fn add(mut self, other: Loss) -> Loss {
        self.value += other.value;
        self.gradient.iter_mut().zip(&other.gradient).for_each(|(own, other)| *own += other);
        self
    }
}

impl Add<f64> for Loss {
    type Output = Loss;

    fn add(mut self, number: f64) -> Loss {
        self.value += number;
        self
    }
}

impl Mul<f64> for Loss {
    type Output = Loss;

    fn mul(mut self, number: f64) -> Loss {
        self.value *= number;
        self.gradient.iter_mut().for_each(|value| *value *= number);
        self
    }
}
