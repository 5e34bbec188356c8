//! PPO: proximal policy optimisation (Schulman et al. 2017, arXiv 1707.06347). Costs are ignored.
//!
//! PPOCost and PPOSaute (Sootla et al. 2022, arXiv 2202.06558) are PPO on rewards of another shape, see
//! [`crate::sampling::shaping`]: reward minus cost, and a safety state that turns the reward bad once the budget is spent.

use burn::tensor::Tensor;

use super::surrogate::{clipped_policy_loss, ratio, standardised, total};
use super::{Algorithm, Signal};
use crate::config::{LearningConfig, TrainConfig};
use crate::error::LearnError;
use crate::learning::learner::{Heads, Learner, Loss, Minibatch};
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
pub fn loss(advantages: &Tensor<1>, heads: &Heads, minibatch: &Minibatch<'_>, settings: &LearningConfig) -> Loss {
    let policy_loss = clipped_policy_loss(&ratio(heads, minibatch), advantages, settings.clip_ratio);
    total(policy_loss, heads, minibatch, settings)
}

impl Algorithm for Ppo {
    fn update(
        &mut self,
        learner: &mut Learner,
        minibatch: &mut Minibatch<'_>,
        _signals: &[Signal],
        means: &mut Means,
    ) -> Result<(), LearnError> {
        let advantages = minibatch.tensor(standardised(minibatch.advantages[0].clone()));
        learner.descend(minibatch, |heads, batch| loss(&advantages, heads, batch, &self.settings), means)
    }
}
