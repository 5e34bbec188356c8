//! Lagrange multipliers and how they move.

use serde::{Deserialize, Serialize};

use super::Signal;
use crate::config::AlgorithmConfig;

/// A multiplier that integrates the excess of a constraint: lambda <- max(0, lambda + rate * excess). With damping the present
/// excess counts beside its integral, without being remembered; with a reference budget both count
/// 1 + progress^3 (reference / budget - 1) times, where progress is the share of the training that is over: at first an excess
/// counts by itself, at last by its share of the budget.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lagrange {
    /// The multiplier.
    pub value: f64,
    /// Its integral, if that is another.
    #[serde(default)]
    integral: Option<f64>,
    rate: f64,
    #[serde(default)]
    damping: f64,
    #[serde(default)]
    reference: Option<f64>,
    /// The largest it may become.
    limit: Option<f64>,
}

impl Lagrange {
    /// One multiplier a constraint.
    #[must_use]
    pub fn all(settings: &AlgorithmConfig, constraints: usize) -> Multipliers {
        let one = Lagrange {
            value: settings.multiplier_initial,
            integral: None,
            rate: settings.multiplier_rate,
            damping: settings.multiplier_damping,
            reference: settings.multiplier_reference_budget,
            limit: settings.multiplier_limit,
        };
        Multipliers::Lagrange(vec![one; constraints])
    }

    /// Moves by what the constraint costs per step above its budget.
    pub fn update(&mut self, signal: &Signal) {
        let limit = self.limit.unwrap_or(f64::INFINITY);
        let before = self.integral.unwrap_or(self.value);
        // No budget is less than one event of an episode.
        let ratio = self.reference.map_or(1.0, |reference| reference / signal.episode_budget.max(1.0));
        let excess = (1.0 + signal.done.powi(3) * (ratio - 1.0)) * signal.step_excess();
        let integral = (before + self.rate * excess).clamp(0.0, limit);
        self.integral = Some(integral);
        self.value = (integral + self.damping * excess).clamp(0.0, limit);
    }
}

