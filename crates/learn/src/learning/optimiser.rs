//! The optimiser.

use crate::config::LearningConfig;
use crate::networks::cpu::elementwise::{AdamStep, adam};
use crate::threads::{in_parallel, pieces};
use hasard_engine::simd::Simd;

/// Adam (Kingma and Ba 2015) over a flat parameter vector.
#[derive(Clone, PartialEq, Debug)]
pub struct Adam {
    /// Moving average of gradients.
    pub first: Vec<f32>,
    /// Moving average of their squares.
    pub second: Vec<f32>,
    /// Steps so far.
    pub steps: u64,
}

impl Adam {
    /// An optimiser that has made no step.
    #[must_use]
    pub fn new(parameters: usize) -> Adam {
        Adam { first: vec![0.0; parameters], second: vec![0.0; parameters], steps: 0 }
    }

    /// One step down `gradient * scale`.
    pub fn step(
        &mut self,
        kernels: Simd,
        gradient: &[f32],
        parameters: &mut [f32],
        scale: f64,
        rate: f64,
        settings: &LearningConfig,
    ) {
        self.steps += 1;
        let (beta1, beta2) = settings.adam_betas;
        let power = self.steps.min(i32::MAX as u64) as i32;
        let step = AdamStep {
            gradient_scale: scale as f32,
            rate: (rate / (1.0 - beta1.powi(power))) as f32,
            second_scale: (1.0 / (1.0 - beta2.powi(power)).sqrt()) as f32,
            beta1: beta1 as f32,
            beta2: beta2 as f32,
            epsilon: settings.adam_epsilon as f32,
        };
        // Every parameter is its own; stretches go to threads because the pass is bound by memory.
        let stretch = parameters.len().div_ceil(pieces(settings.threads)).max(1 << 16);
        let parts = gradient
            .chunks(stretch)
            .zip(self.first.chunks_mut(stretch))
            .zip(self.second.chunks_mut(stretch))
            .zip(parameters.chunks_mut(stretch));
        let work = parts.map(|(((gradient, first), second), parameters)| {
            move |_: &mut ()| adam(kernels, step, gradient, first, second, parameters)
        });
        in_parallel(&mut vec![(); settings.threads.max(1)], work);
    }
}
