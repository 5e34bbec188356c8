//! The backward pass through heads, recurrent and dense layers, row by row: gradients of every
//! layer's sums for some lanes.
//!
//! What is a sum over rows, the gradient of weights, comes after ([`super::gradient`]); what is
//! done here for one lane does not depend on the lanes beside it.

use crate::config::RecurrentCell;
use crate::networks::cpu::buffers::sized;
use crate::networks::cpu::cells::{gru_gates_backward, lstm_gates_backward};
use crate::networks::cpu::elementwise::{add, elu_backward_rows};
use crate::networks::cpu::product::{Left, Size, multiply_panels};
use crate::networks::cpu::tape::TapeLane;
use crate::networks::cpu::weights::{Backward, Plan};

/// Gradients of some lanes; rows as in their tape, by lane, then by time, but where something else
/// is said.
#[derive(Default)]
pub struct RowGradients {
    /// Lanes.
    pub lanes: usize,
    /// Of the outputs, padded to whole panels.
    pub outputs: Vec<f32>,
    /// Of the products of the recurrent layer's input.
    pub input_sums: Vec<f32>,
    /// Of the products of its output before; by time, then by lane.
    pub state_sums: Vec<f32>,
    /// Of the sums of each dense layer.
    pub dense: Vec<Vec<f32>>,
    /// Of the features.
    pub features: Vec<f32>,
    core: Vec<f32>,
    carry: Vec<f32>,
    rounded: Vec<u16>,
}

impl RowGradients {
    /// Computes all of them from `outputs`. `reset` says before which rows the state was zeroed.
    pub fn run(&mut self, plan: &Plan, back: &Backward, lanes: &[TapeLane<'_>], reset: &[bool]) {
        let (kernels, shape) = (plan.kernels, &plan.shape);
        let steps = lanes.first().map_or(0, |lane| lane.tape.steps);
        let rows = steps * lanes.len();
        self.lanes = lanes.len();
        self.dense.resize_with(shape.dense.len(), Vec::new);
        let padded = plan.padded_outputs;
        let units = shape.dense[shape.dense.len() - 1];
        let from_outputs = Left::rows(&self.outputs, padded);
        let last = sized(&mut self.dense[shape.dense.len() - 1], rows * units);
        if let Some(cell_units) = shape.recurrent {
            let core = sized(&mut self.core, rows * cell_units);
            let size = Size { rows, columns: cell_units, inner: padded };
            multiply_panels(
                kernels,
                size,
                from_outputs,
                &back.heads,
                core,
                cell_units,
                false,
                &mut self.rounded,
            );
            self.recur(plan, back, lanes, reset, cell_units);
            let (last, columns) = (&mut self.dense[shape.dense.len() - 1], shape.gate_columns());
            let left = Left::rows(&self.input_sums, columns);
            let size = Size { rows, columns: units, inner: columns };
            multiply_panels(
                kernels,
                size,
                left,
                &back.cell_input,
                last,
                units,
                false,
                &mut self.rounded,
            );
        } else {
            let size = Size { rows, columns: units, inner: padded };
            multiply_panels(
                kernels,
                size,
                from_outputs,
                &back.heads,
                last,
                units,
                false,
                &mut self.rounded,
            );
        }
        for index in (0..shape.dense.len()).rev() {
            let units = shape.dense[index];
            let (earlier, rest) = self.dense.split_at_mut(index);
            let sums = &mut rest[0][..rows * units];
            for (sums, lane) in sums.chunks_exact_mut((steps * units).max(1)).zip(lanes) {
                let (output, width) = match lane.tape.dense.get(index) {
                    Some(output) => (output, units),
                    None => (&lane.tape.core_input, shape.core_inputs()),
                };
                elu_backward_rows(kernels, sums, units, lane.of(output, width), width);
            }
            let (to, inputs) = match earlier.last_mut() {
                Some(before) => (before, shape.dense[index - 1]),
                // Nothing flows into an image.
                None if plan.convolutions.is_empty() => break,
                None => (&mut self.features, plan.features),
            };
            let to = sized(to, rows * inputs);
            let left = Left::rows(sums, units);
            let size = Size { rows, columns: inputs, inner: units };
            multiply_panels(
                kernels,
                size,
                left,
                &back.dense[index],
                to,
                inputs,
                false,
                &mut self.rounded,
            );
        }
    }

    /// From the gradient of the outputs after each step to those of the recurrent layer's products.
    fn recur(
        &mut self,
        plan: &Plan,
        back: &Backward,
        lanes: &[TapeLane<'_>],
        reset: &[bool],
        units: usize,
    ) {
        let (kernels, cell, count) = (plan.kernels, plan.shape.cell, lanes.len());
        let (columns, width) = (plan.shape.gate_columns(), plan.shape.state_size());
        let steps = lanes.first().map_or(0, |lane| lane.tape.steps);
        let input_sums = sized(&mut self.input_sums, steps * count * columns);
        let state_sums = sized(&mut self.state_sums, steps * count * columns);
        let carry = sized(&mut self.carry, count * width);
        carry.fill(0.0);
        for step in (0..steps).rev() {
            let state_sums = &mut state_sums[step * count * columns..(step + 1) * count * columns];
            let each = lanes
                .iter()
                .zip(carry.chunks_exact_mut(width))
                .zip(state_sums.chunks_exact_mut(columns));
            for (lane, ((source, carry), state_sums)) in each.enumerate() {
                let row = lane * steps + step;
                let (carry, cell_carry) = carry.split_at_mut(units);
                add(kernels, carry, &self.core[row * units..(row + 1) * units]);
                let of = |buffer, width: usize| {
                    &source.of(buffer, width)[step * width..(step + 1) * width]
                };
                let (gates, share) =
                    (of(&source.tape.gates, columns), of(&source.tape.share, units));
                let input_sums = &mut input_sums[row * columns..(row + 1) * columns];
                match cell {
                    RecurrentCell::Gru => {
                        let before = of(&source.tape.before, units);
                        gru_gates_backward(
                            kernels, gates, share, before, carry, input_sums, state_sums,
                        );
                    }
                    RecurrentCell::Lstm => {
                        lstm_gates_backward(kernels, gates, share, carry, cell_carry, state_sums);
                        input_sums.copy_from_slice(state_sums);
                    }
                }
            }
            let size = Size { rows: count, columns: units, inner: columns };
            let left = Left::rows(state_sums, columns);
            multiply_panels(
                kernels,
                size,
                left,
                &back.cell_hidden,
                carry,
                width,
                true,
                &mut self.rounded,
            );
            for (lane, carry) in carry.chunks_exact_mut(width).enumerate() {
                if reset[lane * steps + step] {
                    carry.fill(0.0);
                }
            }
        }
    }
}
