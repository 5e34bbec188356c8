//! TRPO: trust-region policy optimisation (Schulman et al. 2015, arXiv 1502.05477). Costs are
//! ignored.
//!
//! The policy moves along the natural gradient to the edge of a trust region, then back until the
//! surrogate has improved and the divergence is within its bound; the critics make some steps of
//! Adam. Policy and critics are separate networks.
//!
//! The released code differs: its gradient is that of the log-probabilities and the exploration
//! loss, its line search compares that value with one without the exploration loss (and, with
//! multipliers, of the reward alone), and the cost critic never learns.

use crate::algorithms::surrogate::{exploration_loss, standardised};
use crate::algorithms::trust_region::{TrustRegion, train_critics};
use crate::algorithms::{Algorithm, Signal};
use crate::config::{LearningConfig, TrainConfig};
use crate::error::LearnError;
use crate::learning::learner::{Learner, Minibatch};
use crate::learning::loss::{Heads, Loss};
use crate::learning::metrics::Means;

/// TRPO.
pub struct Trpo {
    settings: LearningConfig,
    region: TrustRegion,
    consistent: bool,
}

impl Trpo {
    /// TRPO with a run's settings.
    #[must_use]
    pub fn new(config: &TrainConfig) -> Trpo {
        Trpo {
            settings: config.learning.clone(),
            region: TrustRegion::new(config),
            consistent: config.algorithm_settings.trpo_consistent,
        }
    }

    /// One step for advantages in raw units, whose reward part alone is that of the minibatch.
    pub fn step(
        &self,
        learner: &mut Learner,
        minibatch: &mut Minibatch<'_>,
        mixed: Vec<f32>,
        means: &mut Means,
    ) -> Result<(), LearnError> {
        let advantages = standardised(&mixed, &self.settings);
        let reward_advantages = standardised(minibatch.advantages(), &self.settings);
        let consistent = self.consistent;
        let (kind, coefficient) = (self.settings.exploration, minibatch.exploration_coefficient);
        let objective = |heads: &Heads, advantages: &[f64], explore: bool| -> Loss {
            let gain = if consistent { &heads.ratio } else { &heads.log_probability };
            let loss = heads.mean([gain], |row, [gain]| -(gain * advantages[row]));
            if explore { loss + exploration_loss(heads, kind, coefficient) } else { loss }
        };
        let region = &self.region;
        let mut origin = region.origin(learner, minibatch);
        let loss = objective(&origin.heads, &advantages, true);
        let before = loss.value;
        means.add("policy_loss", before);
        let gradient = region.gradient(learner, minibatch, &loss);
        let solution = region.solve(learner, &mut origin, &gradient);
        let curvature = learner.vectors().dot(&solution.direction, &solution.product);
        let length = if curvature > 0.0 { (2.0 * region.radius / curvature).sqrt() } else { 0.0 };
        let step: Vec<f32> =
            solution.direction.iter().map(|value| (-length * f64::from(*value)) as f32).collect();
        let searched = if consistent { &advantages } else { &reward_advantages };
        region.search(learner, minibatch, &origin, &step, means, |heads, divergence| {
            objective(heads, searched, consistent).value < before && divergence <= region.radius
        });
        let critics = if consistent { 1 + learner.shape().cost_critics } else { 1 };
        train_critics(learner, minibatch, critics, means)
    }
}

impl Algorithm for Trpo {
    fn update(
        &mut self,
        learner: &mut Learner,
        minibatch: &mut Minibatch<'_>,
        _signals: &[Signal],
        means: &mut Means,
    ) -> Result<(), LearnError> {
        let advantages = minibatch.advantages().to_vec();
        self.step(learner, minibatch, advantages, means)
    }
}
