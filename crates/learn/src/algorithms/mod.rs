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
mod surrogate;
mod trpo;
mod trpo_lag;
mod trpo_pid;
pub mod trust_region;

use serde_json::Value;

use crate::config::{AlgorithmKind, TrainConfig};
use crate::error::LearnError;
use crate::learning::learner::{Learner, Minibatch};
use crate::learning::metrics::Means;
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

/// An algorithm: what it does with what the worlds brought.
pub trait Algorithm: Send {
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
