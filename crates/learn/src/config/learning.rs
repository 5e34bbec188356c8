//! How the networks learn.

use serde::{Deserialize, Serialize};

use crate::config::names::names;

names! {
    /// What keeps the policy from settling too early.
    Exploration ("exploration loss") {
        /// Symmetric divergence from the uniform distribution, as in the original.
        SymmetricKl = "symmetric-kl",
        /// Minus the entropy.
        Entropy = "entropy",
    }
}

names! {
    /// What critics see and the policy does not (Pinto et al. 2018, arXiv 1710.06542): nothing acts
    /// by it, so that an agent needs none of it once it is trained.
    CriticInput ("input of the critics") {
        /// What is left of the time of the episode, discounted as returns are, at the end of a
        /// schedule; a second number for costs with a discount of their own. A time limit that is
        /// not seen makes the value of one and the same picture another at every step (Pardo et al.
        /// 2018, arXiv 1712.00378).
        TimeLeft = "time-left",
        /// Each constraint's cost of the episode so far, in units of its budget.
        BudgetSpent = "budget-spent",
        /// Health points.
        Health = "health",
        /// Rounds for the weapon in hand.
        Ammunition = "ammunition",
        /// Where the player is between the ends of the map, which way it looks, how fast it goes.
        Position = "position",
        /// Of each group of things, how much of the picture it fills, and how near it is.
        InView = "in-view",
    }
}

names! {
    /// What steps the weights of hidden layers; Adam steps the others.
    #[derive(Default)]
    Optimiser ("optimiser") {
        /// Adam (Kingma and Ba 2015).
        #[default]
        Adam = "adam",
        /// Muon (Jordan et al. 2024): each matrix goes by the orthogonal matrix that is nearest to
        /// its momentum, so that all directions are learned equally fast.
        Muon = "muon",
    }
}

names! {
    /// What brings returns to one scale for the critics.
    #[derive(Default)]
    ReturnNormaliser ("normaliser of returns") {
        /// Moments of all returns so far, as in the original; values are cut off at five
        /// deviations.
        #[default]
        Running = "running",
        /// Moments that forget, and heads whose outputs keep their worth when the moments move (van
        /// Hasselt et al. 2016, arXiv 1602.07714; Hessel et al. 2019, arXiv 1809.04474).
        PopArt = "popart",
    }
}

names! {
    /// What the factors of the networks' products are rounded to on their way, on the processor.
    #[derive(Default)]
    Products ("products") {
        /// Nothing: numbers of 32 bits.
        #[default]
        Float32 = "float32",
        /// Numbers of 16 bits with the exponents of those of 32; sums, weights, moments and all
        /// else keep 32 bits. It needs a processor with AVX512-BF16, and is the default of none.
        Bfloat16 = "bfloat16",
    }
}

/// Samples after which moments have forgotten two thirds of what was before: 400,000 frames.
fn a_hundred_rollouts() -> f64 {
    100_000.0
}

/// As in the paper of the value phase.
fn six() -> usize {
    6
}

fn one() -> f64 {
    1.0
}

fn half() -> f64 {
    0.5
}

