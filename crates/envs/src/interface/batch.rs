//! What passes between a batch of worlds and its user.

use crate::interface::buffer::Buffer;
use crate::interface::happening::Happening;
use crate::interface::step::CostTerm;

/// Actions in, observations out, for a group of lanes: one contiguous buffer a field, owned by the
/// caller and handed over for the time of a step, so that nothing is copied. Made by
/// [`crate::VecEnv::batch`] with every buffer as long as it must be; any output may be replaced by
/// memory of the caller's ([`Buffer::external`]).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Batch {
    /// In: categorical sub-actions, `[lanes, groups]`.
    pub actions: Vec<u8>,
    /// In: continuous sub-actions, `[lanes, deltas]`.
    pub deltas: Vec<f32>,
    /// Out: observations, `[lanes, ..observation shape]`, 0..=255. After an episode's end,
    /// under [`crate::Autoreset::SameStep`] the first of the next one, else the episode's last.
    pub observations: Buffer<u8>,
    /// Out: reward of the step, `[lanes]`.
    pub rewards: Buffer<f32>,
    /// Out: cost of the step (the sum of its counted terms), `[lanes]`.
    pub costs: Buffer<f32>,
    /// Out: each cost term of the step, counted or not, `[lanes, terms]`.
    pub cost_terms: Buffer<f32>,
    /// Out: each statistic of the episode so far, at the end of the step and before any reset,
    /// `[lanes, statistics]`; empty unless [`crate::VecOptions::statistics`] asks for them.
    pub statistics: Buffer<f64>,
    /// Out: where the player stands at the end of the step, before any reset, in map units,
    /// `[lanes]`. For heatmaps.
    pub positions: Buffer<[i32; 2]>,
    /// Out: the episode ended by death, the hard constraint or its goal, `[lanes]`.
    pub terminated: Buffer<bool>,
    /// Out: the episode ended by time-out, `[lanes]`.
    pub truncated: Buffer<bool>,
    /// Out: what is shown beside observations, `[lanes, bytes]`; empty unless
    /// [`crate::VecOptions::insight`] asks for something.
    pub insight: Buffer<u8>,
    /// Out: the lanes of this batch, counted within it, whose true last observation follows,
    /// ascending. Of which ends those are says [`crate::VecOptions::final_observations`].
    pub final_lanes: Vec<usize>,
    /// Out: the true last observations of those lanes, `[final lanes, ..observation shape]`: one
    /// array.
    pub final_observations: Vec<u8>,
    /// Out: the same of what is shown beside observations, `[final lanes, bytes]`.
    pub final_insight: Vec<u8>,
    /// Out: what happened in the step, of lane after lane, before any reset; see
    /// [`crate::EnvOptions::events`].
    pub happenings: Vec<Happening>,
    /// Out: where each lane's happenings begin, and after them where the last one's end, `[lanes +
    /// 1]`.
    pub happening_offsets: Vec<usize>,
    /// Out: the episodes that ended in this step, in lane order. Their lanes are counted over all
    /// groups: the first of a group's is the start of [`crate::VecEnv::group_lanes`].
    pub episodes: Vec<Episode>,
}

impl Batch {
    /// Number of lanes.
    #[must_use]
    pub fn lanes(&self) -> usize {
        self.rewards.len()
    }

    /// What happened in a lane's step.
    #[must_use]
    pub fn happenings_of(&self, lane: usize) -> &[Happening] {
        match self.happening_offsets.get(lane..lane + 2) {
            Some(&[from, to]) => &self.happenings[from..to],
            _ => &[],
        }
    }

    /// The lanes that have a true last observation, each with it.
    pub fn finals(&self) -> impl Iterator<Item = (usize, &[u8])> {
        let size = self.final_observations.len() / self.final_lanes.len().max(1);
        self.final_lanes.iter().copied().zip(self.final_observations.chunks_exact(size.max(1)))
    }

    /// What is shown beside the last observation of the lane that stands at a place among those
    /// that have one.
    #[must_use]
    pub fn final_insight(&self, place: usize) -> &[u8] {
        let bytes = self.final_insight.len() / self.final_lanes.len().max(1);
        &self.final_insight[place * bytes..(place + 1) * bytes]
    }

    /// Whether each lane has a true last observation, `[lanes]`.
    #[must_use]
    pub fn final_mask(&self) -> Vec<bool> {
        let mut mask = vec![false; self.lanes()];
        self.final_lanes.iter().for_each(|&lane| mask[lane] = true);
        mask
    }
}

/// A cost term and what an episode came to under it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EpisodeCost {
    /// Name of the term.
    pub name: &'static str,
    /// Part of the scalar cost.
    pub counted: bool,
    /// Sum over the episode's steps.
    pub cost: f64,
}

/// What an episode came to under each of its terms: all are reported, whether counted or not.
#[must_use]
pub fn episode_costs(terms: &[CostTerm], sums: &[f64]) -> Vec<EpisodeCost> {
    terms
        .iter()
        .zip(sums)
        .map(|(term, &cost)| EpisodeCost { name: term.name, counted: term.counted, cost })
        .collect()
}

/// A finished episode.
#[derive(Clone, Debug, PartialEq)]
pub struct Episode {
    /// The id of its task in a batch of several; `None` where all lanes have the same.
    pub task: Option<&'static str>,
    /// Lane of the whole batch that it ran in.
    pub lane: usize,
    /// Seed it was reset with.
    pub seed: u64,
    /// Sum of rewards.
    pub episode_return: f64,
    /// Sum of costs.
    pub cost: f64,
    /// Sum of every cost term of the environment, in the order of its terms. The counted ones
    /// together are the cost; a constraint may be on any of them. Of one of several tasks, its own
    /// terms, and last the whole cost under the task's id.
    pub costs: Vec<EpisodeCost>,
    /// Length in policy steps.
    pub length: u32,
    /// Ended by death, the hard constraint or its goal.
    pub terminated: bool,
    /// Ended by time-out.
    pub truncated: bool,
    /// Scenario statistics.
    pub stats: Vec<(&'static str, f64)>,
}
