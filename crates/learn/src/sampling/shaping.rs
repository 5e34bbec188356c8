//! What the learner is rewarded with, where that is not the plain reward: PPOCost and PPOSaute.

use crate::config::{AlgorithmKind, TrainConfig};

/// How rewards are shaped before learning. Reported returns and costs are always the plain ones.
#[derive(Clone, Debug, PartialEq)]
pub enum Shaping {
    /// Not at all.
    None,
    /// Reward minus scaled cost.
    Penalty {
        /// Factor of the cost.
        scale: f32,
    },
    /// The budget as a safety state: what is left of it, in its own units, discounted backwards.
    Saute {
        /// Budget per step in which the safety state counts.
        unit: f64,
        /// Discount.
        gamma: f64,
        /// Reward once the budget is spent.
        unsafe_reward: f32,
        /// The network sees the safety state.
        visible: bool,
    },
}

impl Shaping {
    /// The shaping of an algorithm.
    #[must_use]
    pub fn new(config: &TrainConfig) -> Shaping {
        let settings = &config.algorithm_settings;
        match config.algorithm {
            AlgorithmKind::PpoCost => Shaping::Penalty { scale: settings.penalty_scale as f32 },
            AlgorithmKind::PpoSaute => Shaping::Saute {
                unit: saute_unit(config.aim(0), settings.saute_gamma, settings.saute_horizon),
                gamma: settings.saute_gamma,
                unsafe_reward: settings.saute_unsafe_reward as f32,
                visible: settings.saute_visible,
            },
            _ => Shaping::None,
        }
    }

    /// Numbers that join the network's input.
    #[must_use]
    pub fn extra_inputs(&self) -> usize {
        usize::from(matches!(self, Shaping::Saute { visible: true, .. }))
    }

    /// The shaped reward of a step, and the safety state after it from that before it (1 at an episode's start).
    #[must_use]
    pub fn step(&self, safety: f64, reward: f32, cost: f32) -> (f32, f64) {
        match *self {
            Shaping::None => (reward, safety),
            Shaping::Penalty { scale } => (reward - scale * cost, safety),
            Shaping::Saute { unit, gamma, unsafe_reward, .. } => {
                let after = (safety - f64::from(cost) / unit) / gamma;
                (if after > 0.0 { reward } else { unsafe_reward }, after)
            }
        }
    }

    /// What the network sees of a safety state, in the bounds of all its inputs.
    #[must_use]
    pub fn seen(safety: f64) -> f32 {
        safety.clamp(-5.0, 5.0) as f32
    }
}

/// The budget in which the safety state counts: an even spread over the horizon, discounted.
fn saute_unit(budget: f64, gamma: f64, horizon: f64) -> f64 {
    if gamma >= 1.0 {
        return budget;
    }
    budget * (1.0 - libm::pow(gamma, horizon)) / (1.0 - gamma) / horizon
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The released code's unit (2100 tics) and safety states, worked out apart in double precision.
    #[test]
    fn safety_states_equal_the_recorded_ones() {
        let unit = saute_unit(50.0, 0.9999, 2100.0);
        assert!((unit - 45.101_015_640).abs() < 1e-8, "{unit}");
        assert!((saute_unit(50.0, 0.9999, 525.0) / 50.0 - 0.97425).abs() < 1e-5);
        let shaping = Shaping::Saute { unit, gamma: 0.9999, unsafe_reward: -0.01, visible: true };
        let mut safety = 1.0;
        let expected = [(0.0, 1.0001), (10.0, 0.778_453_4), (40.0, -0.108_455_5), (0.0, -0.108_466_3)];
        for (cost, after) in expected {
            let (reward, next) = shaping.step(safety, 2.0, cost);
            assert!((next - after).abs() < 1e-7, "{next} against {after}");
            assert_eq!(reward, if after > 0.0 { 2.0 } else { -0.01 });
            safety = next;
        }
    }

    #[test]
    fn penalties_subtract_scaled_cost() {
        assert_eq!(Shaping::Penalty { scale: 0.5 }.step(1.0, 2.0, 3.0), (0.5, 1.0));
        assert_eq!(Shaping::None.step(1.0, 2.0, 3.0), (2.0, 1.0));
    }
}