/// How the networks learn.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct LearningConfig {
    /// Epochs on a rollout.
    pub epochs: usize,
    /// Parts that the rollout's trajectories are dealt into in each epoch.
    pub minibatches: usize,
    /// Before every epoch but the first, advantages and targets are estimated anew from what the
    /// critics say by then (Andrychowicz et al. 2020, arXiv 2006.05990), for a forward pass more.
    #[serde(default)]
    pub recompute_advantages: bool,
    /// Steps that gradients flow back through: longer rollouts are learned from in trajectories of
    /// so many steps, each of which begins in the state that the actor had there. Advantages are
    /// still those of the whole rollout. `null` for whole rollouts.
    #[serde(default)]
    pub recurrence: Option<usize>,
    /// Discount.
    pub gamma: f64,
    /// Discount at the end of the schedule, reached linearly (François-Lavet et al. 2015, arXiv
    /// 1512.02011, raise it while an agent learns); `null` for a constant one. Costs follow unless
    /// they have a discount of their own.
    #[serde(default)]
    pub final_gamma: Option<f64>,
    /// Lambda of the advantage estimate.
    pub gae_lambda: f64,
    /// Lambda at the end of the schedule, reached linearly; `null` for a constant one.
    #[serde(default)]
    pub final_gae_lambda: Option<f64>,
    /// Least deviation that advantages are divided by, in units of reward: those that deviate less
    /// are made smaller than 1, so that while nothing is earned a policy does not follow the noise
    /// of its critics; 0 for none.
    #[serde(default)]
    pub advantage_floor: f64,
    /// Learning rate; set alone, by `--set`, it is constant.
    pub rate: f64,
    /// Learning rate at the end of the schedule, reached linearly; `null` for a constant one.
    pub final_rate: Option<f64>,
    /// Frames after which the schedules of rates, exploration and budgets, and of the PID's
    /// reference budget, are over; `null` for the length that the run is begun with, which a run then writes
    /// down here: it keeps its schedule when it is extended.
    #[serde(default)]
    pub schedule_frames: Option<u64>,
    /// Share of the schedule at which the budgets that learning aims at have come down, in a
    /// straight line, from what the first episodes cost, one a world; `null` for budgets that are
    /// the same from the start. A constraint that costs less at first than is aimed at has nothing
    /// to come down from. Evaluations and the choice of a checkpoint go by the budgets themselves.
    #[serde(default)]
    pub budget_annealing: Option<f64>,
    /// Where annealed budgets start, in multiples of what is aimed at in the end; `null` for what
    /// the first episodes cost.
    #[serde(default)]
    pub budget_annealing_start: Option<f64>,
    /// What steps the weights of convolutions, dense and recurrent layers: `adam`, or `muon` (Jordan
    /// et al. 2024), whose step of a matrix is as long in all directions, for more arithmetic. Heads
    /// and biases are Adam's.
    #[serde(default)]
    pub optimiser: Optimiser,
    /// Muon: root mean square of the entries of a matrix's step, in learning rates (Liu et al. 2025,
    /// arXiv 2502.16982, 0.2, which is about Adam's).
    #[serde(default = "half")]
    pub muon_scale: f64,
    /// Adam's decays, the first of which is that of Muon's momentum.
    pub adam_betas: (f64, f64),
    /// Adam's epsilon.
    pub adam_epsilon: f64,
    /// Divergence of the policy from the one that acted, mean over the rollout after an epoch,
    /// beyond which the rollout is learned from no further; `null` for all epochs in any case.
    #[serde(default)]
    pub target_kl: Option<f64>,
    /// Learning rate of critics that are networks of their own; `null` for that of the policy. It
    /// follows the same schedule.
    #[serde(default)]
    pub critic_rate: Option<f64>,
    /// Discount of costs; `null` for that of rewards.
    #[serde(default)]
    pub cost_gamma: Option<f64>,
    /// Returns of costs are normalised by the moments of the reward's returns, which they move too,
    /// and values of costs are used as the network says them: a fault of the code that made
    /// PPOLag's tables, to be had on request.
    #[serde(default)]
    pub cost_uses_reward_normaliser: bool,
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
    /// Its weight at the end of the schedule, reached linearly; `null` for a constant one.
    #[serde(default)]
    pub final_exploration_coefficient: Option<f64>,
    /// What brings returns to one scale for the critics.
    #[serde(default)]
    pub normaliser: ReturnNormaliser,
    /// PopArt: samples that its moments remember.
    #[serde(default = "a_hundred_rollouts")]
    pub normaliser_horizon: f64,
    /// Time-outs count as cut-off rather than as ends: the value of what would have come is added.
    pub bootstrap_time_outs: bool,
    /// The same for costs; `null` for what holds for rewards, unless critics see the time left:
    /// then the limit is part of the task, and nothing comes after it that a budget of an episode
    /// counts.
    #[serde(default)]
    pub bootstrap_cost_time_outs: Option<bool>,
    /// What the critics see and the policy does not; such as `["time-left","budget-spent"]`. Of
    /// the player there are `health`, `ammunition` and `position`, and of what is in its picture
    /// `in-view`.
    #[serde(default)]
    pub critic_inputs: Vec<CriticInput>,
    /// After every so many rollouts the critics make epochs of their own, in which the policy is
    /// held where it is (Cobbe et al. 2021, arXiv 2009.04416); `null` for none.
    #[serde(default)]
    pub value_phase: Option<u64>,
    /// How many epochs these are, over the latest rollout.
    #[serde(default = "six")]
    pub value_phase_passes: usize,
    /// Weight of the policy's divergence from what it was, in these epochs.
    #[serde(default = "one")]
    pub value_phase_clone: f64,
    /// Weight of a loss by which what policy and critics are computed from predicts the depth of
    /// the picture, in eight bands in each cell of a grid of 4 by 8 (Mirowski et al. 2017, arXiv
    /// 1611.03673); 0 for none. Agents are handed on without what predicts it.
    #[serde(default)]
    pub auxiliary_depth: f64,
    /// The same of which of ten groups of things, or none, each cell shows most of.
    #[serde(default)]
    pub auxiliary_labels: f64,
    /// The first forward pass over a rollout is not computed but taken from the actors, in
    /// synchronous runs, which is faster. Statistics of pixels then follow one rollout later;
    /// docs/tried/reused_forward_pass.md has what agents learned with it. Where `recurrence` cuts
    /// rollouts the pass is computed all the same, for what actors would keep of so many steps
    /// fills the memory, but what is learned still begins at the very policy that acted.
    #[serde(default)]
    pub reuse_forward: bool,
    /// Threads.
    pub threads: usize,
    /// Plain kernels, whose results have the same bits on every machine; otherwise the fastest that
    /// the processor has.
    #[serde(default)]
    pub portable: bool,
    /// What the factors of the networks' products are rounded to; `HASARD_SIMD=avx512bf16` or `amxbf16` begins
    /// runs with `bfloat16`.
    #[serde(default)]
    pub products: Products,
}

impl LearningConfig {
    /// Whether the value of what would have come after a time-out counts: of the rewards, or of the
    /// costs.
    #[must_use]
    pub fn bootstraps(&self, costs: bool) -> bool {
        let known = self.bootstrap_time_outs
            && !(costs && self.critic_inputs.contains(&CriticInput::TimeLeft));
        if costs {
            self.bootstrap_cost_time_outs.unwrap_or(known)
        } else {
            self.bootstrap_time_outs
        }
    }

    /// The learning rate after a share of the schedule, from 0 to 1.
    #[must_use]
    pub fn rate_after(&self, share: f64) -> f64 {
        between(self.rate, self.final_rate, share)
    }

    /// Weight of the exploration loss after a share of the schedule, from 0 to 1.
    #[must_use]
    pub fn exploration_after(&self, share: f64) -> f64 {
        between(self.exploration_coefficient, self.final_exploration_coefficient, share)
    }

    /// Discount and lambda after a share of the schedule, from 0 to 1.
    #[must_use]
    pub fn horizon_after(&self, share: f64) -> (f64, f64) {
        (
            between(self.gamma, self.final_gamma, share),
            between(self.gae_lambda, self.final_gae_lambda, share),
        )
    }
}

/// A linear schedule after a share of it; constant without an end.
fn between(first: f64, last: Option<f64>, share: f64) -> f64 {
    first + (last.unwrap_or(first) - first) * share.min(1.0)
}
