//! PPOPID: PPO with multipliers moved by PID controllers (Stooke et al. 2020, arXiv 2007.03964).
//!
//! As PPOLag, but the multiplier also reacts to the excess itself and to its rise.

use super::multiplier::{Multipliers, Pid};
use super::surrogate::{lagrangian_advantages, standardised};
use super::{Algorithm, Signal, ppo};
use crate::config::{LearningConfig, TrainConfig};
use crate::error::LearnError;
use crate::learner::{Learner, Minibatch};
use crate::metrics::Means;

/// PPO with PID-controlled multipliers.
pub struct PpoPid {
    settings: LearningConfig,
    multipliers: Multipliers,
}

impl PpoPid {
    /// PPOPID with a run's settings.
    #[must_use]
    pub fn new(config: &TrainConfig) -> PpoPid {
        let multipliers = Pid::all(&config.algorithm_settings, config.constraints.len());
        PpoPid { settings: config.learning.clone(), multipliers }
    }
}

impl Algorithm for PpoPid {
    fn update(
        &mut self,
        learner: &mut Learner,
        minibatch: &mut Minibatch<'_>,
        _signals: &[Signal],
        means: &mut Means,
    ) -> Result<(), LearnError> {
        // The division by one plus the multipliers of the original cancels in the standardisation.
        let advantages = standardised(lagrangian_advantages(minibatch, &self.multipliers()));
        let advantages = minibatch.tensor(advantages);
        learner.descend(minibatch, |heads, batch| ppo::loss(&advantages, heads, batch, &self.settings), means)
    }

    fn weights(&self) -> Option<&Multipliers> {
        Some(&self.multipliers)
    }

    fn weights_mut(&mut self) -> Option<&mut Multipliers> {
        Some(&mut self.multipliers)
    }
}
