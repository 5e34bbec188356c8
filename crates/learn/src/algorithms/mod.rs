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

use crate::config::{AlgorithmKind, TrainConfig};
use crate::error::LearnError;
use crate::learning::learner::{Learner, Minibatch, Prepared};
use crate::learning::metrics::Means;
use crate::learning::passes::Passes;
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
    /// Share of the training that is over, 0 to 1.
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
        let made = go_through(passes, means, |lanes, means| {
            let mut minibatch = learner.minibatch(rollout, lanes);
            let signals = signals(&minibatch.mean_costs);
            self.constrain(&signals);
            self.update(learner, &mut minibatch, &signals, means)
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

    /// Told once a minibatch, before its update, what each constraint costs.
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
            let saved: Multipliers = serde_json::from_value(state.clone())?;
            if !saved.is_like(weights) {
                return Err(serde::de::Error::custom("they are another algorithm's, or of another number of constraints"));
            }
            *weights = saved;
        }
        Ok(())
    }
}

/// Makes the passes over a rollout, until the policy has moved as far as it may. Returns how many were made.
fn go_through(
    passes: &Passes,
    means: &mut Means,
    mut update: impl FnMut(&[usize], &mut Means) -> Result<(), LearnError>,
) -> Result<u32, LearnError> {
    let mut made = 0;
    for epoch in 0..passes.epochs {
        let mut noted = Means::default();
        passes.minibatches(epoch).iter().try_for_each(|lanes| update(lanes, &mut noted))?;
        let divergence = noted.get("kl_divergence");
        means.absorb(noted);
        made += 1;
        if passes.end_at(divergence) {
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
