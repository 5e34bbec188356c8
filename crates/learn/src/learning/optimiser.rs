//! The optimiser.

use crate::config::LearningConfig;
use crate::learning::muon::{self, Block};
use crate::networks::cpu::elementwise::{AdamStep, adam};
use crate::threads::{Piece, in_parallel, pieces};
use hasard_engine::simd::Simd;

/// Adam (Kingma and Ba 2015) over a flat parameter vector, but for the blocks that Muon steps.
#[derive(Clone, PartialEq, Debug)]
pub struct Adam {
    /// Moving average of gradients.
    pub first: Vec<f32>,
    /// Moving average of their squares; none in the blocks.
    pub second: Vec<f32>,
    /// Steps so far.
    pub steps: u64,
    /// What Muon steps, in the order of their places.
    blocks: Vec<Block>,
}

impl Adam {
    /// An optimiser that has made no step.
    #[must_use]
    pub fn new(parameters: usize, blocks: Vec<Block>) -> Adam {
        Adam { first: vec![0.0; parameters], second: vec![0.0; parameters], steps: 0, blocks }
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
        let of_matrices = muon::Step {
            gradient_scale: scale as f32,
            beta: beta1 as f32,
            size: (rate * settings.muon_scale) as f32,
        };
        // Every parameter is its own; stretches go to threads because the pass is bound by memory.
        let stretch = parameters.len().div_ceil(pieces(settings.threads)).max(1 << 16);
        let mut work: Vec<Piece<'_, muon::Scratch>> = Vec::new();
        let mut at = 0;
        let mut rest = [&mut self.first[..], &mut self.second[..], parameters];
        for block in self.blocks.iter().map(Some).chain([None]) {
            let start = block.map_or(gradient.len(), |block| block.range.start);
            let [first, second, parameters] = take(&mut rest, start - at);
            let parts = gradient[at..start]
                .chunks(stretch)
                .zip(first.chunks_mut(stretch))
                .zip(second.chunks_mut(stretch))
                .zip(parameters.chunks_mut(stretch));
            for (((gradient, first), second), parameters) in parts {
                work.push(Box::new(move |_| {
                    adam(kernels, step, gradient, first, second, parameters);
                }));
            }
            let Some(block) = block else { break };
            let [momentum, _, parameters] = take(&mut rest, block.range.len());
            let gradient = &gradient[block.range.clone()];
            at = block.range.end;
            work.push(Box::new(move |scratch| {
                muon::step(kernels, block, of_matrices, gradient, momentum, parameters, scratch);
            }));
        }
        let threads = settings.threads.max(1);
        let mut scratch: Vec<muon::Scratch> = Vec::new();
        scratch.resize_with(threads, muon::Scratch::default);
        in_parallel(&mut scratch, work);
    }
}

/// The first so many of each, off the rest.
fn take<'a>(rest: &mut [&'a mut [f32]; 3], length: usize) -> [&'a mut [f32]; 3] {
    rest.each_mut().map(|slice| {
        let (taken, left) = std::mem::take(slice).split_at_mut(length);
        *slice = left;
        taken
    })
}
