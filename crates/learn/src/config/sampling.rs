//! How experience is gathered.

use serde::{Deserialize, Serialize};

/// How experience is gathered.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct SamplingConfig {
    /// Worlds.
    pub lanes: usize,
    /// Steps of a trajectory.
    pub rollout: usize,
    /// Threads that run the policy, each with worlds of its own.
    pub samplers: usize,
    /// Threads that step the worlds of each sampler; with 0 it steps them itself.
    pub world_threads: usize,
    /// Groups of worlds of each sampler: with 2 and world threads, one half steps while the policy
    /// works on the other.
    pub groups: usize,
    /// Lanes start their first episode after different numbers of steps: random ones, or the
    /// agent's where the run begins with one.
    pub spread_out: bool,
    /// Sampling and learning take turns, bit-reproducibly; otherwise they run side by side.
    pub synchronous: bool,
    /// Rollouts that may wait for the learner when both run side by side.
    pub accumulated: usize,
    /// Updates that a rollout may be older than the learner; older ones are thrown away.
    pub max_policy_lag: u64,
}
