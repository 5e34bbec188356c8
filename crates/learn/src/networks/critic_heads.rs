//! Value heads that see privileged inputs.
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
}

impl CriticHeads {
    /// Numbers of a row once each value is one.
    #[must_use]
    pub fn columns(self) -> usize {
        self.policy + (self.outputs - self.policy) / (1 + self.inputs)
    }

    /// Outputs of each value.
    fn heads(self) -> impl Iterator<Item = Range<usize>> {
        (self.policy..self.outputs)
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

    /// The gradient of the network's outputs from that of the rows.
    #[must_use]
    pub fn spread(self, rows: &[f32], privileged: &[f32]) -> Vec<f32> {
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
        let heads = CriticHeads { policy: 2, outputs: 8, inputs: 2 };
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
        let gradient = heads.spread(&weights, &privileged);
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
}
