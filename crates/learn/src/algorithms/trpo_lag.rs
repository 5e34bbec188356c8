//! TRPOLag: TRPO with a Lagrange multiplier on each constraint (Ray et al. 2019).

use crate::algorithms::multiplier::{Lagrange, Multipliers};
use crate::algorithms::surrogate::lagrangian_advantages;
use crate::algorithms::trpo::Trpo;
use crate::algorithms::{Algorithm, Signal};
use crate::config::TrainConfig;
use crate::error::LearnError;
use crate::learning::learner::{Learner, Minibatch};
use crate::learning::metrics::Means;

/// TRPO with Lagrange multipliers.
pub struct TrpoLag {
    trpo: Trpo,
    multipliers: Multipliers,
}

impl TrpoLag {
    /// TRPOLag with a run's settings.
    #[must_use]
    pub fn new(config: &TrainConfig) -> TrpoLag {
        TrpoLag::moved_by(
            Lagrange::all(&config.algorithm_settings, config.constraints.len()),
            config,
        )
    }

    /// The same with multipliers that move by another rule.
    pub(super) fn moved_by(multipliers: Multipliers, config: &TrainConfig) -> TrpoLag {
        TrpoLag { trpo: Trpo::new(config), multipliers }
    }
}

impl Algorithm for TrpoLag {
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
