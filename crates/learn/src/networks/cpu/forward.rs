//! The forward pass: of whole trajectories when learning, of one step at a time when acting. Both
//! are the same code and write to a [`Tape`]; a row's numbers do not depend on the rows that are
//! computed with it.

use std::borrow::Cow;
use std::ops::Range;

use crate::config::RecurrentCell;
use crate::networks::PixelScale;
use crate::networks::cpu::buffers::sized;
use crate::networks::cpu::cells::{gru_gates, lstm_gates};
use crate::networks::cpu::convolution::{Rounded, Stored};
use crate::networks::cpu::elementwise::{bias_elu_rows, bias_elu_scatter, bias_rows, scale_pixels};
use crate::networks::cpu::pixels::StoredImage;
use crate::networks::cpu::product::{Left, Size, multiply_panels};
use crate::networks::cpu::residual::ResidualImage;
use crate::networks::cpu::tape::{Rows, Tape};
use crate::networks::cpu::weights::{PackedWeights, Plan};

/// What the rows of a forward pass read, ordered by lane, then by time.
pub struct Input<'a> {
    /// One image a row.
    pub observations: &'a [&'a [u8]],
    /// Extra inputs of each row.
    pub extra: &'a [f32],
    /// State of each lane before the first step.
    pub state: &'a [f32],
    /// Rows before which the state is zeroed; empty if none.
    pub reset: &'a [bool],
    /// How pixels enter, in the order of the first layer's stored input.
    pub pixels: &'a PixelScale,
}

/// Buffers of a forward pass that nothing needs afterwards.
#[derive(Default)]
pub struct Forward {
    image: StoredImage,
    residual: ResidualImage,
    raw: Vec<f32>,
    convolution: Rounded,
    rows: Vec<u16>,
    state: Vec<f32>,
    from_state: Vec<f32>,
}

/// Where the pixels of each convolution's output go: into the next one's input, or row by row
/// behind the last.
pub(super) fn output_places(plan: &Plan, layer: usize) -> Cow<'_, [usize]> {
    match plan.convolutions.get(layer + 1) {
        Some(next) => Cow::Borrowed(&next.places),
        None => {
            let convolution = &plan.convolutions[layer];
            (0..convolution.raw_places.len()).map(|pixel| pixel * convolution.channels()).collect()
        }
    }
}

impl Forward {
    /// Computes some lanes at one step, or at all of the tape's.
    pub fn run(
        &mut self,
        plan: &Plan,
        weights: &PackedWeights,
        input: &Input<'_>,
        steps: Range<usize>,
        lanes: Range<usize>,
        tape: &mut Tape,
    ) {
        let (kernels, shape) = (plan.kernels, &plan.shape);
        let rows = Rows::new(tape, &steps, &lanes);
        assert_eq!(input.observations.len(), rows.count, "one observation a row");
        self.encode(plan, weights, input, rows, tape);
        dense(plan, weights, input, rows, tape, &mut self.rows);
        if let Some(units) = shape.recurrent {
            self.recur(plan, units, weights, input, steps, lanes, tape);
        }
        let (inputs, padded) = (shape.head_inputs(), plan.padded_outputs);
        let core = if shape.recurrent.is_some() { &tape.after } else { &tape.core_input };
        let left = Left {
            data: &core[rows.span(inputs)],
            row_stride: rows.stride * inputs,
            inner_stride: 1,
        };
        let size = Size { rows: rows.count, columns: padded, inner: inputs };
        let outputs = &mut tape.outputs[rows.span(padded)];
        multiply_panels(
            kernels,
            size,
            left,
            &weights.heads,
            outputs,
            rows.stride * padded,
            false,
            &mut self.rows,
        );
        bias_rows(kernels, outputs, rows.stride * padded, &weights.head_biases);
    }

    /// State of each lane after the last step of the last pass.
    #[must_use]
    pub fn final_state(&self) -> &[f32] {
        &self.state
    }

    /// The encoder on every row, and the features that it ends in.
    fn encode(
        &mut self,
        plan: &Plan,
        weights: &PackedWeights,
        input: &Input<'_>,
        rows: Rows,
        tape: &mut Tape,
    ) {
        let kernels = plan.kernels;
        let features = plan.features;
        if !plan.shape.residual.is_empty() {
            for (row, observation) in rows.iter().zip(input.observations) {
                let to = &mut tape.features[row * features..(row + 1) * features];
                self.residual.forward(plan, weights, input.pixels, observation, to);
            }
            return;
        }
        let places: Vec<_> =
            (0..plan.convolutions.len()).map(|layer| output_places(plan, layer)).collect();
        for (row, observation) in rows.iter().zip(input.observations) {
            let to = &mut tape.features[row * features..(row + 1) * features];
            let Some(first) = plan.convolutions.first() else {
                scale_pixels(kernels, observation, &input.pixels.scale, &input.pixels.shift, to);
                continue;
            };
            let image =
                self.image.store(kernels, plan.shape.image, first, observation, input.pixels);
            for (layer, convolution) in plan.convolutions.iter().enumerate() {
                let (earlier, rest) = tape.activations.split_at_mut(layer);
                let stored = match earlier.last() {
                    None => image,
                    Some(before) => Stored::Numbers(
                        &before[row * convolution.stored..(row + 1) * convolution.stored],
                    ),
                };
                let raw = sized(&mut self.raw, convolution.raw_size());
                convolution.forward(
                    stored,
                    &weights.convolutions[layer],
                    &mut self.convolution,
                    raw,
                );
                let to = match plan.convolutions.get(layer + 1) {
                    Some(next) => &mut rest[0][row * next.stored..(row + 1) * next.stored],
                    None => &mut tape.features[row * features..(row + 1) * features],
                };
                let bias = &weights.convolution_biases[layer];
                bias_elu_scatter(kernels, raw, &convolution.raw_places, bias, &places[layer], to);
            }
        }
    }

