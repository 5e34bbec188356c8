//! P3O: penalised proximal policy optimisation (Zhang et al. 2022, arXiv 2205.11814).
//!
//! The constraint enters the loss as an exact penalty: kappa times the positive part of what the
//! cost is expected to become, the cost's surrogate plus the present excess. There is no multiplier
//! to wait for.
//!
//! As the paper has it the surrogate is clipped pessimistically. Its advantages are standardised,
//! as its authors' are, so the excess is divided by the same deviation: (J_C - d) / (L sigma_C),
//! `sigma_C` at least `advantage_floor`: where nothing costs anything, its advantages are noise.
//! (The paper's (1 - gamma)(J_C - d) is the excess of discounted costs a step; budgets here are on
//! sums, whose excess a step is that over the L steps that episodes have on average.) The released
//! code uses the plain ratio, the excess per step beside standardised advantages, and kappa 1, which leaves
//! little more than a switch on the sign of the excess. So does a single pass over a single
//! minibatch, under any preset: ratios are 1 there and the surrogate is 0.

use crate::algorithms::surrogate::{clip_ratio, standardised, standardised_by};
use crate::algorithms::{Algorithm, Signal, ppo};
use crate::config::{LearningConfig, TrainConfig};
use crate::error::LearnError;
use crate::learning::learner::{Learner, Minibatch};
use crate::learning::loss::{Heads, Loss};
use crate::learning::metrics::Means;

/// Penalised PPO.
pub struct P3o {
    settings: LearningConfig,
    kappa: f64,
    clipped: bool,
}

impl P3o {
    /// P3O with a run's settings.
    #[must_use]
    pub fn new(config: &TrainConfig) -> P3o {
        let settings = &config.algorithm_settings;
        P3o {
            settings: config.learning.clone(),
            kappa: settings.p3o_kappa,
            clipped: settings.p3o_clipped,
        }
    }

    /// The penalty of one constraint from the advantages of its cost, in raw units.
    fn penalty(&self, heads: &Heads, advantages: &[f32], signal: &Signal) -> Loss {
        let (advantages, deviation) = standardised_by(advantages, self.settings.advantage_floor);
        let expected = if self.clipped {
            let surrogate = heads.mean([&heads.ratio], |row, [ratio]| {
                (ratio * advantages[row])
                    .max(clip_ratio(ratio, self.settings.clip_ratio) * advantages[row])
            });
            surrogate + signal.surrogate_excess() / deviation
        } else {
            heads.mean([&heads.ratio], |row, [ratio]| ratio * advantages[row])
                + signal.step_excess()
        };
        expected.positive_part() * self.kappa
    }

    /// PPO's loss and the penalty of each constraint.
    pub(super) fn loss(
        &self,
        advantages: &[f64],
        signals: &[Signal],
        heads: &Heads,
        batch: &Minibatch<'_>,
        means: &mut Means,
    ) -> Loss {
        let mut loss = ppo::loss(advantages, heads, batch, &self.settings, means);
        for (cost, signal) in batch.costs().iter().zip(signals) {
            let penalty = self.penalty(heads, &cost.advantages, signal);
            means.add("policy_cost_loss", penalty.value);
            loss = loss + penalty;
        }
        loss
    }
}

impl Algorithm for P3o {
    fn update(
        &mut self,
        learner: &mut Learner,
        minibatch: &mut Minibatch<'_>,
        signals: &[Signal],
        means: &mut Means,
    ) -> Result<(), LearnError> {
        let advantages = standardised(minibatch.advantages(), &self.settings);
        let loss = |heads: &Heads, batch: &Minibatch<'_>, means: &mut Means| {
            self.loss(&advantages, signals, heads, batch, means)
        };
        learner.descend(minibatch, loss, means)
    }
}
