//! What samplers hand to the learner: some steps of some lanes.

use hasard_envs::Episode;
use serde::{Deserialize, Serialize};

use crate::networks::{ModelShape, Recording};

/// Steps of a sampler's lanes. Step `t` of lane `l` is row `t * lanes + l`; all buffers are reused.
/// Another worker's part comes without what is skipped here.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Part {
    /// Steps.
    pub steps: usize,
    /// Lanes.
    pub lanes: usize,
    /// Lanes of each group; frames are kept by group.
    pub group_lanes: usize,
    /// Steps of the trajectories that it is learned from in; 0 for all.
    pub trajectory_steps: usize,
    /// Observations of a group at a step, `frames[t * groups + g]`, and after the last step.
    #[serde(skip)]
    pub frames: Vec<Vec<u8>>,
    /// Extra inputs of each row, and after the last step.
    pub extra: Vec<f32>,
    /// Privileged inputs of each row, and after the last step.
    pub privileged: Vec<f32>,
    /// What each row's picture shows, for a network that predicts it: classes of its cells.
    pub shown: Vec<u8>,
    /// State of each network before the first step of each trajectory, all lanes' first
    /// trajectories first.
    #[serde(skip)]
    pub initial_state: Vec<Vec<f32>>,
    /// Categorical sub-actions.
    pub actions: Vec<u8>,
    /// Continuous sub-actions.
    pub deltas: Vec<f32>,
    /// Logarithm of each action's probability when it was taken.
    pub log_probabilities: Vec<f32>,
    /// Output rows when the actions were taken, and after the last step.
    pub outputs: Vec<f32>,
    /// Shaped rewards.
    pub rewards: Vec<f32>,
    /// Cost of each constraint, `constraints` a row.
    pub costs: Vec<f32>,
    /// Where the player stood at the end of each step, map units.
    pub positions: Vec<[i32; 2]>,
    /// The episode ended with the step.
    pub done: Vec<bool>,
    /// The episode was cut off by the clock: (row, output row for the true last observation).
    pub cut_off: Vec<(usize, Vec<f32>)>,
    /// Version of the weights of each step.
    pub versions: Vec<u64>,
    /// Episodes that ended, and with which step.
    #[serde(skip)]
    pub episodes: Vec<(usize, Episode)>,
    /// What each network computed of the steps, if the learner may find a use for it.
    #[serde(skip)]
    pub recordings: Vec<Recording>,
}

impl Part {
    /// Makes room; nothing is allocated where the size is as before.
    pub fn prepare(
        &mut self,
        shape: &ModelShape,
        steps: usize,
        lanes: usize,
        groups: usize,
        constraints: usize,
    ) {
        let rows = steps * lanes;
        (self.steps, self.lanes, self.group_lanes) = (steps, lanes, lanes / groups);
        self.frames.resize_with((steps + 1) * groups, Vec::new);
        for frames in &mut self.frames {
            frames.resize(self.group_lanes * shape.pixels(), 0);
        }
        self.extra.resize((rows + lanes) * shape.extra_inputs(), 0.0);
        self.privileged.resize((rows + lanes) * shape.critic_inputs, 0.0);
        self.actions.resize(rows * shape.action.sizes.len(), 0);
        self.deltas.resize(rows * shape.action.deltas, 0.0);
        self.log_probabilities.resize(rows, 0.0);
        self.outputs.resize((rows + lanes) * shape.outputs(), 0.0);
        self.rewards.resize(rows, 0.0);
        self.costs.resize(rows * constraints, 0.0);
        self.positions.resize(rows, [0, 0]);
        self.done.resize(rows, false);
        self.cut_off.clear();
        self.versions.resize(steps, 0);
        self.episodes.clear();
        self.recordings.iter_mut().for_each(Recording::clear);
    }

    /// Trajectories of each lane.
    #[must_use]
    pub fn trajectories(&self) -> usize {
        self.steps.checked_div(self.trajectory_steps).unwrap_or(1)
    }