    #[allow(clippy::too_many_arguments, reason = "the pieces of a pass")]
    fn recur(
        &mut self,
        plan: &Plan,
        units: usize,
        weights: &PackedWeights,
        input: &Input<'_>,
        steps: Range<usize>,
        lanes: Range<usize>,
        tape: &mut Tape,
    ) {
        let (kernels, inputs) = (plan.kernels, plan.shape.core_inputs());
        let (columns, width) = (plan.shape.gate_columns(), plan.shape.state_size());
        let rows = Rows::new(tape, &steps, &lanes);
        let size = Size { rows: rows.count, columns, inner: inputs };
        let left = Left {
            data: &tape.core_input[rows.span(inputs)],
            row_stride: rows.stride * inputs,
            inner_stride: 1,
        };
        let gates = &mut tape.gates[rows.span(columns)];
        multiply_panels(
            kernels,
            size,
            left,
            &weights.cell_input,
            gates,
            rows.stride * columns,
            false,
            &mut self.rows,
        );
        self.state.clear();
        self.state.extend_from_slice(input.state);
        let from_state = sized(&mut self.from_state, lanes.len() * columns);
        let [input_bias, state_bias] = &weights.cell_biases;
        for (index, step) in steps.clone().enumerate() {
            for (lane, state) in self.state.chunks_exact_mut(width).enumerate() {
                if input.reset.get(lane * steps.len() + index).is_some_and(|&reset| reset) {
                    state.fill(0.0);
                }
            }
            let size = Size { rows: lanes.len(), columns, inner: units };
            let left = Left::rows(&self.state, width);
            multiply_panels(
                kernels,
                size,
                left,
                &weights.cell_hidden,
                from_state,
                columns,
                false,
                &mut self.rows,
            );
            let each = self.state.chunks_exact_mut(width).zip(from_state.chunks_exact(columns));
            for (lane, (state, from_state)) in lanes.clone().zip(each) {
                let row = lane * tape.steps + step;
                let of = |width: usize| row * width..(row + 1) * width;
                let (gates, share) = (&mut tape.gates[of(columns)], &mut tape.share[of(units)]);
                let (before, after) = (&mut tape.before[of(units)], &mut tape.after[of(units)]);
                let (output, memory) = state.split_at_mut(units);
                before.copy_from_slice(output);
                match plan.shape.cell {
                    RecurrentCell::Gru => gru_gates(
                        kernels, gates, from_state, input_bias, state_bias, before, share, after,
                    ),
                    RecurrentCell::Lstm => {
                        share.copy_from_slice(memory);
                        lstm_gates(
                            kernels, gates, from_state, input_bias, state_bias, memory, after,
                        );
                    }
                }
                output.copy_from_slice(after);
            }
        }
    }
}

/// Dense layers, and the extra inputs behind the last.
fn dense(
    plan: &Plan,
    weights: &PackedWeights,
    input: &Input<'_>,
    rows: Rows,
    tape: &mut Tape,
    rounded: &mut Vec<u16>,
) {
    let (kernels, shape) = (plan.kernels, &plan.shape);
    for (index, &units) in shape.dense.iter().enumerate() {
        let (earlier, rest) = tape.dense.split_at_mut(index);
        let (from, inputs) = match earlier.last() {
            None => (&tape.features, plan.features),
            Some(before) => (before, shape.dense[index - 1]),
        };
        let (to, width) = match rest.first_mut() {
            Some(to) => (to, units),
            None => (&mut tape.core_input, shape.core_inputs()),
        };
        let size = Size { rows: rows.count, columns: units, inner: inputs };
        let left = Left {
            data: &from[rows.span(inputs)],
            row_stride: rows.stride * inputs,
            inner_stride: 1,
        };
        let (to, stride) = (&mut to[rows.span(width)], rows.stride * width);
        multiply_panels(kernels, size, left, &weights.dense[index], to, stride, false, rounded);
        bias_elu_rows(kernels, to, stride, &weights.dense_biases[index]);
    }
    let (inputs, extra) = (shape.core_inputs(), shape.extra_inputs);
    if extra > 0 {
        for (row, extra) in rows.iter().zip(input.extra.chunks_exact(extra)) {
            tape.core_input[(row + 1) * inputs - extra.len()..(row + 1) * inputs]
                .copy_from_slice(extra);
        }
    }
}
