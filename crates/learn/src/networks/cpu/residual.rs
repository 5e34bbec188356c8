//! The residual encoder (Espeholt et al. 2018, arXiv 1802.01561, figure 3, right), an image at a
//! time.
//!
//! A stage is a convolution, a pooling, and two blocks which add to an image what two convolutions
//! make of it, a rectifier before each. Nothing is kept for the backward pass: it computes an
//! image's activations again, a quarter of the work, where those of one 128x72 image would take 1.7
//! MB.

use crate::networks::PixelScale;
use crate::networks::cpu::buffers::sized;
use crate::networks::cpu::convolution::{Rounded, Stored};
use crate::networks::cpu::elementwise::add_column_sums;
use crate::networks::cpu::pixels::StoredImage;
use crate::networks::cpu::rectified::{
    add_biased, bias_rectified_scatter, gather, pool, pool_backward, rectified_backward_add,
    rectified_backward_gather, rectified_scatter, scatter,
};
use crate::networks::cpu::weights::{Backward, PackedWeights, Plan};
use crate::networks::layers::STAGE;

/// Convolutions of a stage that begin a block.
const BLOCKS: [usize; 2] = [1, 3];

/// Buffers of an image on its way through the encoder and back.
#[derive(Default)]
pub struct ResidualImage {
    image: StoredImage,
    rounded: Rounded,
    /// Input of each convolution but the first in its layout, zero around the image.
    stored: Vec<Vec<f32>>,
    raw: Vec<f32>,
    /// What flows past the blocks, or its gradient.
    flow: Vec<f32>,
    /// For each stage and pooled value, which of the nine pixels it was taken from.
    largest: Vec<Vec<u8>>,
    /// Gradient of each convolution's sums, zero around the pixels that exist.
    sums: Vec<Vec<f32>>,
    /// Gradient of a convolution's stored input.
    received: Vec<f32>,
}

impl ResidualImage {
    /// Computes the features of an image.
    pub fn forward(
        &mut self,
        plan: &Plan,
        weights: &PackedWeights,
        pixels: &PixelScale,
        observation: &[u8],
        features: &mut [f32],
    ) {
        self.run(plan, weights, pixels, observation);
        features.iter_mut().zip(&self.flow).for_each(|(to, from)| *to = from.max(0.0));
    }

    /// Computes what flows out of the last stage, a rectifier before the features.
    fn run(
        &mut self,
        plan: &Plan,
        weights: &PackedWeights,
        pixels: &PixelScale,
        observation: &[u8],
    ) {
        let kernels = plan.kernels;
        self.stored.resize_with(plan.convolutions.len(), Vec::new);
        for (stored, convolution) in self.stored.iter_mut().zip(&plan.convolutions).skip(1) {
            sized(stored, convolution.stored);
        }
        self.largest.resize_with(plan.shape.residual.len(), Vec::new);
        let first = &plan.convolutions[0];
        self.image.store(kernels, plan.shape.image, first, observation, pixels);
        for (stage, &channels) in plan.shape.residual.iter().enumerate() {
            let first = stage * STAGE;
            self.convolve(plan, weights, first);
            let image = plan.layers[first].output;
            let flow = sized(&mut self.flow, image.pooled().size());
            let (convolution, largest) = (&plan.convolutions[first], &mut self.largest[stage]);
            largest.resize(flow.len(), 0);
            pool(
                kernels,
                &self.raw,
                image,
                &convolution.raw_places,
                &weights.convolution_biases[first],
                flow,
                largest,
            );
            for one in BLOCKS.map(|part| first + part) {
                let flow = &self.flow[..image.pooled().size()];
                rectified_scatter(
                    kernels,
                    flow,
                    channels,
                    &plan.convolutions[one].places,
                    &mut self.stored[one],
                );
                self.convolve(plan, weights, one);
                let (from, to) =
                    (&plan.convolutions[one].raw_places, &plan.convolutions[one + 1].places);
                let bias = &weights.convolution_biases[one];
                bias_rectified_scatter(
                    kernels,
                    &self.raw,
                    from,
                    bias,
                    to,
                    &mut self.stored[one + 1],
                );
                self.convolve(plan, weights, one + 1);
                let (from, bias) =
                    (&plan.convolutions[one + 1].raw_places, &weights.convolution_biases[one + 1]);
                add_biased(kernels, &self.raw, from, bias, &mut self.flow[..image.pooled().size()]);
            }
            if let Some(next) = plan.convolutions.get(first + STAGE) {
                let flow = &self.flow[..image.pooled().size()];
                scatter(flow, channels, &next.places, &mut self.stored[first + STAGE]);
            }
        }
    }

