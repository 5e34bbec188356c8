//! Depth and labels predicted from what policy and critics are computed from (Mirowski et al. 2017,
//! arXiv 1611.03673; Jaderberg et al. 2017, arXiv 1611.05397): a loss that says something of every
//! frame, while rewards and costs are rare.
//!
//! A linear head behind the recurrent layer says of each cell of a coarse grid over the picture how
//! far it is, in bands, and which group of things it shows most of. The loss is the mean cross
//! entropy of the cells. Nothing acts by the head, and an agent is handed on without it.

use hasard_envs::insight::CELLS;

use crate::learning::metrics::Means;
use crate::networks::cpu::elementwise::exponential;
use crate::sampling::auxiliary::Auxiliary;

impl Auxiliary {
    /// The weighted loss of rows of the head's outputs and its gradient in them. `targets` has the
    /// classes of each row's cells.
    #[must_use]
    pub fn loss(self, outputs: &[f32], targets: &[u8], means: &mut Means) -> (f64, Vec<f32>) {
        let mut gradient = vec![0.0; outputs.len()];
        let width = self.outputs();
        let rows = outputs.len() / width.max(1);
        let cells = targets.len() / rows.max(1);
        let (mut total, mut first, mut first_cell) = (0.0, 0, 0);
        for (name, weight, classes) in self.classes() {
            let factor = (weight / (rows * CELLS) as f64) as f32;
            let mut sum = 0.0;
            for row in 0..rows {
                let own = row * width + first..row * width + first + CELLS * classes;
                let said = outputs[own.clone()].chunks_exact(classes);
                let slopes = gradient[own].chunks_exact_mut(classes);
                let targets = &targets[row * cells + first_cell..][..CELLS];
                for ((said, slopes), &target) in said.zip(slopes).zip(targets) {
                    sum += f64::from(cross_entropy(said, usize::from(target), factor, slopes));
                }
            }
            let mean = sum / (rows * CELLS).max(1) as f64;
            means.add(name, mean);
            total += weight * mean;
            (first, first_cell) = (first + CELLS * classes, first_cell + CELLS);
        }
        (total, gradient)
    }
}

/// Minus the logarithm of the probability of a class; its gradient times a factor.
fn cross_entropy(said: &[f32], target: usize, factor: f32, slopes: &mut [f32]) -> f32 {
    let largest = said.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let mut sum = 0.0;
    for (slope, logit) in slopes.iter_mut().zip(said) {
        *slope = exponential(logit - largest);
        sum += *slope;
    }
    slopes.iter_mut().for_each(|slope| *slope *= factor / sum);
    slopes[target] -= factor;
    libm::logf(sum) - (said[target] - largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the definition, minus the mean logarithm of the softmax of the right class (64
    /// bits), and its central differences; of one prediction and of both.
    #[test]
    fn the_loss_is_the_cross_entropy_and_its_gradient_that_of_differences() {
        for (depth, labels) in [(0.5, 0.0), (0.0, 2.0), (0.3, 0.7)] {
            let auxiliary = Auxiliary { depth, labels };
            let kinds: Vec<(f64, usize)> = [(depth, 8), (labels, 11)]
                .into_iter()
                .filter(|(weight, _)| *weight > 0.0)
                .collect();
            let width: usize = kinds.iter().map(|(_, classes)| 32 * classes).sum();
            assert_eq!(auxiliary.outputs(), width);
            let outputs: Vec<f32> =
                (0..2 * width).map(|index| 3.0 * (index as f32 * 1.7).sin()).collect();
            let targets: Vec<u8> = (0..2)
                .flat_map(|row| {
                    kinds.iter().flat_map(move |(_, classes)| {
                        (0..32).map(move |cell| ((row + 3 * cell) % classes) as u8)
                    })
                })
                .collect();
            let plain = |outputs: &[f64]| -> f64 {
                let (mut at, mut cell, mut sum) = (0, 0, 0.0);
                for _row in 0..2 {
                    for &(weight, classes) in &kinds {
                        for _cell in 0..32 {
                            let logits = &outputs[at..at + classes];
                            let all: f64 = logits.iter().map(|logit| logit.exp()).sum();
                            let right = logits[usize::from(targets[cell])].exp() / all;
                            sum -= weight * right.ln() / 64.0;
                            (at, cell) = (at + classes, cell + 1);
                        }
                    }
                }
                sum
            };
            let wide: Vec<f64> = outputs.iter().map(|&value| f64::from(value)).collect();
            let mut means = Means::default();
            let (value, gradient) = auxiliary.loss(&outputs, &targets, &mut means);
            assert!((value - plain(&wide)).abs() < 1e-5, "{value} against {}", plain(&wide));
            for index in (0..outputs.len()).step_by(7) {
                let moved = |by: f64| {
                    let mut wide = wide.clone();
                    wide[index] += by;
                    plain(&wide)
                };
                let expected = (moved(1e-4) - moved(-1e-4)) / 2e-4;
                let found = f64::from(gradient[index]);
                assert!((found - expected).abs() < 1e-6, "{index}: {found} against {expected}");
            }
        }
    }
}
