//! IPO: interior-point policy optimisation (Liu et al. 2020, arXiv 1910.09615).
//!
//! A logarithmic barrier keeps the cost inside the budget. Its slope kappa / (budget - cost) takes the multiplier's
//! place: it grows without bound towards the budget, and is cut off at a largest penalty, which also rules beyond it.

use super::surrogate::{lagrangian_advantages, standardised};
use super::{Algorithm, Signal, ppo};
use crate::config::{LearningConfig, TrainConfig};
use crate::error::LearnError;
use crate::learning::learner::{Learner, Minibatch};
use crate::learning::metrics::Means;

/// Interior-point policy optimisation.
pub struct Ipo {
    settings: LearningConfig,
    kappa: f64,
    limit: f64,
    penalties: Vec<f64>,
}

impl Ipo {
    /// IPO with a run's settings.
    #[must_use]
    pub fn new(config: &TrainConfig) -> Ipo {
        let settings = &config.algorithm_settings;
        Ipo {
            settings: config.learning.clone(),
            kappa: settings.ipo_kappa,
            limit: settings.ipo_limit,
            penalties: vec![0.0; config.constraints.len()],
        }
    }
}

/// The barrier's slope.
fn slope(kappa: f64, limit: f64, excess: f64) -> f64 {
    if excess >= 0.0 { limit } else { (kappa / -excess).min(limit) }
}

impl Algorithm for Ipo {
    fn constrain(&mut self, signals: &[Signal]) {
        for (penalty, signal) in self.penalties.iter_mut().zip(signals) {
            *penalty = slope(self.kappa, self.limit, signal.episode_excess());
        }
    }

    fn update(
        &mut self,
        learner: &mut Learner,
        minibatch: &mut Minibatch<'_>,
        _signals: &[Signal],
        means: &mut Means,
    ) -> Result<(), LearnError> {
        let advantages = standardised(&lagrangian_advantages(minibatch, &self.penalties));
        learner.descend(minibatch, |heads, batch, means| ppo::loss(&advantages, heads, batch, &self.settings, means), means)
    }

    fn multipliers(&self) -> Vec<f64> {
        self.penalties.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_barrier_grows_towards_the_budget_and_is_cut_off() {
        assert_eq!(slope(0.01, 1.0, -50.0), 0.0002);
        assert_eq!(slope(0.01, 1.0, -0.001), 1.0);
        assert_eq!(slope(0.01, 1.0, 0.0), 1.0);
        assert_eq!(slope(0.01, 1.0, 30.0), 1.0);
    }
}
