//! Advantages and targets estimated anew, by critics that have learned meanwhile.

use super::{Learner, Prepared};
use crate::learning::gather::sequences;
use crate::learning::targets::prepare_anew;

impl Learner {
    /// The same rollout with the advantages and targets that follow from what the critics say of it
    /// now.
    pub fn prepare_anew<'a>(&mut self, prepared: &Prepared<'a>) -> Prepared<'a> {
        self.refresh();
        let rollout = prepared.rollout;
        let (steps, count) = (rollout.trajectory_steps(), rollout.trajectories());
        let all: Vec<usize> = (0..count).collect();
        // With a step more than is learned from: the value of what comes after the last.
        let mut batch = sequences(rollout, &self.shape, &all, steps + 1);
        let rows = self.networks.forward(0..self.shape.networks.len(), &mut batch);
        let (width, first) = (self.shape.outputs(), self.shape.value_column());
        let value = |critic: usize, lane: usize, step: usize| {
            let cut = (step / steps).min(count / rollout.lanes() - 1);
            let row = (step - cut * steps) * count + cut * rollout.lanes() + lane;
            rows[row * width + first + critic]
        };
        prepare_anew(prepared, &self.shape, &self.config, &self.returns, value)
    }
}
