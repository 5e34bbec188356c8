//! The algorithms by name, and the settings that only some of them have.

use serde::{Deserialize, Serialize};

use crate::config::names::names;

names! {
    /// The algorithms, each in a file of its own under `algorithms`.
    AlgorithmKind ("algorithm") {
        /// Proximal policy optimisation; costs are ignored.
        Ppo = "PPO",
        /// PPO on reward minus scaled cost.
        PpoCost = "PPOCost",
        /// PPO with a Lagrange multiplier.
        PpoLag = "PPOLag",
        /// PPO with the budget as part of the state.
        PpoSaute = "PPOSaute",
        /// PPO with a multiplier moved by a PID controller.
        PpoPid = "PPOPID",
        /// Penalised PPO.
        P3o = "P3O",
        /// Trust-region policy optimisation; costs are ignored.
        Trpo = "TRPO",
        /// TRPO with a Lagrange multiplier.
        TrpoLag = "TRPOLag",
        /// TRPO with a multiplier moved by a PID controller.
        TrpoPid = "TRPOPID",
        /// Constrained policy optimisation.
        Cpo = "CPO",
        /// First-order constrained optimisation in policy space.
        Focops = "FOCOPS",
        /// Constrained update projection.
        Cup = "CUP",
        /// Interior-point policy optimisation.
        Ipo = "IPO",
    }
}

impl AlgorithmKind {
    /// Whether it learns what costs are to be expected.
    #[must_use]
    pub const fn has_cost_critics(self) -> bool {
        !matches!(self, Self::Ppo | Self::PpoCost | Self::PpoSaute | Self::Trpo)
    }

    /// Whether it tries to keep budgets; the others are after the return alone, whatever their
    /// budget says.
    #[must_use]
    pub const fn keeps_budgets(self) -> bool {
        !matches!(self, Self::Ppo | Self::PpoCost | Self::Trpo)
    }

    /// Whether it weighs costs by multipliers that move by what episodes cost.
    #[must_use]
    pub const fn has_multipliers(self) -> bool {
        matches!(
            self,
            Self::PpoLag | Self::PpoPid | Self::TrpoLag | Self::TrpoPid | Self::Focops | Self::Cup
        )
    }

    /// Whether it shapes rewards by a single cost.
    #[must_use]
    pub const fn knows_one_cost(self) -> bool {
        matches!(self, Self::PpoSaute | Self::PpoCost)
    }

    /// Optimiser states of each network: CUP's two steps have one each.
    #[must_use]
    pub const fn optimisers(self) -> usize {
        if matches!(self, Self::Cup) { 2 } else { 1 }
    }

    /// Whether its steps are of the second order; its policy and critics are networks of their own
    /// then.
    #[must_use]
    pub const fn is_second_order(self) -> bool {
        matches!(self, Self::Trpo | Self::TrpoLag | Self::TrpoPid | Self::Cpo)
    }
}

names! {
    /// When multipliers move.
    MultiplierUpdate ("update of the multipliers") {
        /// Once a rollout, before it is learned from, by the episodes that finished since they last
        /// moved.
        Rollout = "rollout",
        /// Before every minibatch, as in the released code.
        Minibatch = "minibatch",
        /// After every minibatch, whose loss still has them as they were, as in the code of the
        /// paper's tables.
        AfterMinibatch = "after-minibatch",
    }
}

/// As in TRPO's paper: the Fisher matrix needs less data than the gradient.
const fn a_tenth() -> f64 {
    0.1
}

/// What files of before say nothing of.
const fn one_step() -> usize {
    1
}

/// What files say that know of no other moment.
const fn every_minibatch() -> MultiplierUpdate {
    MultiplierUpdate::Minibatch
}

