//! The algorithms, one file each.
//!
//! An [`Algorithm`] is told what its constraints cost, moves its multipliers, and improves the policy on a minibatch.
//! Gathering experience, advantages, targets and the optimiser are the same for all.

mod cpo;
mod cup;
mod focops;
mod ipo;
#[cfg(test)]
mod loss_tests;
pub mod multiplier;
mod p3o;
mod ppo;
mod ppo_lag;
mod ppo_pid;
#[cfg(test)]
pub(crate) mod small;
mod surrogate;
mod trpo;
mod trpo_lag;
mod trpo_pid;
pub mod trust_region;

use serde_json::Value;

use crate::config::{AlgorithmKind, MultiplierUpdate, TrainConfig};
use crate::error::LearnError;
use crate::learning::learner::{Learner, Minibatch, Prepared};
use crate::learning::metrics::Means;
use crate::learning::passes::Passes;
use crate::learning::policy::Policy;
use multiplier::Multipliers;

/// What a constraint costs at present.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Signal {
    /// Cost of an episode.
    pub episode_cost: f64,
    /// Budget of an episode.
    pub episode_budget: f64,
    /// Steps of the longest episode.
    pub episode_steps: f64,
    /// Mean steps of the episodes that the cost is the mean of.
    pub mean_steps: f64,
    /// Cost of the episodes alone that finished since multipliers last moved.
    pub fresh_cost: f64,
    /// Rollouts that those episodes stand for; 0 if there are none.
    pub fresh_weight: f64,
    /// Share of the schedule that is over, 0 to 1.
    pub done: f64,
}

impl Signal {
    /// Cost per step.
    #[must_use]
    pub fn step_cost(&self) -> f64 {
        self.episode_cost / self.episode_steps
    }

    /// Cost above budget, per step: the unit of the released code's multipliers.
    #[must_use]
    pub fn step_excess(&self) -> f64 {
        (self.episode_cost - self.episode_budget) / self.episode_steps
    }

    /// Cost of the new episodes above budget, per step.
    #[must_use]
    pub fn fresh_step_excess(&self) -> f64 {
        (self.fresh_cost - self.episode_budget) / self.episode_steps
    }

    /// A cost that is the same of all episodes, each as long as the longest and some of them of this rollout.
    #[must_use]
    pub const fn steady(episode_cost: f64, episode_budget: f64, episode_steps: f64) -> Signal {
        let (fresh_cost, mean_steps) = (episode_cost, episode_steps);
        Signal { episode_cost, episode_budget, episode_steps, mean_steps, fresh_cost, fresh_weight: 1.0, done: 0.0 }
    }

    /// Cost above budget in the unit of a surrogate of the cost, which is a mean over steps: an episode's cost changes by that mean's
    /// change times the steps that episodes have at present.
    #[must_use]
    pub fn surrogate_excess(&self) -> f64 {
        self.episode_excess() / self.mean_steps
    }

    /// Cost above budget of an episode.
    #[must_use]
    pub fn episode_excess(&self) -> f64 {
        self.episode_cost - self.episode_budget
    }
}

/// What each constraint costs, told from the mean costs per step of the experience at hand; empty while that is not known.
pub type Signals<'a> = dyn Fn(&[f64]) -> Vec<Signal> + 'a;

/// An algorithm: what it does with what the worlds brought.
pub trait Algorithm: Send {
    /// Learns from a rollout.
    fn learn(
        &mut self,
        learner: &mut Learner,
        rollout: &Prepared<'_>,
        passes: &Passes,
        signals: &Signals<'_>,
        means: &mut Means,
    ) -> Result<(), LearnError> {
        let moves = learner.config.algorithm_settings.multiplier_update;
        if moves == MultiplierUpdate::Rollout {
            self.constrain(&signals(&rollout.mean_costs));
        }
        let made = go_through(learner, rollout, None, passes, means, |learner, lanes, means| {
            let mut minibatch = learner.minibatch(rollout, lanes);
            let signals = signals(&minibatch.mean_costs);
            if moves == MultiplierUpdate::Minibatch {
                self.constrain(&signals);
            }
            self.update(learner, &mut minibatch, &signals, means)?;
            if moves == MultiplierUpdate::AfterMinibatch {
                self.constrain(&signals);
            }
            Ok(())
        })?;
        means.add("epochs", f64::from(made));
        Ok(())
    }

    /// Improves the policy and the critics on a minibatch. `signals` is empty while no episode has ended yet.
    fn update(
        &mut self,
        learner: &mut Learner,
        minibatch: &mut Minibatch<'_>,
        signals: &[Signal],
        means: &mut Means,
    ) -> Result<(), LearnError>;

    /// Its multipliers, if it has some: all that the next update depends on beside the networks.
    fn weights(&self) -> Option<&Multipliers> {
        None
    }

