//! CUP: constrained update projection (Yang et al. 2022, arXiv 2209.07089).
//!
//! Two steps on every rollout. First PPO on the reward alone, which leaves the policy halfway. Then
//! a projection from there onto the constraints: it lowers the costs' surrogates, weighted by
//! multipliers, while staying near the policy halfway. The steps have optimisers of their own, so
//! that the momentum of the one does not drive the other; and where no multiplier is above zero the
//! policy halfway is its own projection. Both steps end at `target_kl`, the second by its
//! divergence from the policy halfway, and both train the critics, whose trunk they move.

use crate::algorithms::algorithm::{go_through, learn_in_epochs};
use crate::algorithms::multiplier::{Lagrange, Multipliers};
use crate::algorithms::surrogate::{centred, critics_loss, standardised};
use crate::algorithms::{Algorithm, Signal, Signals, ppo};
use crate::config::{LearningConfig, TrainConfig};
use crate::error::LearnError;
use crate::learning::epochs::Epochs;
use crate::learning::learner::{Learner, Minibatch, Prepared};
use crate::learning::loss::{Heads, Loss};
use crate::learning::metrics::Means;
use crate::learning::policy::Policy;

/// Constrained update projection.
pub struct Cup {
    settings: LearningConfig,
    multipliers: Multipliers,
}

impl Cup {
    /// CUP with a run's settings.
    #[must_use]
    pub fn new(config: &TrainConfig) -> Cup {
        let multipliers = Lagrange::all(&config.algorithm_settings, config.constraints.len());
        Cup { settings: config.learning.clone(), multipliers }
    }

    /// The loss of the second step: divergence from the policy halfway, the costs' surrogates from
    /// the policy that acted, and the losses of the critics.
    pub(super) fn projection(
        &self,
        halfway: &Policy,
        heads: &Heads,
        batch: &Minibatch<'_>,
        means: &mut Means,
    ) -> Loss {
        let (gamma, lambda) =
            (self.settings.cost_gamma.unwrap_or(self.settings.gamma), self.settings.gae_lambda);
        let coefficient = (1.0 - gamma * lambda) / (1.0 - gamma);
        let mut total = heads.mean_of(&heads.policy.divergence(halfway));
        for (cost, multiplier) in batch.costs().iter().zip(self.multipliers()) {
            let advantages = centred(&cost.advantages);
            let surrogate = heads.mean([&heads.ratio], |row, [ratio]| ratio * advantages[row]);
            total = total + surrogate * (multiplier * coefficient);
        }
        means.add("projection_loss", total.value);
        total + critics_loss(heads, batch, &self.settings, &mut Means::default())
    }
}

