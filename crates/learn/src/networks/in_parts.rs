//! A network that computes large batches part by part, so that memory does not grow with the
//! rollout.

use std::ops::Range;

use crate::networks::network::{LearningNetwork, NetworkWeights, Sequences};
use crate::networks::pixels::PixelScale;
use crate::networks::shape::NetworkShape;

/// A network of which at most so many rows are computed at once. Of a batch of several parts no
/// activations are kept: its backward pass computes each part anew, a third more arithmetic, and
/// sums the parts' gradients in their order. What is computed follows from the batch alone,
/// whatever the number of threads.
pub struct InParts {
    own: Box<dyn LearningNetwork>,
    most_rows: usize,
}

impl InParts {
    /// The network with a bound on its rows.
    #[must_use]
    pub fn new(own: Box<dyn LearningNetwork>, most_rows: usize) -> InParts {
        InParts { own, most_rows }
    }

    /// The lanes of each part; a part is one lane at least.
    fn parts(&self, batch: &Sequences<'_>) -> Vec<Range<usize>> {
        let each = (self.most_rows / batch.steps.max(1)).max(1);
        (0..batch.lanes).step_by(each).map(|first| first..(first + each).min(batch.lanes)).collect()
    }
}

/// Rows, `width` numbers each, of some lanes.
fn rows_of(batch: &Sequences<'_>, lanes: &[usize], rows: &[f32], width: usize) -> Vec<f32> {
    batch.rows_of(lanes).flat_map(|row| &rows[row * width..(row + 1) * width]).copied().collect()
}

impl LearningNetwork for InParts {
    fn shape(&self) -> &NetworkShape {
        self.own.shape()
    }

    fn load(&mut self, parameters: &[f32]) {
        self.own.load(parameters);
    }

    fn load_pixels(&mut self, pixels: &PixelScale) {
        self.own.load_pixels(pixels);
    }

    fn publish(&self) -> NetworkWeights {
        self.own.publish()
    }

    fn forward(&mut self, batch: &Sequences<'_>) -> Vec<f32> {
        let parts = self.parts(batch);
        if parts.len() <= 1 {
            return self.own.forward(batch);
        }
        let width = self.own.shape().outputs();
        let mut rows = vec![0.0; batch.rows() * width];
        for part in parts {
            let lanes: Vec<usize> = part.collect();
            let outputs = self.own.forward(&batch.part(self.own.shape(), &lanes));
            for (row, from) in batch.rows_of(&lanes).zip(outputs.chunks_exact(width)) {
                rows[row * width..(row + 1) * width].copy_from_slice(from);
            }
        }
        rows
    }

    fn backward(&mut self, batch: &Sequences<'_>, output_gradient: &[f32], gradient: &mut [f32]) {
        let parts = self.parts(batch);
        if parts.len() <= 1 {
            return self.own.backward(batch, output_gradient, gradient);
        }
        let width = self.own.shape().outputs();
        gradient.fill(0.0);
        let mut some = vec![0.0; gradient.len()];
        for part in parts {
            let lanes: Vec<usize> = part.collect();
            let own = batch.part(self.own.shape(), &lanes);
            let _ = self.own.forward(&own);
            self.own.backward(&own, &rows_of(batch, &lanes, output_gradient, width), &mut some);
            gradient.iter_mut().zip(&some).for_each(|(sum, some)| *sum += some);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algorithms::small;
    use crate::config::AlgorithmKind;
    use crate::networks::cpu::network::CpuLearner;
    use hasard_engine::simd::Simd;

    /// A5: outputs bit for bit, gradients but for the order of their sums, for parts of one lane,
    /// of some, and of three of four.
    #[test]
    fn parts_have_the_outputs_and_the_gradient_of_the_whole() {
        let (mut learner, rollout) = small::learner(&small::config(AlgorithmKind::PpoLag));
        let prepared = learner.prepare(&rollout);
        let minibatch = learner.minibatch(&prepared, &[0, 1, 2, 3]);
        let shape = &learner.shape().networks[0];
        let mut batch = minibatch.batch.sequences.clone();
        batch.initial_state =
            (0..4 * shape.state_size()).map(|index| (index as f32).sin()).collect();
        batch.reset[5] = true;
        let network =
            || -> Box<dyn LearningNetwork> { Box::new(CpuLearner::new(Simd::PLAIN, shape, 1)) };
        let run = |mut network: Box<dyn LearningNetwork>| {
            network.load(&learner.parameters);
            network.load_pixels(&learner.pixels.scale());
            let outputs = network.forward(&batch);
            let weights: Vec<f32> =
                (0..outputs.len()).map(|index| (index as f32 * 0.3).cos()).collect();
            let mut gradient = vec![7.0; learner.parameters.len()];
            network.backward(&batch, &weights, &mut gradient);
            (outputs, gradient)
        };
        let (outputs, gradient) = run(network());
        for most_rows in [1, 6, 9, 12] {
            let (found, summed) = run(Box::new(InParts::new(network(), most_rows)));
            assert_eq!(found, outputs, "parts of {most_rows} rows");
            let largest = gradient.iter().fold(0.0f32, |most, value| most.max(value.abs()));
            assert!(
                gradient.iter().zip(&summed).all(|(a, b)| (a - b).abs() < 1e-5 * largest),
                "parts of {most_rows} rows"
            );
        }
    }
}
