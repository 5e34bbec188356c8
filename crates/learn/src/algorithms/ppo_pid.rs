//! PPOPID: PPO with multipliers moved by PID controllers (Stooke et al. 2020, arXiv 2007.03964).
//!
//! As PPOLag, but the multiplier also reacts to the excess itself and to its rise.

use serde_json::Value;

use super::multiplier::Pid;
use super::surrogate::{lagrangian_advantages, standardised};
use super::{Algorithm, Signal, ppo};
use crate::config::{LearningConfig, TrainConfig};
use crate::error::LearnError;
use crate::learner::{Learner, Minibatch};
use crate::metrics::Means;

/// PPO with PID-controlled multipliers.
pub struct PpoPid {
    settings: LearningConfig,
    controllers: Vec<Pid>,
}

impl PpoPid {
    /// PPOPID with a run's settings.
    #[must_use]
    pub fn new(config: &TrainConfig) -> PpoPid {
        let controllers = Pid::all(&config.algorithm_settings, config.constraints.len());
        PpoPid { settings: config.learning.clone(), controllers }
    }
}

impl Algorithm for PpoPid {
    fn constrain(&mut self, signals: &[Signal]) {
        self.controllers.iter_mut().zip(signals).for_each(|(controller, signal)| controller.update(signal));
    }

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

    fn multipliers(&self) -> Vec<f64> {
        self.controllers.iter().map(|controller| controller.value).collect()
    }

    fn save(&self) -> Value {
        serde_json::to_value(&self.controllers).unwrap_or_default()
    }

    fn load(&mut self, state: &Value) -> Result<(), serde_json::Error> {
        self.controllers = serde_json::from_value(state.clone())?;
        Ok(())
    }
}
