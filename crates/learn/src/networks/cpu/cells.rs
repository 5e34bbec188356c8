//! The recurrent cells: what becomes of a step's products with the weights, and its gradients.

use crate::networks::cpu::elementwise::{sigmoid, tanh};
use crate::networks::cpu::vectorised::vectorised;

/// Numbers that a step works on at once, in arrays of their own: slices might overlap for all
/// that the compiler knows, and would be walked one number at a time.
const BLOCK: usize = 16;

#[inline(always)]
fn block(values: &[f32], at: usize) -> [f32; BLOCK] {
    values[at..at + BLOCK].try_into().expect("a whole block")
}

vectorised! {
    /// One step of a GRU for one lane. `gates` and `from_state` are the products of input and state
    /// with their weights, biases still missing; `gates` becomes the gates (reset, update,
    /// candidate), `share` the candidate's share of the state, which the backward pass needs, and
    /// `after` the new state.
    pub fn gru_gates(
        gates: &mut [f32], from_state: &[f32], input_bias: &[f32], state_bias: &[f32], before: &[f32], share: &mut [f32],
        after: &mut [f32],
    ) {
        let units = before.len();
        for unit in (0..units).step_by(BLOCK) {
            let [reset, update, candidate] = [unit, units + unit, 2 * units + unit];
            let [mut r, mut z, mut n] = [block(gates, reset), block(gates, update), block(gates, candidate)];
            let [sr, sz, sn] = [block(from_state, reset), block(from_state, update), block(from_state, candidate)];
            let [ir, iz, ic] = [block(input_bias, reset), block(input_bias, update), block(input_bias, candidate)];
            let [br, bz, bc] = [block(state_bias, reset), block(state_bias, update), block(state_bias, candidate)];
            let state = block(before, unit);
            let (mut shares, mut states) = ([0.0; BLOCK], [0.0; BLOCK]);
            for i in 0..BLOCK {
                r[i] = sigmoid(r[i] + ir[i] + sr[i] + br[i]);
                z[i] = sigmoid(z[i] + iz[i] + sz[i] + bz[i]);
                shares[i] = sn[i] + bc[i];
                n[i] = tanh(n[i] + ic[i] + r[i] * shares[i]);
                states[i] = n[i] + z[i] * (state[i] - n[i]);
            }
            gates[reset..reset + BLOCK].copy_from_slice(&r);
            gates[update..update + BLOCK].copy_from_slice(&z);
            gates[candidate..candidate + BLOCK].copy_from_slice(&n);
            share[unit..unit + BLOCK].copy_from_slice(&shares);
            after[unit..unit + BLOCK].copy_from_slice(&states);
        }
    }
}

vectorised! {
    /// The backward step of [`gru_gates`], from what it left. `input_sums` and `state_sums` become
    /// the gradients of the two products; `carry` is the gradient of the state after, and becomes
    /// the direct part of that of the state before.
    pub fn gru_gates_backward(
        gates: &[f32], share: &[f32], before: &[f32], carry: &mut [f32], input_sums: &mut [f32], state_sums: &mut [f32],
    ) {
        let units = before.len();
        for unit in (0..units).step_by(BLOCK) {
            let [reset, update, candidate] = [unit, units + unit, 2 * units + unit];
            let [r, z, n] = [block(gates, reset), block(gates, update), block(gates, candidate)];
            let [share, state, mut d] = [block(share, unit), block(before, unit), block(carry, unit)];
            let [mut d_reset, mut d_update, mut d_candidate, mut d_share] = [[0.0; BLOCK]; 4];
            for i in 0..BLOCK {
                d_candidate[i] = d[i] * (1.0 - z[i]) * (1.0 - n[i] * n[i]);
                d_update[i] = d[i] * (state[i] - n[i]) * z[i] * (1.0 - z[i]);
                d_reset[i] = d_candidate[i] * share[i] * r[i] * (1.0 - r[i]);
                d_share[i] = d_candidate[i] * r[i];
                d[i] *= z[i];
            }
            for (sums, last) in [(&mut *input_sums, d_candidate), (&mut *state_sums, d_share)] {
                sums[reset..reset + BLOCK].copy_from_slice(&d_reset);
                sums[update..update + BLOCK].copy_from_slice(&d_update);
                sums[candidate..candidate + BLOCK].copy_from_slice(&last);
            }
            carry[unit..unit + BLOCK].copy_from_slice(&d);
        }
    }
}

