//! What an episode has brought so far, as the rules of its scenario see it.

/// Most cost terms of a scenario.
pub const MOST_TERMS: usize = 4;

/// Reward, cost terms and end of the running episode.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// Reward of the running step.
    pub reward: f64,
    /// Cost terms of the running step, in the order of the scenario's terms.
    pub costs: [f64; MOST_TERMS],
    /// The goal is reached, or a hard constraint broken: the episode ends when the next tic would
    /// begin.
    pub finished: bool,
}