    /// The raw result of a convolution of what is stored for it.
    fn convolve(&mut self, plan: &Plan, weights: &PackedWeights, layer: usize) {
        let convolution = &plan.convolutions[layer];
        let raw = sized(&mut self.raw, convolution.raw_size());
        let stored = if layer == 0 {
            self.image.latest(plan.kernels)
        } else {
            Stored::Numbers(&self.stored[layer])
        };
        convolution.forward(stored, &weights.convolutions[layer], &mut self.rounded, raw);
    }

    /// Adds the gradients of weights, in the order of the stored inputs, and biases of each
    /// convolution for one image, from the gradient of its features.
    #[allow(clippy::too_many_arguments, reason = "the pieces of a pass")]
    pub fn add_gradients(
        &mut self,
        plan: &Plan,
        weights: &PackedWeights,
        back: &Backward,
        pixels: &PixelScale,
        observation: &[u8],
        feature_gradient: &[f32],
        layers: &mut [(Vec<f32>, Vec<f32>)],
    ) {
        let kernels = plan.kernels;
        self.run(plan, weights, pixels, observation);
        self.sums.resize_with(plan.convolutions.len(), Vec::new);
        for (sums, convolution) in self.sums.iter_mut().zip(&plan.convolutions) {
            sized(sums, convolution.gradient_size());
        }
        for (flow, gradient) in self.flow.iter_mut().zip(feature_gradient) {
            *flow = if *flow > 0.0 { *gradient } else { 0.0 };
        }
        for (stage, &channels) in plan.shape.residual.iter().enumerate().rev() {
            let first = stage * STAGE;
            let size = plan.layers[first].output.pooled().size();
            for one in BLOCKS.map(|part| first + part).into_iter().rev() {
                let (before, after) = (&plan.convolutions[one], &plan.convolutions[one + 1]);
                scatter(
                    &self.flow[..size],
                    channels,
                    &after.gradient_places,
                    &mut self.sums[one + 1],
                );
                self.descend(plan, back, one + 1, layers);
                let (places, targets) = (&after.places, &before.gradient_places);
                let sums = &mut self.sums[one];
                rectified_backward_gather(
                    kernels,
                    &self.received,
                    &self.stored[one + 1],
                    places,
                    channels,
                    targets,
                    sums,
                );
                self.descend(plan, back, one, layers);
                let flow = &mut self.flow[..size];
                rectified_backward_add(
                    kernels,
                    &self.received,
                    &self.stored[one],
                    &before.places,
                    channels,
                    flow,
                );
            }
            let (image, targets) =
                (plan.layers[first].output, &plan.convolutions[first].gradient_places);
            self.sums[first].fill(0.0);
            pool_backward(
                kernels,
                &self.flow[..size],
                image,
                &self.largest[stage],
                channels,
                targets,
                &mut self.sums[first],
            );
            self.descend(plan, back, first, layers);
            if stage > 0 {
                let image = plan.layers[first].image;
                let flow = sized(&mut self.flow, image.size());
                gather(&self.received, &plan.convolutions[first].places, image.channels, flow);
            }
        }
    }

    /// From the gradient of a convolution's sums to those of its parameters and, but for the first,
    /// of its stored input.
    fn descend(
        &mut self,
        plan: &Plan,
        back: &Backward,
        layer: usize,
        layers: &mut [(Vec<f32>, Vec<f32>)],
    ) {
        let convolution = &plan.convolutions[layer];
        let sums = &self.sums[layer][..convolution.gradient_size()];
        let (weights, biases) = &mut layers[layer];
        add_column_sums(plan.kernels, sums, biases);
        let stored = if layer == 0 {
            self.image.latest(plan.kernels)
        } else {
            Stored::Numbers(&self.stored[layer])
        };
        convolution.weight_gradient(stored, sums, &mut self.rounded, weights);
        if layer > 0 {
            let received = sized(&mut self.received, convolution.stored);
            convolution.input_gradient(
                sums,
                &back.convolutions[layer],
                &mut self.rounded,
                received,
            );
        }
    }
}
