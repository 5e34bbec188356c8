//! TRPOPID: TRPO with multipliers moved by PID controllers (Stooke et al. 2020, arXiv 2007.03964).

use super::multiplier::{Multipliers, Pid};
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
    multipliers: Multipliers,
}

impl TrpoPid {
    /// TRPOPID with a run's settings.
    #[must_use]
    pub fn new(config: &TrainConfig) -> TrpoPid {
        let multipliers = Pid::all(&config.algorithm_settings, config.constraints.len());
        TrpoPid { trpo: Trpo::new(config), multipliers }
    }
}

impl Algorithm for TrpoPid {
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

    fn weights(&self) -> Option<&Multipliers> {
        Some(&self.multipliers)
    }

    fn weights_mut(&mut self) -> Option<&mut Multipliers> {
        Some(&mut self.multipliers)
    }
}
