//! PPOCost: PPO on the reward minus the scaled cost. What an episode costs then has a price, but no
//! budget.

use crate::config::TrainConfig;
use crate::sampling::shaping::Shaping;

/// The reward minus the scaled cost.
pub struct Penalty {
    scale: f32,
}

impl Penalty {
    /// The penalty of a run's settings.
    #[must_use]
    pub fn new(config: &TrainConfig) -> Penalty {
        Penalty { scale: config.algorithm_settings.penalty_scale as f32 }
    }
}

impl Shaping for Penalty {
    fn step(&self, safety: f64, reward: f32, cost: f32) -> (f32, f64) {
        (reward - self.scale * cost, safety)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::shaping::Plain;

    #[test]
    fn penalties_subtract_scaled_cost() {
        assert_eq!(Penalty { scale: 0.5 }.step(1.0, 2.0, 3.0), (0.5, 1.0));
        assert_eq!(Plain.step(1.0, 2.0, 3.0), (2.0, 1.0));
    }
}
