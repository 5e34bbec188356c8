//! How the networks learn.

use serde::{Deserialize, Serialize};

use super::names::names;

names! {
    /// What keeps the policy from settling too early.
    Exploration ("exploration loss") {
        /// Symmetric divergence from the uniform distribution, as in the original.
        SymmetricKl = "symmetric-kl",
        /// Minus the entropy.
        Entropy = "entropy",
    }
}

/// How the networks learn.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct LearningConfig {
    /// Passes over a rollout.
    pub epochs: usize,
    /// Parts that the rollout's trajectories are dealt into in each pass.
    pub minibatches: usize,
    /// Discount.
    pub gamma: f64,
    /// Lambda of the advantage estimate.
    pub gae_lambda: f64,
    /// Learning rate.
    pub rate: f64,
    /// Learning rate at the end of the run, reached linearly; `null` for a constant one.
    pub final_rate: Option<f64>,
    /// Adam's decays.
    pub adam_betas: (f64, f64),
    /// Adam's epsilon.
    pub adam_epsilon: f64,
    /// Divergence of the policy from the one that acted, mean over a pass, after which a rollout is learned from no further;
    /// `null` for all passes in any case.
    #[serde(default)]
    pub target_kl: Option<f64>,
    /// Learning rate of critics that are networks of their own; `null` for that of the policy. It follows the same schedule.
    #[serde(default)]
    pub critic_rate: Option<f64>,
    /// Discount of costs; `null` for that of rewards.
    #[serde(default)]
    pub cost_gamma: Option<f64>,
    /// Norm that gradients are cut down to; 0 for none.
    pub max_gradient_norm: f64,
    /// Clipping of the probability ratio: 1/(1+clip) to 1+clip.
    pub clip_ratio: f64,
    /// Clipping of value changes.
    pub clip_value: f64,
    /// Weight of the value losses.
    pub value_coefficient: f64,
    /// Exploration loss.
    pub exploration: Exploration,
    /// Its weight.
    pub exploration_coefficient: f64,
    /// Its weight at the end of the run, reached linearly; `null` for a constant one.
    #[serde(default)]
    pub final_exploration_coefficient: Option<f64>,
    /// Time-outs count as cut-off rather than as ends: the value of what would have come is added.
    pub bootstrap_time_outs: bool,
    /// The first forward pass over a rollout is not computed but taken from the actors, in synchronous runs, which is faster.
    /// Statistics of pixels then follow one rollout later, and agents learned less with it (docs/tried/reused_forward_pass.md).
    #[serde(default)]
    pub reuse_forward: bool,
    /// Threads.
    pub threads: usize,
    /// Plain kernels, whose results have the same bits on every machine; otherwise the fastest that the processor has.
    #[serde(default)]
    pub portable: bool,
}

impl LearningConfig {
    /// The learning rate after a share of the run, from 0 to 1.
    #[must_use]
    pub fn rate_after(&self, share: f64) -> f64 {
        self.rate + (self.final_rate.unwrap_or(self.rate) - self.rate) * share.min(1.0)
    }
}
