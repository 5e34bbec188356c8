//! The forward and the backward pass of one network for some trajectories, on one thread.
//!
//! A [`Pass`] owns every buffer that it needs and reuses them; threads share nothing but the packed weights. Rows are
//! ordered by time, then by lane, so that a step of the GRU is one product over contiguous rows.

use super::convolution::ConvolutionPlan;
use super::elementwise::{
    add_column_sums, bias_elu_rows, bias_elu_scatter, bias_rows, elu_backward_gather, elu_backward_rows, gru_gates,
    gru_gates_backward, scale_pixels,
};
use super::product::{Left, Right, Size, multiply};
use super::weights::{Backward, PackedWeights, Plan};
use crate::networks::{ImageShape, Parameter, PixelScale};

/// Trajectories of one pass: rows `t * lanes + l`.
pub struct Input<'a> {
    /// Steps.
    pub steps: usize,
    /// Lanes.
    pub lanes: usize,
    /// One image a row.
    pub observations: &'a [&'a [u8]],
    /// Extra inputs of each row.
    pub extra: &'a [f32],
    /// State of each lane before the first step.
    pub initial_state: &'a [f32],
    /// Rows before which the state is zeroed; empty if none.
    pub reset: &'a [bool],
    /// How pixels enter, in the order of the first layer's stored input.
    pub pixels: &'a PixelScale,
}

/// Buffers of a pass and what the forward one leaves for the backward one.
#[derive(Default)]
pub struct Pass {
    rows: usize,
    /// Output of each convolution but the last, in the layout of the next one's input, row after row.
    activations: Vec<Vec<f32>>,
    /// Output of the last convolution, `features` a row.
    features: Vec<f32>,
    /// Output of each dense layer but the last.
    dense: Vec<Vec<f32>>,
    /// Output of the last dense layer and the extra inputs.
    core_input: Vec<f32>,
    /// Gates of the GRU, or the product of its input on their way there.
    gates: Vec<f32>,
    /// The product of the state; its third part is the candidate's share.
    share: Vec<f32>,
    /// State before each step (after resets).
    before: Vec<f32>,
    /// State after each step.
    after: Vec<f32>,
    /// Outputs, padded.
    outputs: Vec<f32>,
    scratch: Scratch,
}

#[derive(Default)]
struct Scratch {
    pixels: Vec<u8>,
    image: Vec<f32>,
    raw: Vec<f32>,
    patches: Vec<f32>,
    padded_gradient: Vec<Vec<f32>>,
    stored_gradient: Vec<Vec<f32>>,
    convolution_gradients: Vec<Vec<f32>>,
    rows_a: Vec<f32>,
    rows_b: Vec<f32>,
    carry: Vec<f32>,
    joined_heads: Vec<f32>,
    joined_biases: Vec<f32>,
}

fn sized(buffer: &mut Vec<f32>, length: usize) -> &mut [f32] {
    if buffer.len() < length {
        buffer.resize(length, 0.0);
    }
    &mut buffer[..length]
}

/// Where the pixels of each convolution's output go: into the next one's input, or row by row behind the last.
fn output_places(plan: &Plan, layer: usize) -> std::borrow::Cow<'_, [usize]> {
    match plan.convolutions.get(layer + 1) {
        Some(next) => std::borrow::Cow::Borrowed(&next.places),
        None => {
            let convolution = &plan.convolutions[layer];
            (0..convolution.raw_places.len()).map(|pixel| pixel * convolution.channels()).collect()
        }
    }
}