    /// The same, to be moved.
    fn weights_mut(&mut self) -> Option<&mut Multipliers> {
        None
    }

    /// Moves what hangs on the costs of the constraints: once a rollout or once a minibatch.
    fn constrain(&mut self, signals: &[Signal]) {
        if let Some(weights) = self.weights_mut() {
            weights.update(signals);
        }
    }

    /// Multiplier or penalty of each constraint; empty for algorithms without.
    fn multipliers(&self) -> Vec<f64> {
        self.weights().map_or_else(Vec::new, Multipliers::values)
    }

    /// Its multipliers for a checkpoint.
    fn save(&self) -> Value {
        self.weights().map_or(Value::Null, |weights| serde_json::to_value(weights).unwrap_or_default())
    }

    /// Goes on from a saved state.
    fn load(&mut self, state: &Value) -> Result<(), serde_json::Error> {
        if let Some(weights) = self.weights_mut() {
            if weights.take_over_damped(state) {
                return Ok(());
            }
            let saved: Multipliers = serde_json::from_value(state.clone())?;
            if !saved.is_like(weights) {
                return Err(serde::de::Error::custom("they are another algorithm's, or of another number of constraints"));
            }
            *weights = saved;
        }
        Ok(())
    }
}

/// Makes the passes over a rollout, until the policy has moved as far as it may: the mean divergence of the whole rollout after a pass, from
/// a policy or else from the one that acted, is beyond the target. Returns how many were made.
fn go_through(
    learner: &mut Learner,
    rollout: &Prepared<'_>,
    from: Option<&Policy>,
    passes: &Passes,
    means: &mut Means,
    mut update: impl FnMut(&mut Learner, &[usize], &mut Means) -> Result<(), LearnError>,
) -> Result<u32, LearnError> {
    let mut made = 0;
    for epoch in 0..passes.epochs {
        passes.minibatches(epoch).iter().try_for_each(|lanes| update(learner, lanes, means))?;
        made += 1;
        if epoch + 1 < passes.epochs && passes.end_at(|| learner.divergence(rollout, from)) {
            break;
        }
    }
    Ok(made)
}

/// The algorithm of a run.
#[must_use]
pub fn make(config: &TrainConfig) -> Box<dyn Algorithm> {
    use AlgorithmKind as Kind;
    match config.algorithm {
        Kind::Ppo | Kind::PpoCost | Kind::PpoSaute => Box::new(ppo::Ppo::new(config)),
        Kind::PpoLag => Box::new(ppo_lag::PpoLag::new(config)),
        Kind::PpoPid => Box::new(ppo_pid::new(config)),
        Kind::P3o => Box::new(p3o::P3o::new(config)),
        Kind::Focops => Box::new(focops::Focops::new(config)),
        Kind::Cup => Box::new(cup::Cup::new(config)),
        Kind::Ipo => Box::new(ipo::Ipo::new(config)),
        Kind::Trpo => Box::new(trpo::Trpo::new(config)),
        Kind::TrpoLag => Box::new(trpo_lag::TrpoLag::new(config)),
        Kind::TrpoPid => Box::new(trpo_pid::new(config)),
        Kind::Cpo => Box::new(cpo::Cpo::new(config)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A16. Algorithm 1 of FOCOPS ends its passes when the mean of KL(pi, pi_k) over the batch, of the policy as it is after the pass, is
    /// beyond delta. Divergences after 1, 2, ... passes are taken from runs of so many; a target between those of two passes ends
    /// at the later of them, one pass before what was noted ahead of each step would.
    #[test]
    fn passes_end_by_the_divergence_after_them() {
        let run = |epochs: usize, target: Option<f64>| {
            let mut config = small::config(AlgorithmKind::Ppo);
            (config.learning.epochs, config.learning.target_kl) = (epochs, target);
            config.learning.rate = 3e-3;
            let (mut learner, rollout) = small::learner(&config);
            let prepared = learner.prepare(&rollout);
            let mut means = Means::default();
            let mut ppo = ppo::Ppo::new(&config);
            ppo.learn(&mut learner, &prepared, &Passes::new(&config, 0, small::LANES), &|_| vec![], &mut means).unwrap();
            let mut minibatch = learner.minibatch(&prepared, &[0, 1, 2, 3]);
            let old = minibatch.old_policy.clone();
            (means.get("epochs").unwrap(), old.divergence(&learner.policy(&mut minibatch)).mean())
        };
        let after: Vec<f64> = (1..=4).map(|epochs| run(epochs, None).1).collect();
        assert!(after.windows(2).all(|two| two[0] < two[1]), "{after:?}");
        for passes in 2..=4 {
            let target = (after[passes - 2] + after[passes - 1]) / 2.0;
            assert_eq!(run(10, Some(target)), (passes as f64, after[passes - 1]), "target {target} of {after:?}");
        }
    }
}
