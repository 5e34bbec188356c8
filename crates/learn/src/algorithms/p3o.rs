//! P3O: penalised proximal policy optimisation (Zhang et al. 2022, arXiv 2205.11814).
//!
//! The constraint enters the loss as an exact penalty: kappa times the positive part of what the cost is expected to
//! become, the cost's surrogate plus the present excess. There is no multiplier to wait for.
//!
//! As the paper has it the surrogate is clipped pessimistically and the excess is (1 - gamma)(J_C - d) of an episode; the
//! released code uses the plain ratio, the excess per step and kappa 1, which leaves little more than a switch on the
//! sign of the excess.

use super::surrogate::{clip_ratio, standardised};
use super::{Algorithm, Signal, ppo};
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
        P3o { settings: config.learning.clone(), kappa: settings.p3o_kappa, clipped: settings.p3o_clipped }
    }

    /// The penalty of one constraint from the standardised advantages of its cost.
    fn penalty(&self, heads: &Heads, advantages: &[f64], signal: &Signal) -> Loss {
        let expected = if self.clipped {
            let surrogate = heads.mean([&heads.ratio], |row, [ratio]| {
                (ratio * advantages[row]).max(clip_ratio(ratio, self.settings.clip_ratio) * advantages[row])
            });
            surrogate + (1.0 - self.settings.gamma) * signal.episode_excess()
        } else {
            heads.mean([&heads.ratio], |row, [ratio]| ratio * advantages[row]) + signal.step_excess()
        };
        expected.positive_part() * self.kappa
    }

    /// PPO's loss and the penalty of each constraint.
    pub(super) fn loss(
        &self,
        advantages: &[f64],
        cost_advantages: &[Vec<f64>],
        signals: &[Signal],
        heads: &Heads,
        batch: &Minibatch<'_>,
        means: &mut Means,
    ) -> Loss {
        let mut loss = ppo::loss(advantages, heads, batch, &self.settings, means);
        for (advantages, signal) in cost_advantages.iter().zip(signals) {
            let penalty = self.penalty(heads, advantages, signal);
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
        let advantages = standardised(minibatch.advantages());
        let costs: Vec<_> = minibatch.costs().iter().map(|cost| standardised(&cost.advantages)).collect();
        let loss = |heads: &Heads, batch: &Minibatch<'_>, means: &mut Means| {
            self.loss(&advantages, &costs, signals, heads, batch, means)
        };
        learner.descend(minibatch, loss, means)
    }
}
