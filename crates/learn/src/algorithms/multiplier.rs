//! Lagrange multipliers and how they move.

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::algorithms::Signal;
use crate::config::AlgorithmConfig;

/// A multiplier that integrates the excess of a constraint: lambda <- max(0, lambda + rate *
/// excess) (Ray et al. 2019, algorithm 1 of their appendix), and nothing else.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lagrange {
    /// The multiplier.
    pub value: f64,
    rate: f64,
    /// The largest it may become.
    limit: Option<f64>,
}

impl Lagrange {
    /// One multiplier a constraint.
    #[must_use]
    pub fn all(settings: &AlgorithmConfig, constraints: usize) -> Multipliers {
        let one = Lagrange {
            value: settings.multiplier_initial,
            rate: settings.multiplier_rate,
            limit: settings.multiplier_limit,
        };
        Multipliers::Lagrange(vec![one; constraints])
    }

    /// Moves by what the constraint costs per step above its budget.
    pub fn update(&mut self, signal: &Signal) {
        let change = self.rate * signal.fresh_weight * signal.fresh_step_excess();
        self.value = (self.value + change).clamp(0.0, self.limit.unwrap_or(f64::INFINITY));
    }
}

/// A multiplier moved by a PID controller (Stooke et al. 2020, algorithm 2): proportional and
/// derivative parts react before the integral has grown, which damps its swings. With a reference
/// budget every part counts 1 + progress^3 (reference / budget - 1) times, where progress is the
/// share of the schedule that is over: at first an excess counts by itself, at last by its share of
/// the budget.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pid {
    /// The multiplier.
    pub value: f64,
    gains: (f64, f64, f64),
    decay: f64,
    delay: usize,
    #[serde(default)]
    reference: Option<f64>,
    /// The largest it may become.
    #[serde(default)]
    limit: Option<f64>,
    integral: f64,
    /// Moving average of the excess.
    proportional: f64,
    /// Moving average of the cost.
    cost: f64,
    /// The latest averages of the cost, oldest first, as many as the derivative looks back.
    costs: std::collections::VecDeque<f64>,
}

impl Pid {
    /// One controller a constraint.
    #[must_use]
    pub fn all(settings: &AlgorithmConfig, constraints: usize) -> Multipliers {
        let pid = Pid {
            value: 0.0,
            gains: settings.pid_gains,
            decay: settings.pid_decay,
            delay: settings.pid_delay.max(1),
            reference: settings.pid_reference_budget,
            limit: settings.multiplier_limit,
            integral: settings.pid_initial,
            proportional: 0.0,
            cost: 0.0,
            costs: [0.0].into(),
        };
        Multipliers::Pid(vec![pid; constraints])
    }

    /// Moves by what the constraint costs per step. The integral counts every episode once;
    /// averages and delay go on by as many rollouts as the new episodes stand for, and stand still
    /// while there are none.
    pub fn update(&mut self, signal: &Signal) {
        if signal.fresh_weight == 0.0 {
            return;
        }
        let (kp, ki, kd) = self.gains;
        let limit = self.limit.unwrap_or(f64::INFINITY);
        // No budget is less than one event of an episode.
        let ratio =
            self.reference.map_or(1.0, |reference| reference / signal.episode_budget.max(1.0));
        let scale = 1.0 + signal.done.powi(3) * (ratio - 1.0);
        let fresh = signal.fresh_weight * signal.fresh_step_excess();
        self.integral = (self.integral + ki * (scale * fresh)).clamp(0.0, limit);
        let kept = libm::pow(self.decay, signal.fresh_weight);
        self.proportional = kept * self.proportional + (1.0 - kept) * signal.step_excess();
        self.cost = kept * self.cost + (1.0 - kept) * signal.step_cost();
        let rise = (self.cost - self.costs.front().copied().unwrap_or(0.0)).max(0.0);
        let present = kp * (scale * self.proportional) + kd * (scale * rise);
        self.value = (present + self.integral).clamp(0.0, limit);
        for _ in 0..(signal.fresh_weight as usize).clamp(1, self.delay) {
            if self.costs.len() == self.delay {
                self.costs.pop_front();
            }
            self.costs.push_back(self.cost);
        }
    }
}

/// The multipliers of a run's constraints, one each.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Multipliers {
    /// Moved by the excess.
    Lagrange(Vec<Lagrange>),
    /// Moved by PID controllers.
    Pid(Vec<Pid>),
}

impl Multipliers {
    /// Updates them by what each constraint costs.
    pub fn update(&mut self, signals: &[Signal]) {
        match self {
            Multipliers::Lagrange(all) => {
                all.iter_mut().zip(signals).for_each(|(one, signal)| one.update(signal))
            }
            Multipliers::Pid(all) => {
                all.iter_mut().zip(signals).for_each(|(one, signal)| one.update(signal))
            }
        }
    }

    /// As many as the others, and moved by the same rule.
    #[must_use]
    pub fn is_like(&self, others: &Multipliers) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(others)
            && self.values().len() == others.values().len()
    }

    /// Goes on from the damped multipliers of older versions, if that is what was saved: PI
    /// controllers, the value of which is their integral plus a multiple of the present excess.
    pub fn take_over_damped(&mut self, saved: &Value) -> bool {
        let (Multipliers::Pid(all), Some(saved)) = (self, saved.as_array()) else { return false };
        let parts = |one: &Value| {
            Some((
                one.get("value")?.as_f64()?,
                one.get("damping")?.as_f64()?,
                one.get("integral")?.as_f64()?,
            ))
        };
        let saved: Vec<_> =
            saved.iter().filter_map(parts).filter(|(_, damping, _)| *damping > 0.0).collect();
        if saved.len() != all.len() {
            return false;
        }
        for (one, (value, _, integral)) in all.iter_mut().zip(saved) {
            (one.value, one.integral) = (value, integral);
        }
        true
    }

    /// Their values.
    #[must_use]
    pub fn values(&self) -> Vec<f64> {
        match self {
            Multipliers::Lagrange(all) => all.iter().map(|one| one.value).collect(),
            Multipliers::Pid(all) => all.iter().map(|one| one.value).collect(),
        }
    }
}

#[cfg(test)]
mod tests;
