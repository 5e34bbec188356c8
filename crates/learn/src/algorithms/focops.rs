//! FOCOPS: first-order constrained optimisation in policy space (Zhang et al. 2020, arXiv 2002.06506).
//!
//! The best policy within a trust region is known in closed form before it is a network; the network is then drawn
//! towards it by its gradient: divergence from the policy that acted minus the ratio-weighted advantage over a
//! temperature, on those samples alone whose divergence is still small.

use super::multiplier::{Lagrange, Multipliers};
use super::surrogate::{lagrangian_advantages, ratio, standardised, total};
use super::{Algorithm, Signal};
use crate::config::{LearningConfig, TrainConfig};
use crate::error::LearnError;
use crate::learning::learner::{Heads, Learner, Loss, Minibatch};
use crate::learning::metrics::Means;
use burn::tensor::Tensor;

/// First-order constrained optimisation in policy space.
pub struct Focops {
    settings: LearningConfig,
    eta: f64,
    temperature: f64,
    multipliers: Multipliers,
}

impl Focops {
    /// FOCOPS with a run's settings.
    #[must_use]
    pub fn new(config: &TrainConfig) -> Focops {
        let settings = &config.algorithm_settings;
        Focops {
            settings: config.learning.clone(),
            eta: settings.focops_eta,
            temperature: settings.focops_temperature,
            multipliers: Lagrange::all(settings, config.constraints.len(), Some(settings.multiplier_limit)),
        }
    }

    pub(super) fn loss(&self, advantages: &Tensor<1>, heads: &Heads, batch: &Minibatch<'_>) -> Loss {
        let divergence = heads.policy.divergence(&batch.old_policy);
        let near = divergence.clone().lower_equal_scalar(self.eta).float().detach();
        let gain = ratio(heads, batch) * advantages.clone() / self.temperature;
        total(((divergence - gain) * near).mean(), heads, batch, &self.settings)
    }
}

impl Algorithm for Focops {
    fn update(
        &mut self,
        learner: &mut Learner,
        minibatch: &mut Minibatch<'_>,
        _signals: &[Signal],
        means: &mut Means,
    ) -> Result<(), LearnError> {
        let advantages = standardised(lagrangian_advantages(minibatch, &self.multipliers()));
        let advantages = minibatch.tensor(advantages);
        let loss = |heads: &Heads, batch: &Minibatch<'_>| self.loss(&advantages, heads, batch);
        learner.descend(minibatch, loss, means)
    }

    fn weights(&self) -> Option<&Multipliers> {
        Some(&self.multipliers)
    }

    fn weights_mut(&mut self) -> Option<&mut Multipliers> {
        Some(&mut self.multipliers)
    }
}