vectorised! {
    /// One step of an LSTM for one lane. `gates` and `from_state` are the products of input and
    /// output with their weights, biases still missing; `gates` becomes the gates (input, forget,
    /// candidate, output). `cell` is the cell before and becomes that after; `after` is the new
    /// output.
    pub fn lstm_gates(
        gates: &mut [f32], from_state: &[f32], input_bias: &[f32], state_bias: &[f32], cell: &mut [f32], after: &mut [f32],
    ) {
        let units = cell.len();
        for unit in (0..units).step_by(BLOCK) {
            let places = [unit, units + unit, 2 * units + unit, 3 * units + unit];
            let mut sums = [[0.0; BLOCK]; 4];
            for (sums, &place) in sums.iter_mut().zip(&places) {
                let (x, s) = (block(gates, place), block(from_state, place));
                let (x_bias, s_bias) = (block(input_bias, place), block(state_bias, place));
                for i in 0..BLOCK {
                    sums[i] = x[i] + x_bias[i] + s[i] + s_bias[i];
                }
            }
            let [mut input, mut forget, mut candidate, mut output] = sums;
            let (mut cells, mut outputs) = (block(cell, unit), [0.0; BLOCK]);
            for i in 0..BLOCK {
                input[i] = sigmoid(input[i]);
                forget[i] = sigmoid(forget[i]);
                candidate[i] = tanh(candidate[i]);
                output[i] = sigmoid(output[i]);
                cells[i] = forget[i] * cells[i] + input[i] * candidate[i];
                outputs[i] = output[i] * tanh(cells[i]);
            }
            for (place, values) in places.into_iter().zip([input, forget, candidate, output]) {
                gates[place..place + BLOCK].copy_from_slice(&values);
            }
            cell[unit..unit + BLOCK].copy_from_slice(&cells);
            after[unit..unit + BLOCK].copy_from_slice(&outputs);
        }
    }
}

vectorised! {
    /// The backward step of [`lstm_gates`], from the gates that it left and the cell before it.
    /// `sums` becomes the gradient of either product. `carry` and `cell_carry` are the gradients of
    /// output and cell after; they become those of output (nothing but by the product) and cell
    /// before.
    pub fn lstm_gates_backward(gates: &[f32], before: &[f32], carry: &mut [f32], cell_carry: &mut [f32], sums: &mut [f32]) {
        let units = before.len();
        for unit in (0..units).step_by(BLOCK) {
            let places = [unit, units + unit, 2 * units + unit, 3 * units + unit];
            let [input, forget, candidate, output] = places.map(|place| block(gates, place));
            let [before, d, mut d_cell] = [block(before, unit), block(carry, unit), block(cell_carry, unit)];
            let [mut d_input, mut d_forget, mut d_candidate, mut d_output] = [[0.0; BLOCK]; 4];
            for i in 0..BLOCK {
                let shown = tanh(forget[i] * before[i] + input[i] * candidate[i]);
                d_output[i] = d[i] * shown * output[i] * (1.0 - output[i]);
                d_cell[i] += d[i] * output[i] * (1.0 - shown * shown);
                d_input[i] = d_cell[i] * candidate[i] * input[i] * (1.0 - input[i]);
                d_candidate[i] = d_cell[i] * input[i] * (1.0 - candidate[i] * candidate[i]);
                d_forget[i] = d_cell[i] * before[i] * forget[i] * (1.0 - forget[i]);
                d_cell[i] *= forget[i];
            }
            for (place, values) in places.into_iter().zip([d_input, d_forget, d_candidate, d_output]) {
                sums[place..place + BLOCK].copy_from_slice(&values);
            }
            carry[unit..unit + BLOCK].fill(0.0);
            cell_carry[unit..unit + BLOCK].copy_from_slice(&d_cell);
        }
    }
}
