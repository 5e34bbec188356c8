//! PPOSaute (Sootla et al. 2022, arXiv 2202.06558): PPO with the budget as part of the state.
//!
//! A safety state begins each episode at 1, loses what every step costs in units of the budget, and
//! is discounted backwards; the network sees it, and once it is spent the reward is a bad one.

use crate::config::TrainConfig;
use crate::sampling::shaping::Shaping;

/// The budget as a safety state: what is left of it, in its own units, discounted backwards.
pub struct Saute {
    /// Budget per step in which the safety state counts.
    unit: f64,
    /// Discount.
    gamma: f64,
    /// Reward once the budget is spent.
    unsafe_reward: f32,
    /// The network sees the safety state.
    visible: bool,
}

impl Saute {
    /// The safety state of a run's settings.
    #[must_use]
    pub fn new(config: &TrainConfig) -> Saute {
        let settings = &config.algorithm_settings;
        Saute {
            unit: unit(config.aim(0), settings.saute_gamma, settings.saute_horizon),
            gamma: settings.saute_gamma,
            unsafe_reward: settings.saute_unsafe_reward as f32,
            visible: settings.saute_visible,
        }
    }
}

impl Shaping for Saute {
    fn extra_inputs(&self) -> usize {
        usize::from(self.visible)
    }

    fn step(&self, safety: f64, reward: f32, cost: f32) -> (f32, f64) {
        // With a small gamma it grows beyond all numbers within an episode: so far, and no farther.
        let after = (safety - f64::from(cost) / self.unit) / self.gamma;
        let after = after.clamp(-LARGEST_STATE, LARGEST_STATE);
        (if after > 0.0 { reward } else { self.unsafe_reward }, after)
    }
}

/// Largest size of a safety state.
const LARGEST_STATE: f64 = 1e300;

/// The budget in which the safety state counts: an even spread over the horizon, discounted.
fn unit(budget: f64, gamma: f64, horizon: f64) -> f64 {
    if gamma >= 1.0 {
        return budget;
    }
    budget * (1.0 - libm::pow(gamma, horizon)) / (1.0 - gamma) / horizon
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn safety_states_stay_numbers() {
        let saute = Saute { unit: 1.0, gamma: 0.01, unsafe_reward: -1.0, visible: true };
        for cost in [0.0, 2.0] {
            let mut safety = 1.0;
            for _ in 0..1000 {
                safety = saute.step(safety, 1.0, cost).1;
            }
            assert_eq!(safety, if cost > 1.0 { -LARGEST_STATE } else { LARGEST_STATE });
        }
    }

    /// The released code's unit (2100 tics) and safety states, worked out apart in double
    /// precision.
    #[test]
    fn safety_states_equal_the_recorded_ones() {
        let of_tics = unit(50.0, 0.9999, 2100.0);
        assert!((of_tics - 45.101_015_640).abs() < 1e-8, "{of_tics}");
        assert!((unit(50.0, 0.9999, 525.0) / 50.0 - 0.97425).abs() < 1e-5);
        let shaping = Saute { unit: of_tics, gamma: 0.9999, unsafe_reward: -0.01, visible: true };
        let mut safety = 1.0;
        let expected =
            [(0.0, 1.0001), (10.0, 0.778_453_4), (40.0, -0.108_455_5), (0.0, -0.108_466_3)];
        for (cost, after) in expected {
            let (reward, next) = shaping.step(safety, 2.0, cost);
            assert!((next - after).abs() < 1e-7, "{next} against {after}");
            assert_eq!(reward, if after > 0.0 { 2.0 } else { -0.01 });
            safety = next;
        }
    }
}