impl Pass {
    /// Outputs of all rows, padded to whole panels; [`Plan::padded_outputs`] a row.
    pub fn forward(&mut self, plan: &Plan, weights: &PackedWeights, input: &Input<'_>) -> &[f32] {
        let shape = &plan.shape;
        let rows = input.steps * input.lanes;
        assert_eq!(input.observations.len(), rows, "one observation a row");
        self.rows = rows;
        self.encode(plan, weights, input);
        let core_inputs = shape.core_inputs();
        for (index, &units) in shape.dense.iter().enumerate() {
            let last = index + 1 == shape.dense.len();
            let (earlier, rest) = self.dense.split_at_mut(index);
            let (from, inputs) = match earlier.last() {
                None => (&self.features, shape.features()),
                Some(before) => (before, shape.dense[index - 1]),
            };
            let (to, stride) = if last {
                (sized(&mut self.core_input, rows * core_inputs), core_inputs)
            } else {
                (sized(&mut rest[0], rows * units), units)
            };
            let size = Size { rows, columns: units, inner: inputs };
            let left = Left { data: from, row_stride: inputs, inner_stride: 1 };
            multiply(size, left, Right::panels(&weights.dense[index], inputs), to, stride, false);
            bias_elu_rows(to, stride, &weights.dense_biases[index]);
            if last && shape.extra_inputs > 0 {
                for (row, extra) in to.chunks_exact_mut(stride).zip(input.extra.chunks_exact(shape.extra_inputs)) {
                    row[units..].copy_from_slice(extra);
                }
            }
        }
        let head_inputs = shape.head_inputs();
        let core: &[f32] = match shape.recurrent {
            None => &self.core_input,
            Some(units) => {
                self.recur(units, core_inputs, weights, input);
                &self.after
            }
        };
        let outputs = sized(&mut self.outputs, rows * plan.padded_outputs);
        let size = Size { rows, columns: plan.padded_outputs, inner: head_inputs };
        let left = Left { data: core, row_stride: head_inputs, inner_stride: 1 };
        multiply(size, left, Right::panels(&weights.heads, head_inputs), outputs, plan.padded_outputs, false);
        bias_rows(outputs, &weights.head_biases);
        outputs
    }

    /// State of each lane after the last step of the last forward pass.
    #[must_use]
    pub fn final_state(&self, units: usize, lanes: usize) -> &[f32] {
        &self.after[(self.rows - lanes) * units..self.rows * units]
    }

    /// Convolutions of every row, and the features that they end in.
    fn encode(&mut self, plan: &Plan, weights: &PackedWeights, input: &Input<'_>) {
        let features = plan.shape.features();
        sized(&mut self.features, self.rows * features);
        self.activations.resize_with(plan.convolutions.len().saturating_sub(1), Vec::new);
        self.dense.resize_with(plan.shape.dense.len() - 1, Vec::new);
        let places: Vec<_> = (0..plan.convolutions.len()).map(|layer| output_places(plan, layer)).collect();
        for (row, observation) in input.observations.iter().enumerate() {
            if plan.convolutions.is_empty() {
                let to = &mut self.features[row * features..(row + 1) * features];
                scale_pixels(observation, &input.pixels.scale, &input.pixels.shift, to);
                continue;
            }
            let image = sized(&mut self.scratch.image, plan.convolutions[0].stored);
            store_pixels(plan.shape.image, &plan.convolutions[0], observation, input.pixels, &mut self.scratch.pixels, image);
            for (layer, convolution) in plan.convolutions.iter().enumerate() {
                let (earlier, rest) = self.activations.split_at_mut(layer);
                let stored: &[f32] = match earlier.last() {
                    None => &self.scratch.image,
                    Some(before) => &before[row * convolution.stored..(row + 1) * convolution.stored],
                };
                let patches = sized(&mut self.scratch.patches, convolution.patch_size());
                let raw = sized(&mut self.scratch.raw, convolution.raw_size());
                convolution.forward(stored, &weights.convolutions[layer], patches, raw);
                let to = match plan.convolutions.get(layer + 1) {
                    Some(next) => &mut sized(&mut rest[0], self.rows * next.stored)[row * next.stored..][..next.stored],
                    None => &mut self.features[row * features..(row + 1) * features],
                };
                bias_elu_scatter(raw, &convolution.raw_places, &weights.convolution_biases[layer], &places[layer], to);
            }
        }
    }

