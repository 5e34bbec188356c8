//! FOCOPS: first-order constrained optimisation in policy space (Zhang et al. 2020,
//! arXiv 2002.06506).
//!
//! The best policy within a trust region is known in closed form before it is a network; the
//! network is then drawn towards it by its gradient: divergence from the policy that acted minus
//! the ratio-weighted advantage over a temperature, on those samples alone whose divergence is
//! still small. As in the paper's algorithm 1, multipliers move once a rollout, unless the settings
//! say otherwise, and epochs end when the policy has left the trust region.

use crate::algorithms::multiplier::{Lagrange, Multipliers};
use crate::algorithms::surrogate::{lagrangian_advantages, standardised, total};
use crate::algorithms::{Algorithm, Signal};
use crate::config::{LearningConfig, TrainConfig};
use crate::error::LearnError;
use crate::learning::dual_number::DualNumber;
use crate::learning::learner::{Learner, Minibatch};
use crate::learning::loss::{Heads, Loss};
use crate::learning::metrics::Means;

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
            multipliers: Lagrange::all(settings, config.constraints.len()),
        }
    }

    /// Divergence from the policy that acted minus the gain, on the samples that are still near it.
    pub(super) fn loss(
        &self,
        advantages: &[f64],
        heads: &Heads,
        batch: &Minibatch<'_>,
        means: &mut Means,
    ) -> Loss {
        let divergence = heads.policy.divergence(&batch.old_policy);
        let policy_loss = heads.mean([&heads.ratio, &divergence], |row, [ratio, divergence]| {
            if divergence.value <= self.eta {
                divergence - ratio * advantages[row] / self.temperature
            } else {
                DualNumber::constant(0.0)
            }
        });
        total(policy_loss, heads, batch, &self.settings, means)
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
        let advantages =
            standardised(&lagrangian_advantages(minibatch, &self.multipliers()), &self.settings);
        learner.descend(
            minibatch,
            |heads, batch, means| self.loss(&advantages, heads, batch, means),
            means,
        )
    }

    fn weights(&self) -> Option<&Multipliers> {
        Some(&self.multipliers)
    }

    fn weights_mut(&mut self) -> Option<&mut Multipliers> {
        Some(&mut self.multipliers)
    }
}
