//! CUP: constrained update projection (Yang et al. 2022, arXiv 2209.07089).
//!
//! Two steps on every minibatch: first PPO on the reward alone, then a projection back towards the constraints that
//! lowers the costs' surrogates, weighted by multipliers, while staying near the policy that acted.

use super::multiplier::{Lagrange, Multipliers};
use super::surrogate::{centred, ratio, standardised};
use super::{Algorithm, Signal, ppo};
use crate::config::{LearningConfig, TrainConfig};
use crate::error::LearnError;
use crate::learning::learner::{Heads, Learner, Loss, Minibatch};
use crate::learning::metrics::Means;
use burn::tensor::Tensor;

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
    pub(super) fn projection(&self, costs: &[Tensor<1>], heads: &Heads, batch: &Minibatch<'_>) -> Loss {
        let (gamma, lambda) = (f64::from(self.settings.gamma), f64::from(self.settings.gae_lambda));
        let coefficient = (1.0 - gamma * lambda) / (1.0 - gamma).max(1e-6);
        let ratio = ratio(heads, batch);
        let mut total = heads.policy.divergence(&batch.old_policy).mean();
        for (advantages, multiplier) in costs.iter().zip(self.multipliers()) {
            total = total + (ratio.clone() * advantages.clone()).mean() * (multiplier * coefficient);
        }
        Loss { parts: vec![("projection_loss", total.clone())], total }
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
        let advantages = minibatch.tensor(standardised(minibatch.advantages[0].clone()));
        learner.descend(minibatch, |heads, batch| ppo::loss(&advantages, heads, batch, &self.settings), means)?;

        let costs: Vec<_> =
            minibatch.advantages[1..].iter().map(|advantages| minibatch.tensor(centred(advantages.clone()))).collect();
        let projection = |heads: &Heads, batch: &Minibatch<'_>| self.projection(&costs, heads, batch);
        learner.descend(minibatch, projection, &mut Means::default())
    }

    fn weights(&self) -> Option<&Multipliers> {
        Some(&self.multipliers)
    }

    fn weights_mut(&mut self) -> Option<&mut Multipliers> {
        Some(&mut self.multipliers)
    }
}