    fn recur(&mut self, units: usize, inputs: usize, weights: &PackedWeights, input: &Input<'_>) {
        let (rows, lanes) = (self.rows, input.lanes);
        let gates = sized(&mut self.gates, rows * 3 * units);
        let size = Size { rows, columns: 3 * units, inner: inputs };
        let left = Left { data: &self.core_input, row_stride: inputs, inner_stride: 1 };
        multiply(size, left, Right::panels(&weights.gru_input, inputs), gates, 3 * units, false);
        let share = sized(&mut self.share, rows * 3 * units);
        let before = sized(&mut self.before, rows * units);
        let after = sized(&mut self.after, rows * units);
        for step in 0..input.steps {
            let (first, end) = (step * lanes, (step + 1) * lanes);
            let source = if step == 0 { input.initial_state } else { &after[(first - lanes) * units..first * units] };
            let state = &mut before[first * units..end * units];
            state.copy_from_slice(source);
            for (lane, state) in state.chunks_exact_mut(units).enumerate() {
                if input.reset.get(first + lane).is_some_and(|&reset| reset) {
                    state.fill(0.0);
                }
            }
            let share = &mut share[first * 3 * units..end * 3 * units];
            let size = Size { rows: lanes, columns: 3 * units, inner: units };
            let left = Left { data: state, row_stride: units, inner_stride: 1 };
            multiply(size, left, Right::panels(&weights.gru_hidden, units), share, 3 * units, false);
            let [input_bias, state_bias] = &weights.gru_biases;
            let gates = &mut gates[first * 3 * units..end * 3 * units];
            gru_gates(gates, share, input_bias, state_bias, state, &mut after[first * units..end * units]);
        }
    }

    /// Adds to `gradient` that of the parameters, from the gradient of the (unpadded) outputs of the last forward pass.
    pub fn backward(&mut self, plan: &Plan, back: &Backward, input: &Input<'_>, output_gradient: &[f32], gradient: &mut [f32]) {
        let shape = &plan.shape;
        let rows = self.rows;
        let mut scratch = std::mem::take(&mut self.scratch);

        // Heads.
        let (outputs, padded) = (shape.outputs(), plan.padded_outputs);
        let padded_gradient = sized(&mut scratch.rows_a, rows * padded);
        for (to, from) in padded_gradient.chunks_exact_mut(padded).zip(output_gradient.chunks_exact(outputs)) {
            to[..outputs].copy_from_slice(from);
            to[outputs..].fill(0.0);
        }
        let head_inputs = shape.head_inputs();
        let core: &[f32] = if shape.recurrent.is_some() { &self.after } else { &self.core_input };
        let joined = sized(&mut scratch.joined_heads, head_inputs * padded);
        let size = Size { rows: head_inputs, columns: padded, inner: rows };
        let left = Left { data: core, row_stride: 1, inner_stride: head_inputs };
        multiply(size, left, Right::rows(padded_gradient, padded), joined, padded, false);
        let biases = sized(&mut scratch.joined_biases, padded);
        biases.fill(0.0);
        add_column_sums(padded_gradient, biases);
        let mut first = 0;
        for (index, &count) in shape.heads.iter().enumerate() {
            let parameter = plan.head(index);
            for (to, from) in gradient[parameter.range()].chunks_exact_mut(count).zip(joined.chunks_exact(padded)) {
                for (to, from) in to.iter_mut().zip(&from[first..first + count]) {
                    *to += from;
                }
            }
            for (to, from) in gradient[plan.after(parameter).range()].iter_mut().zip(&biases[first..first + count]) {
                *to += from;
            }
            first += count;
        }
        let flowing = shape.recurrent.unwrap_or(shape.core_inputs() - shape.extra_inputs);
        let from_heads = sized(&mut scratch.rows_b, rows * flowing);
        let size = Size { rows, columns: flowing, inner: padded };
        let left = Left { data: padded_gradient, row_stride: padded, inner_stride: 1 };
        multiply(size, left, Right::panels(&back.heads, padded), from_heads, flowing, false);

        if let Some(units) = shape.recurrent {
            self.recur_backward(plan, back, input, units, &mut scratch, gradient);
        }
        // Here `rows_b` holds the gradient of the last dense layer's output.
        for index in (0..shape.dense.len()).rev() {
            let units = shape.dense[index];
            let last = index + 1 == shape.dense.len();
            let parameter = plan.dense(index);
            let inputs = parameter.inputs;
            let (output, stride): (&[f32], usize) =
                if last { (&self.core_input, shape.core_inputs()) } else { (&self.dense[index], units) };
            let d = &mut scratch.rows_b[..rows * units];
            elu_backward_rows(d, units, &output[..rows * stride], stride);
            let from = if index == 0 { &self.features } else { &self.dense[index - 1] };
            add_layer_gradient(parameter, plan.after(parameter), from, inputs, d, gradient);
            if index == 0 && plan.convolutions.is_empty() {
                break;
            }
            let before = sized(&mut scratch.rows_a, rows * inputs);
            let size = Size { rows, columns: inputs, inner: units };
            let left = Left { data: d, row_stride: units, inner_stride: 1 };
            multiply(size, left, Right::panels(&back.dense[index], units), before, inputs, false);
            std::mem::swap(&mut scratch.rows_a, &mut scratch.rows_b);
        }
        if !plan.convolutions.is_empty() {
            self.encode_backward(plan, back, input, &mut scratch, gradient);
        }
        self.scratch = scratch;
    }

