//! What passes between a batch of worlds and its user.

/// Actions in, observations out, for a group of lanes: one contiguous buffer a field, owned by the caller and handed
/// over for the time of a step, so that nothing is copied. Made by [`crate::VecEnv::batch`] with every buffer as long as it must be.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Batch {
    /// In: categorical sub-actions, `[lanes, groups]`.
    pub actions: Vec<u8>,
    /// In: continuous sub-actions, `[lanes, deltas]`.
    pub deltas: Vec<f32>,
    /// Out: observations, `[lanes, ..observation shape]`, 0..=255. After an episode's end, the first of the next one.
    pub observations: Vec<u8>,
    /// Out: reward of the step, `[lanes]`.
    pub rewards: Vec<f32>,
    /// Out: cost of the step (the sum of its counted terms), `[lanes]`.
    pub costs: Vec<f32>,
    /// Out: each cost term of the step, counted or not, `[lanes, terms]`.
    pub cost_terms: Vec<f32>,
    /// Out: where the player stands at the end of the step, before any reset, in map units, `[lanes]`. For heatmaps.
    pub positions: Vec<[i32; 2]>,
    /// Out: the episode ended by death or goal, `[lanes]`.
    pub terminated: Vec<bool>,
    /// Out: the episode ended by time-out, `[lanes]`.
    pub truncated: Vec<bool>,
    /// Out: the true last observation of each lane whose episode was truncated in this step: (lane in this batch, observation).
    pub final_observations: Vec<(usize, Vec<u8>)>,
    /// Out: the episodes that ended in this step, in lane order.
    pub episodes: Vec<Episode>,
}

/// A finished episode.
#[derive(Clone, Debug, PartialEq)]
pub struct Episode {
    /// Lane of the whole batch that it ran in.
    pub lane: usize,
    /// Seed it was reset with.
    pub seed: u64,
    /// Sum of rewards.
    pub episode_return: f64,
    /// Sum of costs.
    pub cost: f64,
    /// Sum of each counted cost term: together they are the cost. What is measured beside it is among the statistics.
    pub costs: Vec<(&'static str, f64)>,
    /// Length in policy steps.
    pub length: u32,
    /// Ended by death or goal.
    pub terminated: bool,
    /// Ended by time-out.
    pub truncated: bool,
    /// Scenario statistics.
    pub stats: Vec<(&'static str, f64)>,
}