/// Numbers of single algorithms.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct AlgorithmConfig {
    /// PPOCost: factor of the cost in the reward.
    pub penalty_scale: f64,
    /// Lagrangian algorithms: the multiplier before the first update.
    pub multiplier_initial: f64,
    /// Lagrangian algorithms: change of the multiplier per update and unit of cost per step above
    /// budget.
    pub multiplier_rate: f64,
    /// Lagrangian and PID algorithms, IPO: when the multiplier, or IPO's penalty, moves.
    #[serde(default = "every_minibatch")]
    pub multiplier_update: MultiplierUpdate,
    /// What older versions added to the multiplier of a Lagrangian algorithm at once, which made a
    /// PID controller of it.
    #[serde(default, skip_serializing, rename = "multiplier_damping")]
    pub(crate) former_damping: f64,
    /// PID: proportional, integral and derivative gains, of cost per step. The multiplier is the
    /// first times the excess over the aim, plus the integral, to which every update adds the second
    /// times the excess, plus the third times the rise of the cost (not its fall) within `pid_delay`
    /// updates; neither it nor the integral is ever below 0. An update comes once a rollout, unless
    /// `multiplier_update` says otherwise.
    pub pid_gains: (f64, f64, f64),
    /// PID: the integral before the first update.
    pub pid_initial: f64,
    /// PID: decay, an update, of the moving averages of error and cost.
    pub pid_decay: f64,
    /// PID: updates that the derivative looks back.
    pub pid_delay: usize,
    /// PID: the budget that the gains are made for; `null` for every budget alike. Toward the end
    /// of training, as the cube of its progress, an excess then counts by its share of the budget,
    /// so that a tenth of the budget moves a multiplier ten times as fast; before, it does not,
    /// since an agent that is held back early never learns to earn. In `quick` it is 450 for runs of
    /// 2 million frames, and less with the root of their length: 201 for 10 million; in Collateral
    /// Damage 45 for 10 million.
    #[serde(default, alias = "multiplier_reference_budget")]
    pub pid_reference_budget: Option<f64>,
    /// P3O: weight of the penalty.
    pub p3o_kappa: f64,
    /// P3O: clipped surrogate, and the excess in the unit of the standardised advantages, as its
    /// paper has it.
    pub p3o_clipped: bool,
    /// Saute: discount of the budget.
    pub saute_gamma: f64,
    /// Saute: reward once the budget is spent.
    pub saute_unsafe_reward: f64,
    /// Saute: the safety state is an input of the network.
    pub saute_visible: bool,
    /// Saute: time over which the budget is spread (steps, or tics as in the released code).
    pub saute_horizon: f64,
    /// Second-order algorithms: bound of the mean divergence of a step.
    pub trust_radius: f64,
    /// Second-order algorithms: iterations of the conjugate-gradient method.
    pub conjugate_iterations: usize,
    /// Second-order algorithms: share of a rollout's trajectories that the Fisher matrix is taken
    /// over.
    #[serde(default = "a_tenth")]
    pub fisher_fraction: f64,
    /// Second-order algorithms: multiple of the identity added to the Fisher matrix.
    pub fisher_damping: f64,
    /// Second-order algorithms: steps of Adam that the critics make in each update of the policy.
    #[serde(default = "one_step")]
    pub critic_steps: usize,
    /// Second-order algorithms: samples of each of these steps, dealt out of the rollout; `null`
    /// for all of it.
    #[serde(default)]
    pub critic_batch: Option<usize>,
    /// Second-order algorithms: tries of the line search.
    pub line_search_steps: usize,
    /// Second-order algorithms: factor between the tries.
    pub line_search_factor: f64,
    /// TRPO family: one objective for gradient and line search, and cost critics that learn. The
    /// released code searches on the reward alone and never trains the cost critic.
    pub trpo_consistent: bool,
    /// FOCOPS: largest divergence of a sample that still counts.
    pub focops_eta: f64,
    /// FOCOPS: temperature.
    pub focops_temperature: f64,
    /// Lagrangian algorithms: largest multiplier; `null` for none.
    pub multiplier_limit: Option<f64>,
    /// IPO: weight of the barrier, as a share of the budget: the penalty is 1 where the cost is
    /// this share below the budget.
    pub ipo_kappa: f64,
    /// IPO: largest penalty, which also rules above the budget, where there is no barrier.
    pub ipo_limit: f64,
}