/// A multiplier moved by a PID controller (Stooke et al. 2020): proportional and derivative parts react before the
/// integral has grown, which damps its swings.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pid {
    /// The multiplier.
    pub value: f64,
    gains: (f64, f64, f64),
    decay: f64,
    delay: usize,
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
            limit: settings.multiplier_limit,
            integral: settings.pid_initial,
            proportional: 0.0,
            cost: 0.0,
            costs: [0.0].into(),
        };
        Multipliers::Pid(vec![pid; constraints])
    }

    /// Moves by what the constraint costs per step.
    pub fn update(&mut self, signal: &Signal) {
        let (kp, ki, kd) = self.gains;
        let (excess, cost) = (signal.step_excess(), signal.step_cost());
        self.integral = (self.integral + ki * excess).clamp(0.0, self.limit.unwrap_or(f64::INFINITY));
        self.proportional = self.decay * self.proportional + (1.0 - self.decay) * excess;
        self.cost = self.decay * self.cost + (1.0 - self.decay) * cost;
        let rise = (self.cost - self.costs.front().copied().unwrap_or(0.0)).max(0.0);
        let limit = self.limit.unwrap_or(f64::INFINITY);
        self.value = (kp * self.proportional + self.integral + kd * rise).clamp(0.0, limit);
        if self.costs.len() == self.delay {
            self.costs.pop_front();
        }
        self.costs.push_back(self.cost);
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
    /// Told what each constraint costs.
    pub fn update(&mut self, signals: &[Signal]) {
        match self {
            Multipliers::Lagrange(all) => all.iter_mut().zip(signals).for_each(|(one, signal)| one.update(signal)),
            Multipliers::Pid(all) => all.iter_mut().zip(signals).for_each(|(one, signal)| one.update(signal)),
        }
    }

    /// As many as the others, and moved by the same rule.
    #[must_use]
    pub fn is_like(&self, others: &Multipliers) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(others) && self.values().len() == others.values().len()
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
mod tests {
    use super::*;
    use crate::config::{AlgorithmKind, EnvConfig, Preset, TrainConfig};

    fn signal(step_cost: f64) -> Signal {
        Signal { episode_cost: step_cost * 525.0, episode_budget: 50.0, episode_steps: 525.0, mean_steps: 525.0, done: 0.0 }
    }

    fn settings() -> AlgorithmConfig {
        TrainConfig::plain(AlgorithmKind::PpoLag, Preset::Released, EnvConfig::new("test")).algorithm_settings
    }

    /// The released code's rules, worked out apart in double precision: ten updates at a step cost of 0.3, then of 0.05.
    #[test]
    fn multipliers_follow_the_recorded_numbers() {
        let mut lagrange = Lagrange::all(&settings(), 1);
        let mut pid = Pid::all(&settings(), 1);
        let expected = [
            (1, 0.002_047_62, 0.004_221_43),
            (2, 0.004_095_24, 0.007_384_17),
            (3, 0.006_142_86, 0.010_491_15),
            (10, 0.020_476_19, 0.030_896_32),
            (11, 0.022_523_81, 0.033_496_74),
        ];
        for update in 1..=11 {
            lagrange.update(&[signal(0.3)]);
            pid.update(&[signal(0.3)]);
            if let Some((_, l, p)) = expected.iter().find(|(at, ..)| *at == update) {
                assert!((lagrange.values()[0] - l).abs() < 1e-8, "update {update}: {}", lagrange.values()[0]);
                assert!((pid.values()[0] - p).abs() < 1e-8, "update {update}: {}", pid.values()[0]);
            }
        }
        lagrange.update(&[signal(0.05)]);
        pid.update(&[signal(0.05)]);
        assert!((lagrange.values()[0] - 0.022_071_43).abs() < 1e-8);
        assert!((pid.values()[0] - 0.032_194_52).abs() < 1e-8);
    }

    /// A cost that follows the multiplier with a delay: the integral alone runs in circles, damped it settles.
    #[test]
    fn damping_ends_the_circles() {
        let swing = |damping: f64| {
            let settings = AlgorithmConfig { multiplier_rate: 0.02, multiplier_damping: damping, ..settings() };
            let mut multiplier = Lagrange::all(&settings, 1);
            let (mut cost, mut seen) = (100.0, std::collections::VecDeque::from(vec![100.0; 66]));
            let mut late = Vec::new();
            for update in 0..4000 {
                // It falls by 575 a unit of the multiplier, within 146 updates, and is seen 66 updates later.
                cost += (165.0 - 575.0 * multiplier.values()[0] - cost) / 146.0;
                seen.push_back(cost);
                multiplier.update(&[signal(seen.pop_front().unwrap() / 525.0)]);
                late.extend((update >= 2000).then_some(cost));
            }
            late.iter().fold(0.0f64, |most, cost| most.max((cost - 50.0f64).abs()))
        };
        assert!(swing(0.0) > 10.0, "{}", swing(0.0));
        assert!(swing(1.5) < 2.0, "{}", swing(1.5));
    }

    /// A cost that answers to ratios of the multiplier: the rate that brings a budget of 45 to rest where 0.3 is needed also brings
    /// one of 4.5 to rest where 3 is, and moves the first as it would without.
    #[test]
    fn a_reference_brings_small_budgets_to_rest_as_soon() {
        let distance = |reference: Option<f64>, scale: f64| {
            let settings = AlgorithmConfig {
                multiplier_rate: 0.01,
                multiplier_damping: 1.5,
                multiplier_reference_budget: reference,
                ..settings()
            };
            let mut multiplier = Lagrange::all(&settings, 1);
            let budget = 45.0 / scale;
            let mut cost = 2.0 * budget;
            for update in 0..12_000 {
                let wanted = budget * (1.0 - (multiplier.values()[0] / (0.3 * scale)).max(0.05).ln());
                cost += (wanted - cost) / 146.0;
                let signal = Signal {
                    episode_cost: cost,
                    episode_budget: budget,
                    episode_steps: 525.0,
                    mean_steps: 525.0,
                    done: f64::from(update) / 12e3,
                };
                multiplier.update(&[signal]);
            }
            (cost / budget - 1.0).abs()
        };
        assert!(distance(None, 1.0) < 0.01 && distance(None, 10.0) > 0.5, "{} {}", distance(None, 1.0), distance(None, 10.0));
        assert!(
            distance(Some(45.0), 1.0) == distance(None, 1.0) && distance(Some(45.0), 10.0) < 0.25,
            "{}",
            distance(Some(45.0), 10.0)
        );
    }

    /// Worked out by hand: halfway, an excess of 5 over a budget of 5 counts 1 + (45 / 5 - 1) / 8 = 2 times; at first it counts once.
    /// A budget of nothing counts as one of 1.
    #[test]
    fn an_excess_counts_by_its_share_of_the_budget_at_last() {
        let moved = |budget: f64, done: f64| {
            let settings = AlgorithmConfig { multiplier_rate: 1.0, multiplier_reference_budget: Some(45.0), ..settings() };
            let mut multiplier = Lagrange::all(&settings, 1);
            multiplier.update(&[Signal {
                episode_cost: budget + 5.0,
                episode_budget: budget,
                episode_steps: 100.0,
                mean_steps: 100.0,
                done,
            }]);
            multiplier.values()[0]
        };
        for (budget, done, expected) in [(5.0, 0.0, 0.05), (5.0, 0.5, 0.1), (5.0, 1.0, 0.45), (45.0, 1.0, 0.05), (0.0, 1.0, 2.25)]
        {
            assert!((moved(budget, done) - expected).abs() < 1e-12, "{budget} {done}: {}", moved(budget, done));
        }
    }

    #[test]
    fn multipliers_stay_within_their_bounds() {
        let mut lagrange = Lagrange::all(&AlgorithmConfig { multiplier_limit: Some(0.01), ..settings() }, 1);
        lagrange.update(&[signal(0.0)]);
        assert_eq!(lagrange.values()[0], 0.0);
        (0..100).for_each(|_| lagrange.update(&[signal(1.0)]));
        assert_eq!(lagrange.values()[0], 0.01);
    }

    #[test]
    fn saved_multipliers_come_back_as_what_they_were() {
        for mut multipliers in [Lagrange::all(&settings(), 2), Pid::all(&settings(), 2)] {
            multipliers.update(&[signal(0.3), signal(0.1)]);
            let saved = serde_json::to_value(&multipliers).unwrap();
            let loaded: Multipliers = serde_json::from_value(saved).unwrap();
            assert_eq!(loaded, multipliers);
            assert!(loaded.is_like(&multipliers));
            assert!(!loaded.is_like(&Pid::all(&settings(), 1)) && !loaded.is_like(&Lagrange::all(&settings(), 1)));
        }
    }
}
