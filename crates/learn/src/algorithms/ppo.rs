//! PPO: proximal policy optimisation (Schulman et al. 2017, arXiv 1707.06347). Costs are ignored.
//!
//! PPOCost and PPOSaute are PPO on rewards of another shape: [`ppo_cost`](super::ppo_cost),
//! [`ppo_saute`](super::ppo_saute).

use crate::algorithms::surrogate::{clipped_policy_loss, standardised, total};
use crate::algorithms::{Algorithm, Signal};
use crate::config::{LearningConfig, TrainConfig};
use crate::error::LearnError;
use crate::learning::learner::{Learner, Minibatch};
use crate::learning::loss::{Heads, Loss};
use crate::learning::metrics::Means;

/// PPO.
pub struct Ppo {
    settings: LearningConfig,
}

impl Ppo {
    /// PPO with a run's settings.
    #[must_use]
    pub fn new(config: &TrainConfig) -> Ppo {
        Ppo { settings: config.learning.clone() }
    }
}

/// PPO's loss for standardised advantages of any kind.
pub fn loss(
    advantages: &[f64],
    heads: &Heads,
    minibatch: &Minibatch<'_>,
    settings: &LearningConfig,
    means: &mut Means,
) -> Loss {
    total(
        clipped_policy_loss(heads, advantages, settings.clip_ratio),
        heads,
        minibatch,
        settings,
        means,
    )
}

impl Algorithm for Ppo {
    fn update(
        &mut self,
        learner: &mut Learner,
        minibatch: &mut Minibatch<'_>,
        _signals: &[Signal],
        means: &mut Means,
    ) -> Result<(), LearnError> {
        let advantages = standardised(minibatch.advantages(), &self.settings);
        learner.descend(
            minibatch,
            |heads, batch, means| loss(&advantages, heads, batch, &self.settings, means),
            means,
        )
    }
}
