//! TRPOPID: TRPO with multipliers moved by PID controllers (Stooke et al. 2020, arXiv 2007.03964).

use serde_json::Value;

use super::multiplier::Pid;
use super::surrogate::lagrangian_advantages;
use super::trpo::Trpo;
use super::{Algorithm, Signal};
use crate::config::TrainConfig;
use crate::error::LearnError;
use crate::learner::{Learner, Minibatch};
use crate::metrics::Means;

/// TRPO with PID-controlled multipliers.
pub struct TrpoPid {
    trpo: Trpo,
    controllers: Vec<Pid>,
}

impl TrpoPid {
    /// TRPOPID with a run's settings.
    #[must_use]
    pub fn new(config: &TrainConfig) -> TrpoPid {
        let controllers = Pid::all(&config.algorithm_settings, config.constraints.len());
        TrpoPid { trpo: Trpo::new(config), controllers }
    }
}

impl Algorithm for TrpoPid {
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
        let advantages = lagrangian_advantages(minibatch, &self.multipliers());
        self.trpo.step(learner, minibatch, advantages, means)
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