    /// Takes the gradient of the states after each step from `rows_b` and leaves that of the dense layer's output there.
    fn recur_backward(
        &mut self,
        plan: &Plan,
        back: &Backward,
        input: &Input<'_>,
        units: usize,
        scratch: &mut Scratch,
        gradient: &mut [f32],
    ) {
        let (rows, lanes, inputs) = (self.rows, input.lanes, plan.shape.core_inputs());
        let after = &scratch.rows_b[..rows * units];
        let carry = sized(&mut scratch.carry, lanes * units);
        carry.fill(0.0);
        for step in (0..input.steps).rev() {
            let (first, end) = (step * lanes, (step + 1) * lanes);
            super::elementwise::add(carry, &after[first * units..end * units]);
            let gates = &mut self.gates[first * 3 * units..end * 3 * units];
            let share = &mut self.share[first * 3 * units..end * 3 * units];
            gru_gates_backward(gates, share, &self.before[first * units..end * units], carry, units);
            let size = Size { rows: lanes, columns: units, inner: 3 * units };
            let left = Left { data: share, row_stride: 3 * units, inner_stride: 1 };
            multiply(size, left, Right::panels(&back.gru_hidden, 3 * units), carry, units, true);
            for (lane, carry) in carry.chunks_exact_mut(units).enumerate() {
                if input.reset.get(first + lane).is_some_and(|&reset| reset) {
                    carry.fill(0.0);
                }
            }
        }
        let [input_weights, input_bias, hidden_weights, hidden_bias] = plan.gru();
        let (gates, share) = (&self.gates[..rows * 3 * units], &self.share[..rows * 3 * units]);
        add_layer_gradient(input_weights, input_bias, &self.core_input, inputs, gates, gradient);
        add_layer_gradient(hidden_weights, hidden_bias, &self.before, units, share, gradient);
        let dense = inputs - plan.shape.extra_inputs;
        let to = sized(&mut scratch.rows_b, rows * dense);
        let size = Size { rows, columns: dense, inner: 3 * units };
        let left = Left { data: gates, row_stride: 3 * units, inner_stride: 1 };
        multiply(size, left, Right::panels(&back.gru_input, 3 * units), to, dense, false);
    }

