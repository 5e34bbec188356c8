//! P3O: penalised proximal policy optimisation (Zhang et al. 2022, arXiv 2205.11814).
//!
//! The constraint enters the loss as an exact penalty: kappa times the positive part of what the cost is expected to
//! become, the cost's surrogate plus the present excess. There is no multiplier to wait for.
//!
//! As the paper has it the surrogate is clipped pessimistically and the excess is (1 - gamma)(J_C - d) of an episode; the
//! released code uses the plain ratio, the excess per step and kappa 1, which leaves little more than a switch on the
//! sign of the excess.

use burn::tensor::Tensor;

use super::surrogate::{clip_ratio, clipped_policy_loss, ratio, standardised, total};
use super::{Algorithm, Signal};
use crate::config::{LearningConfig, TrainConfig};
use crate::error::LearnError;
use crate::learning::learner::{Heads, Learner, Loss, Minibatch};
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

    /// The penalty of one constraint from the ratios and the standardised advantages of its cost.
    fn penalty(&self, ratio: &Tensor<1>, advantages: &Tensor<1>, signal: &Signal) -> Tensor<1> {
        let plain = ratio.clone() * advantages.clone();
        let expected = if self.clipped {
            let clipped = clip_ratio(ratio.clone(), self.settings.clip_ratio) * advantages.clone();
            plain.max_pair(clipped).mean() + (1.0 - f64::from(self.settings.gamma)) * signal.episode_excess()
        } else {
            plain.mean() + signal.step_excess()
        };
        expected.clamp_min(0.0) * self.kappa
    }

    /// PPO's loss and the penalty of each constraint.
    pub(super) fn loss(
        &self,
        advantages: &Tensor<1>,
        cost_advantages: &[Tensor<1>],
        signals: &[Signal],
        heads: &Heads,
        batch: &Minibatch<'_>,
    ) -> Loss {
        let ratio = ratio(heads, batch);
        let policy_loss = clipped_policy_loss(&ratio, advantages, self.settings.clip_ratio);
        let mut loss = total(policy_loss, heads, batch, &self.settings);
        for (advantages, signal) in cost_advantages.iter().zip(signals) {
            let penalty = self.penalty(&ratio, advantages, signal);
            loss.total = loss.total + penalty.clone();
            loss.parts.push(("policy_cost_loss", penalty));
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
        let advantages = minibatch.tensor(standardised(minibatch.advantages[0].clone()));
        let cost_advantages: Vec<_> =
            minibatch.advantages[1..].iter().map(|advantages| minibatch.tensor(standardised(advantages.clone()))).collect();
        let loss = |heads: &Heads, batch: &Minibatch<'_>| self.loss(&advantages, &cost_advantages, signals, heads, batch);
        learner.descend(minibatch, loss, means)
    }
}