    /// The observation of a lane at a step; step `steps` is the one after the last. Empty where
    /// another worker has the pixels.
    #[must_use]
    pub fn frame(&self, step: usize, lane: usize) -> &[u8] {
        if self.frames.is_empty() {
            return &[];
        }
        let groups = self.lanes / self.group_lanes;
        let frames = &self.frames[step * groups + lane / self.group_lanes];
        let size = frames.len() / self.group_lanes;
        let first = lane % self.group_lanes * size;
        &frames[first..first + size]
    }
}

/// Parts of all samplers, their lanes one after the other.
#[derive(Clone, Debug)]
pub struct Rollout {
    /// One a sampler, of as many steps each.
    pub parts: Vec<Part>,
}

impl Rollout {
    /// Steps of each lane.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.parts[0].steps
    }

    /// Lanes of all parts.
    #[must_use]
    pub fn lanes(&self) -> usize {
        self.parts.iter().map(|part| part.lanes).sum()
    }

    /// Steps of each trajectory.
    #[must_use]
    pub fn trajectory_steps(&self) -> usize {
        self.steps() / self.parts[0].trajectories()
    }

    /// Trajectories of all lanes, those of the first steps first.
    #[must_use]
    pub fn trajectories(&self) -> usize {
        self.lanes() * self.parts[0].trajectories()
    }

    /// The lane of a trajectory, and its first step.
    #[must_use]
    pub fn trajectory(&self, number: usize) -> (usize, usize) {
        (number % self.lanes(), number / self.lanes() * self.trajectory_steps())
    }

    /// State of a network, of `units` numbers, before the first step of a trajectory.
    #[must_use]
    pub fn initial_state(&self, network: usize, units: usize, trajectory: usize) -> &[f32] {
        let (lane, first) = self.trajectory(trajectory);
        let (part, own) = self.find(lane);
        let row = first / self.trajectory_steps() * part.lanes + own;
        &part.initial_state[network][row * units..(row + 1) * units]
    }

    /// Rows of all parts.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.steps() * self.lanes()
    }

    /// The part that a lane is in, and its number there.
    #[must_use]
    pub fn find(&self, lane: usize) -> (&Part, usize) {
        let mut own = lane;
        for part in &self.parts {
            if own < part.lanes {
                return (part, own);
            }
            own -= part.lanes;
        }
        panic!("lane {lane} of {}", self.lanes());
    }

    /// All frames that are here, those after the last step too.
    #[must_use]
    pub fn frames(&self) -> Vec<&[u8]> {
        (0..=self.steps())
            .flat_map(|step| (0..self.lanes()).map(move |lane| (step, lane)))
            .map(|(step, lane)| {
                let (part, lane) = self.find(lane);
                part.frame(step, lane)
            })
            .filter(|frame| !frame.is_empty())
            .collect()
    }

    /// Episodes that ended, in the order in which they did: how lanes were dealt to samplers does
    /// not matter.
    #[must_use]
    pub fn episodes(&self) -> Vec<&Episode> {
        let mut all: Vec<&(usize, Episode)> =
            self.parts.iter().flat_map(|part| &part.episodes).collect();
        all.sort_by_key(|(step, episode)| (*step, episode.lane));
        all.into_iter().map(|(_, episode)| episode).collect()
    }

    /// Oldest version of the weights that acted.
    #[must_use]
    pub fn oldest_version(&self) -> u64 {
        self.parts.iter().flat_map(|part| part.versions.iter().copied()).min().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rollout is as old as the oldest weights that acted in any step of any part.
    #[test]
    fn a_rollout_is_as_old_as_its_oldest_step() {
        let part = |versions: &[u64]| Part { versions: versions.to_vec(), ..Part::default() };
        let rollout = |parts: &[&[u64]]| Rollout { parts: parts.iter().map(|v| part(v)).collect() };
        assert_eq!(rollout(&[&[3, 5], &[4, 4]]).oldest_version(), 3);
        assert_eq!(rollout(&[&[6, 6], &[4, 7]]).oldest_version(), 4);
    }
}
