//! The backward pass through the convolutions, image by image, gathering the gradients of their
//! weights.

use crate::networks::PixelScale;
use crate::networks::cpu::buffers::sized;
use crate::networks::cpu::convolution::{ConvolutionPlan, Rounded, Stored};
use crate::networks::cpu::elementwise::{add, add_column_sums, elu_backward_gather};
use crate::networks::cpu::forward::output_places;
use crate::networks::cpu::pixels::StoredImage;
use crate::networks::cpu::residual::ResidualImage;
use crate::networks::cpu::tape::TapeLane;
use crate::networks::cpu::weights::{Backward, PackedWeights, Plan};

/// Gradients of the convolutions' weights and biases over some lanes, weights in the order of the
/// stored inputs.
#[derive(Default)]
pub struct EncoderGradient {
    layers: Vec<(Vec<f32>, Vec<f32>)>,
}

/// Buffers of the pass, one set a thread.
#[derive(Default)]
pub struct Scratch {
    image: StoredImage,
    rounded: Rounded,
    residual: ResidualImage,
    /// Gradient of each layer's sums, zero around the pixels that exist.
    padded: Vec<Vec<f32>>,
    /// Gradient of each layer's input.
    stored: Vec<Vec<f32>>,
}

impl Scratch {
    /// Makes room for a plan.
    pub fn prepare(&mut self, plan: &Plan) {
        let layers = if plan.shape.residual.is_empty() { plan.convolutions.len() } else { 0 };
        self.padded.resize_with(layers, Vec::new);
        self.stored.resize_with(layers, Vec::new);
        for (layer, convolution) in plan.convolutions.iter().take(layers).enumerate() {
            sized(&mut self.padded[layer], convolution.gradient_size()).fill(0.0);
            sized(&mut self.stored[layer], if layer > 0 { convolution.stored } else { 0 });
        }
    }
}

impl EncoderGradient {
    /// Forgets what was gathered.
    pub fn clear(&mut self, plan: &Plan) {
        self.layers.resize_with(plan.convolutions.len(), Default::default);
        for ((weights, biases), convolution) in self.layers.iter_mut().zip(&plan.convolutions) {
            sized(weights, convolution.depth() * convolution.channels()).fill(0.0);
            sized(biases, convolution.channels()).fill(0.0);
        }
    }

    /// Adds the gradients of one lane, from those of its features.
    #[allow(clippy::too_many_arguments, reason = "the pieces of a pass")]
    pub fn add_lane(
        &mut self,
        plan: &Plan,
        weights: &PackedWeights,
        back: &Backward,
        pixels: &PixelScale,
        lane: TapeLane<'_>,
        observations: &[&[u8]],
        feature_gradient: &[f32],
        scratch: &mut Scratch,
    ) {
        let kernels = plan.kernels;
        let features = plan.features;
        let layers = plan.convolutions.len();
        if !plan.shape.residual.is_empty() {
            for (observation, d) in observations.iter().zip(feature_gradient.chunks_exact(features))
            {
                scratch.residual.add_gradients(
                    plan,
                    weights,
                    back,
                    pixels,
                    observation,
                    d,
                    &mut self.layers,
                );
            }
            return;
        }
        let places: Vec<_> = (0..layers).map(|layer| output_places(plan, layer)).collect();
        for (step, observation) in observations.iter().enumerate() {
            for layer in (0..layers).rev() {
                let convolution = &plan.convolutions[layer];
                let (weights, biases) = &mut self.layers[layer];
                let padded = &mut scratch.padded[layer][..];
                let row = |buffer, width: usize| {
                    &lane.of(buffer, width)[step * width..(step + 1) * width]
                };
                let (d, output): (&[f32], &[f32]) = match plan.convolutions.get(layer + 1) {
                    None => (
                        &feature_gradient[step * features..][..features],
                        row(&lane.tape.features, features),
                    ),
                    Some(next) => (
                        &scratch.stored[layer + 1],
                        row(&lane.tape.activations[layer], next.stored),
                    ),
                };
                let targets = &convolution.gradient_places;
                elu_backward_gather(
                    kernels,
                    d,
                    output,
                    &places[layer],
                    convolution.channels(),
                    targets,
                    padded,
                );
                add_column_sums(kernels, padded, biases);
                let stored = if layer == 0 {
                    scratch.image.store(kernels, plan.shape.image, convolution, observation, pixels)
                } else {
                    Stored::Numbers(row(&lane.tape.activations[layer - 1], convolution.stored))
                };
                convolution.weight_gradient(stored, padded, &mut scratch.rounded, weights);
                if layer > 0 {
                    let received = &mut scratch.stored[layer];
                    convolution.input_gradient(
                        padded,
                        &back.convolutions[layer],
                        &mut scratch.rounded,
                        received,
                    );
                }
            }
        }
    }

    /// Adds the gradients of a layer to those of its parameters.
    pub fn add_to(
        &self,
        layer: usize,
        convolution: &ConvolutionPlan,
        plan: &Plan,
        weights: &mut [f32],
        biases: &mut [f32],
    ) {
        let (own_weights, own_biases) = &self.layers[layer];
        convolution.unorder(own_weights, weights);
        add(plan.kernels, biases, own_biases);
    }
}