    /// Takes the gradient of the features from `rows_b` through the convolutions.
    fn encode_backward(&mut self, plan: &Plan, back: &Backward, input: &Input<'_>, scratch: &mut Scratch, gradient: &mut [f32]) {
        let layers = plan.convolutions.len();
        let features = plan.shape.features();
        for buffers in [&mut scratch.padded_gradient, &mut scratch.stored_gradient, &mut scratch.convolution_gradients] {
            buffers.resize_with(layers, Vec::new);
        }
        for (layer, convolution) in plan.convolutions.iter().enumerate() {
            let padded = sized(&mut scratch.padded_gradient[layer], convolution.gradient_size());
            padded.fill(0.0);
            sized(&mut scratch.stored_gradient[layer], if layer > 0 { convolution.stored } else { 0 });
            let weights = convolution.depth() * convolution.channels();
            sized(&mut scratch.convolution_gradients[layer], weights).fill(0.0);
        }
        let places: Vec<_> = (0..layers).map(|layer| output_places(plan, layer)).collect();
        for (row, observation) in input.observations.iter().enumerate() {
            for layer in (0..layers).rev() {
                let convolution = &plan.convolutions[layer];
                let padded = &mut scratch.padded_gradient[layer][..];
                let (d, output): (&[f32], &[f32]) = match plan.convolutions.get(layer + 1) {
                    None => (&scratch.rows_b[row * features..][..features], &self.features[row * features..][..features]),
                    Some(next) => {
                        (&scratch.stored_gradient[layer + 1], &self.activations[layer][row * next.stored..][..next.stored])
                    }
                };
                elu_backward_gather(d, output, &places[layer], convolution.channels(), &convolution.gradient_places, padded);
                let bias = plan.after(plan.convolution(layer));
                add_column_sums(padded, &mut gradient[bias.range()]);
                let stored: &[f32] = if layer == 0 {
                    let image = sized(&mut scratch.image, convolution.stored);
                    store_pixels(plan.shape.image, convolution, observation, input.pixels, &mut scratch.pixels, image);
                    &scratch.image
                } else {
                    &self.activations[layer - 1][row * convolution.stored..][..convolution.stored]
                };
                let patches = sized(&mut scratch.patches, convolution.patch_size());
                convolution.weight_gradient(stored, patches, padded, &mut scratch.convolution_gradients[layer]);
                if layer > 0 {
                    let into = &mut scratch.stored_gradient[layer];
                    convolution.input_gradient(padded, &back.convolutions[layer], patches, into);
                }
            }
        }
        for (layer, convolution) in plan.convolutions.iter().enumerate() {
            let range = plan.convolution(layer).range();
            convolution.unorder(&scratch.convolution_gradients[layer], &mut gradient[range]);
        }
    }
}

/// Adds the gradients of a layer's weights and biases, from its inputs and the gradient of its sums.
fn add_layer_gradient(weights: &Parameter, biases: &Parameter, inputs: &[f32], width: usize, sums: &[f32], gradient: &mut [f32]) {
    let outputs = weights.outputs;
    let size = Size { rows: width, columns: outputs, inner: sums.len() / outputs };
    let left = Left { data: inputs, row_stride: 1, inner_stride: width };
    multiply(size, left, Right::rows(sums, outputs), &mut gradient[weights.range()], outputs, true);
    add_column_sums(sums, &mut gradient[biases.range()]);
}

/// An 8-bit image to the first convolution's stored input, normalised.
fn store_pixels(
    shape: ImageShape,
    convolution: &ConvolutionPlan,
    observation: &[u8],
    pixels: &PixelScale,
    bytes: &mut Vec<u8>,
    image: &mut [f32],
) {
    assert_eq!(observation.len(), shape.size(), "observation of the wrong size");
    bytes.resize(convolution.stored, 0);
    match convolution.run_length {
        12 => copy_runs::<12>(observation, &convolution.runs, bytes),
        16 => copy_runs::<16>(observation, &convolution.runs, bytes),
        length => {
            for &(from, to) in &convolution.runs {
                let (from, to) = (from as usize, to as usize);
                bytes[to..to + length].copy_from_slice(&observation[from..from + length]);
            }
        }
    }
    scale_pixels(bytes, &pixels.scale, &pixels.shift, image);
}

/// Copies runs of a known length, so that each is a move or two rather than a call.
fn copy_runs<const LENGTH: usize>(observation: &[u8], runs: &[(u32, u32)], bytes: &mut [u8]) {
    for &(from, to) in runs {
        let (from, to) = (from as usize, to as usize);
        bytes[to..to + LENGTH].copy_from_slice(&observation[from..from + LENGTH]);
    }
}
