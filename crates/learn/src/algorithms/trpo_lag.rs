//! TRPOLag: TRPO with a Lagrange multiplier on each constraint (Ray et al. 2019).

use serde_json::Value;

use super::multiplier::Lagrange;
use super::surrogate::lagrangian_advantages;
use super::trpo::Trpo;
use super::{Algorithm, Signal};
use crate::config::TrainConfig;
use crate::error::LearnError;
use crate::learner::{Learner, Minibatch};
use crate::metrics::Means;

/// TRPO with Lagrange multipliers.
pub struct TrpoLag {
    trpo: Trpo,
    multipliers: Vec<Lagrange>,
}

impl TrpoLag {
    /// TRPOLag with a run's settings.
    #[must_use]
    pub fn new(config: &TrainConfig) -> TrpoLag {
        let multipliers = Lagrange::all(&config.algorithm_settings, config.constraints.len(), None);
        TrpoLag { trpo: Trpo::new(config), multipliers }
    }
}

impl Algorithm for TrpoLag {
    fn constrain(&mut self, signals: &[Signal]) {
        self.multipliers.iter_mut().zip(signals).for_each(|(multiplier, signal)| multiplier.update(signal));
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
        self.multipliers.iter().map(|multiplier| multiplier.value).collect()
    }

    fn save(&self) -> Value {
        serde_json::to_value(&self.multipliers).unwrap_or_default()
    }

    fn load(&mut self, state: &Value) -> Result<(), serde_json::Error> {
        self.multipliers = serde_json::from_value(state.clone())?;
        Ok(())
    }
}
