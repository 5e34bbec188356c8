//! What a forward pass leaves behind for the backward one.

use std::ops::Range;

use crate::networks::cpu::weights::Plan;

/// Activations of some trajectories. Rows are ordered by lane, then by time: step `t` of lane `l`
/// is row `l * steps + t`.
#[derive(Clone, Debug, Default)]
pub struct Tape {
    /// Steps of each lane.
    pub steps: usize,
    /// Lanes.
    pub lanes: usize,
    /// Output of each convolution but the last, in the layout of the next one's input, row after
    /// row; empty for a residual encoder.
    pub activations: Vec<Vec<f32>>,
    /// Output of the last convolution, or the image without one.
    pub features: Vec<f32>,
    /// Output of each dense layer but the last.
    pub dense: Vec<Vec<f32>>,
    /// Output of the last dense layer and the extra inputs.
    pub core_input: Vec<f32>,
    /// Gates of the recurrent layer.
    pub gates: Vec<f32>,
    /// What else its backward step needs: the candidate gate's share of the state (GRU), the cell
    /// before each step (LSTM).
    pub share: Vec<f32>,
    /// Its output before each step, after resets.
    pub before: Vec<f32>,
    /// Its output after each step.
    pub after: Vec<f32>,
    /// Outputs, padded to whole panels.
    pub outputs: Vec<f32>,
}

impl Tape {
    /// Makes room. Nothing is allocated, or zeroed, where the size is as before.
    pub fn prepare(&mut self, plan: &Plan, steps: usize, lanes: usize) {
        let shape = &plan.shape;
        let rows = steps * lanes;
        (self.steps, self.lanes) = (steps, lanes);
        let kept =
            if shape.residual.is_empty() { plan.convolutions.get(1..).unwrap_or(&[]) } else { &[] };
        self.activations.resize_with(kept.len(), Vec::new);
        for (activations, next) in self.activations.iter_mut().zip(kept) {
            activations.resize(rows * next.stored, 0.0);
        }
        self.features.resize(rows * plan.features, 0.0);
        self.dense.resize_with(shape.dense.len() - 1, Vec::new);
        for (dense, units) in self.dense.iter_mut().zip(&shape.dense) {
            dense.resize(rows * units, 0.0);
        }
        self.core_input.resize(rows * shape.core_inputs(), 0.0);
        let units = shape.recurrent.unwrap_or(0);
        self.gates.resize(rows * shape.gate_columns(), 0.0);
        for states in [&mut self.share, &mut self.before, &mut self.after] {
            states.resize(rows * units, 0.0);
        }
        self.outputs.resize(rows * plan.padded_outputs, 0.0);
    }

    /// What enters the heads.
    #[must_use]
    pub fn core(&self, plan: &Plan) -> &[f32] {
        if plan.shape.recurrent.is_some() { &self.after } else { &self.core_input }
    }
}

/// One lane of a tape.
#[derive(Clone, Copy, Debug)]
pub struct TapeLane<'a> {
    /// The tape.
    pub tape: &'a Tape,
    /// The lane.
    pub lane: usize,
}

impl<'a> TapeLane<'a> {
    /// This lane's rows of one of the tape's buffers, which has `width` numbers a row.
    #[must_use]
    pub fn of(&self, buffer: &'a [f32], width: usize) -> &'a [f32] {
        let steps = self.tape.steps;
        &buffer[self.lane * steps * width..(self.lane + 1) * steps * width]
    }
}

/// Rows of a tape that are computed together: all steps of some lanes, or one step of them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rows {
    /// The first.
    pub first: usize,
    /// How many.
    pub count: usize,
    /// Distance of two of them.
    pub stride: usize,
}

impl Rows {
    pub fn new(tape: &Tape, steps: &Range<usize>, lanes: &Range<usize>) -> Rows {
        assert!(
            steps.end <= tape.steps && lanes.end <= tape.lanes && !steps.is_empty(),
            "rows outside the tape"
        );
        assert!(steps.len() == 1 || steps.len() == tape.steps, "one step or all of them");
        let first = lanes.start * tape.steps + steps.start;
        if steps.len() == tape.steps {
            Rows { first, count: lanes.len() * tape.steps, stride: 1 }
        } else {
            Rows { first, count: lanes.len(), stride: tape.steps }
        }
    }

    /// Where they lie in a buffer of `width` numbers a row.
    pub fn span(self, width: usize) -> Range<usize> {
        let last = self.first + self.count.saturating_sub(1) * self.stride;
        self.first * width..if self.count == 0 { self.first * width } else { (last + 1) * width }
    }

    /// The rows themselves.
    pub fn iter(self) -> impl Iterator<Item = usize> {
        (0..self.count).map(move |index| self.first + index * self.stride)
    }
}
