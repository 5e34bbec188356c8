//! Value heads that see privileged inputs, and a head that predicts what the picture shows.
//!
//! Such a head has a linear output more for each input x_i, and the value is out_0 + sum(x_i
//! out_i): linear in the inputs with slopes that the network finds in what it sees, such as a rate
//! of cost, to be multiplied by the time left. Neither the policy nor the layers that it shares
//! with the critics see an input.

use std::ops::Range;

/// Which of a network's outputs are values, and what becomes of them.
#[derive(Clone, Copy, Debug)]
pub struct CriticHeads {
    /// Outputs that are the policy's: they come first and stay as they are.
    pub policy: usize,
    /// All outputs of the network.
    pub outputs: usize,
    /// Privileged inputs of a row.
    pub inputs: usize,
    /// Outputs behind all others, which are predictions and no values.
    pub auxiliary: usize,
}

impl CriticHeads {
    /// Whether the outputs are rows as they are.
    #[must_use]
    pub const fn are_plain(self) -> bool {
        self.inputs == 0 && self.auxiliary == 0
    }

    /// Numbers of a row once each value is one.
    #[must_use]
    pub fn columns(self) -> usize {
        self.policy + (self.outputs - self.auxiliary - self.policy) / (1 + self.inputs)
    }

    /// What the outputs predict, row by row.
    #[must_use]
    pub fn predicted(self, outputs: &[f32]) -> Vec<f32> {
        let rows = outputs.chunks_exact(self.outputs);
        rows.flat_map(|row| &row[self.outputs - self.auxiliary..]).copied().collect()
    }

    /// Outputs of each value.
    fn heads(self) -> impl Iterator<Item = Range<usize>> {
        (self.policy..self.outputs - self.auxiliary)
            .step_by(1 + self.inputs)
            .map(move |first| first..first + 1 + self.inputs)
    }

    /// Rows of policy and values from the network's outputs.
    pub fn combine(self, outputs: &[f32], privileged: &[f32], rows: &mut [f32]) {
        let width = self.columns();
        for (index, (out, row)) in
            outputs.chunks_exact(self.outputs).zip(rows.chunks_exact_mut(width)).enumerate()
        {
            let inputs = &privileged[index * self.inputs..(index + 1) * self.inputs];
            row[..self.policy].copy_from_slice(&out[..self.policy]);
            for (value, head) in row[self.policy..].iter_mut().zip(self.heads()) {
                let (first, slopes) = out[head].split_first().expect("a head has an output");
                *value = inputs
                    .iter()
                    .zip(slopes)
                    .fold(*first, |sum, (input, slope)| sum + input * slope);
            }
        }
    }

    /// The gradient of the network's outputs from that of the rows, and that of what they predict.
    #[must_use]
    pub fn spread(self, rows: &[f32], privileged: &[f32], predicted: &[f32]) -> Vec<f32> {
        let width = self.columns();
        let mut gradient = vec![0.0; rows.len() / width * self.outputs];
        for (index, (out, row)) in
            gradient.chunks_exact_mut(self.outputs).zip(rows.chunks_exact(width)).enumerate()
        {
            let inputs = &privileged[index * self.inputs..(index + 1) * self.inputs];
            out[..self.policy].copy_from_slice(&row[..self.policy]);
            for (&value, head) in row[self.policy..].iter().zip(self.heads()) {
                let (first, slopes) = out[head].split_first_mut().expect("a head has an output");
                *first = value;
                slopes.iter_mut().zip(inputs).for_each(|(slope, input)| *slope = value * input);
            }
            if !predicted.is_empty() {
                let own = &predicted[index * self.auxiliary..(index + 1) * self.auxiliary];
                out[self.outputs - self.auxiliary..].copy_from_slice(own);
            }
        }
        gradient
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A11: values are linear in the inputs, and the gradient is that of the sum of products, by
    /// central differences.
    #[test]
    fn gradients_of_values_equal_differences_and_the_policy_sees_nothing() {
        let heads = CriticHeads { policy: 2, outputs: 8, inputs: 2, auxiliary: 0 };
        assert_eq!(heads.columns(), 4);
        let outputs: Vec<f32> = (0..16).map(|index| (index as f32 * 0.7).sin()).collect();
        let privileged = [0.5, -1.0, -0.25, 2.0];
        let rows = |outputs: &[f32], privileged: &[f32]| {
            let mut rows = vec![0.0; 8];
            heads.combine(outputs, privileged, &mut rows);
            rows
        };
        let found = rows(&outputs, &privileged);
        assert_eq!(found[..2], outputs[..2]);
        assert!((found[2] - (outputs[2] + 0.5 * outputs[3] - outputs[4])).abs() < 1e-6);
        assert!((found[7] - (outputs[13] - 0.25 * outputs[14] + 2.0 * outputs[15])).abs() < 1e-6);
        assert_eq!(
            rows(&outputs, &[9.0; 4])[4..6],
            found[4..6],
            "the policy's outputs of the second row"
        );
        let weights: Vec<f32> = (0..8).map(|index| (index as f32).cos()).collect();
        let gradient = heads.spread(&weights, &privileged, &[]);
        for index in 0..16 {
            let moved = |by: f32| {
                let mut outputs = outputs.clone();
                outputs[index] += by;
                rows(&outputs, &privileged)
                    .iter()
                    .zip(&weights)
                    .map(|(row, weight)| f64::from(row * weight))
                    .sum::<f64>()
            };
            let expected = (moved(0.25) - moved(-0.25)) / 0.5;
            assert!(
                (f64::from(gradient[index]) - expected).abs() < 1e-5,
                "{index}: {} against {expected}",
                gradient[index]
            );
        }
    }

    /// What is predicted stands behind all else, is in no row, and has its own gradient.
    #[test]
    fn predictions_stand_apart() {
        let plain = CriticHeads { policy: 2, outputs: 4, inputs: 0, auxiliary: 0 };
        let heads = CriticHeads { outputs: 7, auxiliary: 3, ..plain };
        assert!(plain.are_plain() && !heads.are_plain() && heads.columns() == 4);
        let outputs: Vec<f32> = (0..14u8).map(f32::from).collect();
        let mut rows = vec![0.0; 8];
        heads.combine(&outputs, &[], &mut rows);
        assert_eq!(rows, [0.0, 1.0, 2.0, 3.0, 7.0, 8.0, 9.0, 10.0]);
        assert_eq!(heads.predicted(&outputs), [4.0, 5.0, 6.0, 11.0, 12.0, 13.0]);
        let spread = heads.spread(&rows, &[], &heads.predicted(&outputs));
        assert_eq!(spread, outputs);
        assert_eq!(heads.spread(&rows, &[], &[])[4..7], [0.0; 3]);
    }
}
