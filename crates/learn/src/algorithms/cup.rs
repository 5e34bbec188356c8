//! CUP: constrained update projection (Yang et al. 2022, arXiv 2209.07089).
//!
//! Two steps on every minibatch: first PPO on the reward alone, then a projection back towards the constraints that
//! lowers the costs' surrogates, weighted by multipliers, while staying near the policy that acted.

use super::multiplier::{Lagrange, Multipliers};
use super::surrogate::{centred, standardised};
use super::{Algorithm, Signal, ppo};
use crate::config::{LearningConfig, TrainConfig};
use crate::error::LearnError;
use crate::learning::learner::{Learner, Minibatch};
use crate::learning::loss::{Heads, Loss};
use crate::learning::metrics::Means;

/// Constrained update projection.
pub struct Cup {
    settings: LearningConfig,
    multipliers: Multipliers,
}

impl Cup {
    /// CUP with a run's settings.
    #[must_use]
    pub fn new(config: &TrainConfig) -> Cup {
        let settings = &config.algorithm_settings;
        let multipliers = Lagrange::all(settings, config.constraints.len(), Some(settings.multiplier_limit));
        Cup { settings: config.learning.clone(), multipliers }
    }

    /// The loss of the second step.
    pub(super) fn projection(&self, costs: &[Vec<f64>], heads: &Heads, batch: &Minibatch<'_>, means: &mut Means) -> Loss {
        let (gamma, lambda) = (self.settings.gamma, self.settings.gae_lambda);
        let coefficient = (1.0 - gamma * lambda) / (1.0 - gamma).max(1e-6);
        let mut total = heads.mean_of(&heads.policy.divergence(&batch.old_policy));
        for (advantages, multiplier) in costs.iter().zip(self.multipliers()) {
            let surrogate = heads.mean([&heads.ratio], |row, [ratio]| ratio * advantages[row]);
            total = total + surrogate * (multiplier * coefficient);
        }
        means.add("projection_loss", total.value);
        total
    }
}

impl Algorithm for Cup {
    fn update(
        &mut self,
        learner: &mut Learner,
        minibatch: &mut Minibatch<'_>,
        _signals: &[Signal],
        means: &mut Means,
    ) -> Result<(), LearnError> {
        let advantages = standardised(minibatch.advantages());
        learner.descend(minibatch, |heads, batch, means| ppo::loss(&advantages, heads, batch, &self.settings, means), means)?;

        let costs: Vec<_> = minibatch.costs().iter().map(|cost| centred(&cost.advantages)).collect();
        learner.descend(minibatch, |heads, batch, means| self.projection(&costs, heads, batch, means), &mut Means::default())
    }

    fn weights(&self) -> Option<&Multipliers> {
        Some(&self.multipliers)
    }

    fn weights_mut(&mut self) -> Option<&mut Multipliers> {
        Some(&mut self.multipliers)
    }
}
