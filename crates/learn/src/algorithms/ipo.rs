//! IPO: interior-point policy optimisation (Liu et al. 2020, arXiv 1910.09615).
//!
//! A logarithmic barrier, log(d - J_C) / t, keeps the cost J_C inside the budget d. Its slope, 1 /
//! (t (d - J_C)), takes the multiplier's place: it grows without bound towards the budget. The
//! weight 1 / t is kappa times the budget, so that the slope passes 1 at the same share below every
//! budget, some standard errors of the mean cost below it: nearer, the barrier would be a switch on
//! noise. Beyond the budget, where there is no barrier (the paper begins within it), the largest
//! penalty rules.

use serde_json::{Value, json};

use crate::algorithms::surrogate::{lagrangian_advantages, standardised};
use crate::algorithms::{Algorithm, Signal, ppo};
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

/// The barrier's slope in the cost.
fn slope(kappa: f64, limit: f64, signal: &Signal) -> f64 {
    let left = -signal.episode_excess();
    if left <= 0.0 { limit } else { (kappa * signal.episode_budget / left).min(limit) }
}

impl Algorithm for Ipo {
    fn constrain(&mut self, signals: &[Signal]) {
        for (penalty, signal) in self.penalties.iter_mut().zip(signals) {
            *penalty = slope(self.kappa, self.limit, signal);
        }
    }

    fn update(
        &mut self,
        learner: &mut Learner,
        minibatch: &mut Minibatch<'_>,
        _signals: &[Signal],
        means: &mut Means,
    ) -> Result<(), LearnError> {
        let advantages =
            standardised(&lagrangian_advantages(minibatch, &self.penalties), &self.settings);
        learner.descend(
            minibatch,
            |heads, batch, means| ppo::loss(&advantages, heads, batch, &self.settings, means),
            means,
        )
    }

    fn multipliers(&self) -> Vec<f64> {
        self.penalties.clone()
    }

    fn save(&self) -> Value {
        json!(self.penalties)
    }

    fn load(&mut self, state: &Value) -> Result<(), serde_json::Error> {
        // Older checkpoints have none: the first rollout or minibatch sets them.
        let saved: Option<Vec<f64>> = serde_json::from_value(state.clone())?;
        if let Some(saved) = saved.filter(|saved| saved.len() == self.penalties.len()) {
            self.penalties = saved;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{AlgorithmKind, EnvConfig, Preset};

    /// A14. The slope is the derivative of the paper's barrier, phi(J) = log(d - J) / t (its
    /// equation 8), with 1 / t a tenth of the budget: taken by differences of the logarithm itself.
    /// It passes 1 a tenth of the budget below it: 5 of 50 and 0.5 of 5, where the mean of 32
    /// episodes has a standard error of 1.5 to 4.6 (deviations of 8 to 26) and of 0.35 (2).
    #[test]
    fn the_barrier_has_the_papers_slope_in_units_of_the_budget() {
        let ipo = |cost: f64, budget: f64| {
            let config =
                TrainConfig::plain(AlgorithmKind::Ipo, Preset::Paper, EnvConfig::new("test"));
            let mut ipo = Ipo::new(&config);
            ipo.constrain(&[Signal::steady(cost, budget, 525.0)]);
            ipo.multipliers()[0]
        };
        for budget in [5.0, 50.0] {
            for share in [0.0, 0.5, 0.8, 0.9, 0.97] {
                let (cost, h) = (share * budget, 1e-6);
                let barrier = |cost: f64| -0.1 * budget * (budget - cost).ln();
                let expected = (barrier(cost + h) - barrier(cost - h)) / (2.0 * h);
                let found = ipo(cost, budget);
                assert!(
                    (found - expected).abs() < 1e-4 * expected,
                    "budget {budget}, cost {cost}: {found} against {expected}"
                );
            }
            assert!((ipo(0.9 * budget, budget) - 1.0).abs() < 1e-12);
            // A budget of 5 needs about 3: the barrier gets there within the budget.
            assert!(ipo(0.97 * budget, budget) > 3.0);
        }
        for cost in [50.0, 80.0] {
            assert_eq!(ipo(cost, 50.0), 10.0);
        }
        assert_eq!(ipo(0.0, 0.0), 10.0);
    }

    /// A run that went on began without penalty, and ended as another than the straight one where
    /// penalties move after each minibatch.
    #[test]
    fn penalties_come_back() {
        let config = TrainConfig::plain(AlgorithmKind::Ipo, Preset::Paper, EnvConfig::new("test"));
        let (mut before, mut after) = (Ipo::new(&config), Ipo::new(&config));
        before.constrain(&[Signal::steady(40.0, 50.0, 525.0)]);
        after.load(&before.save()).unwrap();
        assert_eq!(
            (after.multipliers(), after.multipliers()[0] > 0.0),
            (before.multipliers(), true)
        );
        after.load(&Value::Null).unwrap();
    }
}