impl Algorithm for Cup {
    fn learn(
        &mut self,
        learner: &mut Learner,
        rollout: &Prepared<'_>,
        epochs: &Epochs,
        signals: &Signals<'_>,
        means: &mut Means,
    ) -> Result<(), LearnError> {
        // They have a schedule.
        let now = &learner.config.learning;
        (self.settings.gamma, self.settings.gae_lambda) = (now.gamma, now.gae_lambda);
        learn_in_epochs(self, learner, rollout, epochs, signals, means)?;
        if self.multipliers().iter().all(|&multiplier| multiplier == 0.0) {
            return Ok(());
        }
        let (steps, count) = (rollout.rollout.trajectory_steps(), rollout.rollout.trajectories());
        let all: Vec<usize> = (0..count).collect();
        let halfway = learner.policy(&mut learner.minibatch(rollout, &all));
        let networks = learner.shape().networks.len();
        let made = go_through(
            learner,
            rollout,
            Some(&halfway),
            epochs,
            means,
            |learner, rollout, some, means| {
                let rows = (0..steps)
                    .flat_map(|step| some.iter().map(move |number| step * count + number));
                let halfway = halfway.of_rows(rows);
                let projection = |heads: &Heads, batch: &Minibatch<'_>, means: &mut Means| {
                    self.projection(&halfway, heads, batch, means)
                };
                let mut noted = Means::default();
                learner.descend_networks(
                    0..networks,
                    1,
                    &mut learner.minibatch(rollout, some),
                    projection,
                    &mut noted,
                )?;
                noted
                    .get("projection_loss")
                    .into_iter()
                    .for_each(|loss| means.add("projection_loss", loss));
                Ok(())
            },
        )?;
        means.add("projection_epochs", f64::from(made));
        Ok(())
    }

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
            |heads, batch, means| ppo::loss(&advantages, heads, batch, &self.settings, means),
            means,
        )
    }

    fn weights(&self) -> Option<&Multipliers> {
        Some(&self.multipliers)
    }

    fn weights_mut(&mut self) -> Option<&mut Multipliers> {
        Some(&mut self.multipliers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algorithms::{ppo, small};
    use crate::config::AlgorithmKind;

    fn learned(algorithm: &mut dyn Algorithm, config: &TrainConfig, episode_cost: f64) -> Learner {
        let (mut learner, rollout) = small::learner(config);
        let signals = |_: &[f64]| vec![Signal::steady(episode_cost, 5.0, 525.0)];
        for number in 0..3 {
            let prepared = learner.prepare(&rollout);
            let passes = Epochs::new(config, number, small::LANES);
            algorithm
                .learn(&mut learner, &prepared, &passes, &signals, &mut Means::default())
                .unwrap();
        }
        learner
    }

    /// Within the budget the multiplier is zero, and the policy halfway is what is left; above it
    /// the second step moves on from there, and leaves the first step's momentum as it was.
    #[test]
    fn the_second_step_starts_where_the_first_ended() {
        let mut config = small::config(AlgorithmKind::Cup);
        (config.learning.epochs, config.learning.target_kl) = (2, None);
        config.algorithm_settings.multiplier_rate = 10.0;
        let halfway = learned(&mut ppo::Ppo::new(&config), &config, 0.0);
        let within = learned(&mut Cup::new(&config), &config, 0.0);
        assert!(within.parameters == halfway.parameters && within.optimisers == halfway.optimisers);
        let above = learned(&mut Cup::new(&config), &config, 100.0);
        assert_ne!(above.parameters, halfway.parameters);
        assert_eq!(above.optimisers.iter().map(|adam| adam.steps).collect::<Vec<_>>(), [6, 6]);
    }

    /// A3. The projection's step is as short as the first (each stops by its divergence from the
    /// policy that it begins with, as in OmniSafe): it ends when KL(halfway, new) is beyond the
    /// target, with a pass to spare or with none.
    #[test]
    fn the_second_step_stops_at_its_own_divergence() {
        let passes = |target: f64| {
            let mut config = small::config(AlgorithmKind::Cup);
            (config.learning.epochs, config.learning.target_kl) = (8, Some(target));
            config.learning.rate = 1e-2;
            config.algorithm_settings.multiplier_rate = 100.0;
            let (mut learner, rollout) = small::learner(&config);
            let prepared = learner.prepare(&rollout);
            let mut cup = Cup::new(&config);
            let mut means = Means::default();
            let signals = |_: &[f64]| vec![Signal::steady(1000.0, 5.0, 525.0)];
            cup.learn(
                &mut learner,
                &prepared,
                &Epochs::new(&config, 0, small::LANES),
                &signals,
                &mut means,
            )
            .unwrap();
            let steps: Vec<u64> = learner.optimisers.iter().map(|adam| adam.steps).collect();
            assert_eq!(means.get("projection_epochs"), Some(steps[1] as f64));
            steps
        };
        // The passes of the second step do not hang on how far the first went: with a target
        // between its own divergences it makes some of them.
        assert_eq!(passes(1e9), [8, 8]);
        assert_eq!(passes(1e-12), [1, 1]);
        let between = passes(0.05);
        assert!((1..8).contains(&between[1]), "{between:?}");
    }

    /// With a vanishing multiplier, the projection of a policy is that policy: it must not be drawn
    /// back to the one that acted.
    #[test]
    fn a_small_multiplier_does_not_undo_the_first_step() {
        let mut config = small::config(AlgorithmKind::Cup);
        (config.learning.epochs, config.learning.target_kl) = (20, None);
        // The critics have losses of their own.
        config.learning.value_coefficient = 0.0;
        let (mut learner, rollout) = small::learner(&config);
        let prepared = learner.prepare(&rollout);
        let mut minibatch = learner.minibatch(&prepared, &[0, 1, 2, 3]);
        let cup = Cup::new(&config);
        let halfway = learner.policy(&mut minibatch);
        let before = learner.parameters.clone();
        for _ in 0..20 {
            let loss = |heads: &Heads, batch: &Minibatch<'_>, means: &mut Means| {
                cup.projection(&halfway, heads, batch, means)
            };
            learner.descend_networks(0..1, 1, &mut minibatch, loss, &mut Means::default()).unwrap();
        }
        assert_eq!(learner.parameters, before);
    }
}
