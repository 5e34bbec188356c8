//! PPOLag: PPO with a Lagrange multiplier on each constraint (Ray et al. 2019).
//!
//! The multiplier grows with the excess over the budget before every update; the advantages are
//! those of the reward minus those of the costs times the multipliers, mixed in raw units and then
//! standardised.

use crate::algorithms::multiplier::{Lagrange, Multipliers};
use crate::algorithms::surrogate::{lagrangian_advantages, standardised};
use crate::algorithms::{Algorithm, Signal, ppo};
use crate::config::{LearningConfig, TrainConfig};
use crate::error::LearnError;
use crate::learning::learner::{Learner, Minibatch};
use crate::learning::metrics::Means;

/// PPO with Lagrange multipliers.
pub struct PpoLag {
    settings: LearningConfig,
    multipliers: Multipliers,
}

impl PpoLag {
    /// PPOLag with a run's settings.
    #[must_use]
    pub fn new(config: &TrainConfig) -> PpoLag {
        PpoLag::moved_by(
            Lagrange::all(&config.algorithm_settings, config.constraints.len()),
            config,
        )
    }

    /// The same with multipliers that move by another rule.
    pub(super) fn moved_by(multipliers: Multipliers, config: &TrainConfig) -> PpoLag {
        PpoLag { settings: config.learning.clone(), multipliers }
    }
}

impl Algorithm for PpoLag {
    fn update(
        &mut self,
        learner: &mut Learner,
        minibatch: &mut Minibatch<'_>,
        _signals: &[Signal],
        means: &mut Means,
    ) -> Result<(), LearnError> {
        // The original divides by one plus the multipliers under PID control; that cancels in the
        // standardisation.
        let advantages =
            standardised(&lagrangian_advantages(minibatch, &self.multipliers()), &self.settings);
        learner.descend(
            minibatch,
            |heads, batch, means| ppo::loss(&advantages, heads, batch, &self.settings, means),
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
