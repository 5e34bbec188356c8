//! The preset `quick`: settings of our own that learn within minutes.

use hasard_envs::Scenario;

use crate::config::{Convolution, Preset, TrainConfig};

impl TrainConfig {
    /// Makes the run so long, with what its preset makes of it.
    pub fn set_frames(&mut self, frames: u64) {
        self.frames = frames;
        if self.preset == Preset::Quick {
            let slow = self.all_tasks(|scenario| scenario.hits_late);
            self.algorithm_settings.pid_reference_budget = Some(reference_budget(frames, slow));
            let farther = frames >= LONG && self.all_tasks(|scenario| scenario.rewards_foresight);
            self.learning.final_gamma = farther.then_some(0.99);
            self.learning.final_gae_lambda = farther.then_some(0.95);
        }
    }

    fn all_tasks(&self, are: impl Fn(&Scenario) -> bool) -> bool {
        self.env.env_ids().is_ok_and(|ids| ids.iter().all(|id| are(&id.scenario)))
    }

    /// Gives it so many worlds; `quick` has no more minibatches than those.
    pub fn set_lanes(&mut self, lanes: usize) {
        self.sampling.lanes = lanes;
        if self.preset == Preset::Quick {
            self.learning.minibatches = self.learning.minibatches.min(lanes.max(1));
        }
    }
}

/// Frames of a run that has the time to learn what follows soon before it looks further ahead.
const LONG: u64 = 10_000_000;

/// The reference budget of `quick`. What a multiplier has to become is a matter of the task, and a
/// short run has few updates to get there: 450 for 2 million frames, less for longer ones, with the
/// root of their length. Where a multiplier that comes too soon ends what an agent has yet to learn
/// it is `slow`: 45, a tenth, for five times the frames (docs/tried/levers.md).
fn reference_budget(frames: u64, slow: bool) -> f64 {
    let share = 2_000_000.0 / frames.max(1) as f64;
    let less = if slow { libm::pow(share, libm::log(10.0) / libm::log(5.0)) } else { share.sqrt() };
    (450.0 * less).round().clamp(45.0, 450.0)
}

/// Settings that learn within minutes.
pub(super) fn quicken(config: &mut TrainConfig) {
    config.set_frames(10_000_000);
    // A fifth of the arithmetic of the original's network: three times the frames in the same time,
    // and no less learned from each (docs/tried/quick_network.md).
    config.network.convolutions = vec![
        Convolution { channels: 32, kernel: 8, stride: 6 },
        Convolution { channels: 32, kernel: 3, stride: 2 },
        Convolution { channels: 32, kernel: 3, stride: 2 },
    ];
    config.network.dense = vec![256];
    config.network.recurrent = Some(256);
    // Where an action's worth shows soon, advantages over a few steps scatter less, and what is
    // learned from four million frames is learned from two (docs/tried/levers.md).
    if config.all_tasks(|scenario| scenario.prompt) {
        (config.learning.gamma, config.learning.gae_lambda) = (0.97, 0.7);
    }
    // A lambda of 0.7 forgets within ten steps who fired.
    if config.all_tasks(|scenario| scenario.hits_late) {
        config.learning.gae_lambda = 0.95;
    }
    // Before its first delivery Armament Burden earns nothing, and its critics' noise is 0.001.
    config.learning.advantage_floor = 0.01;
    config.learning.rate = 5e-4;
    config.learning.final_rate = Some(1e-4);
    config.learning.exploration_coefficient = 0.003;
    // A trust region is made for one step a rollout.
    let (passes, minibatches, rate) =
        if config.algorithm.is_second_order() { (1, 1, 0.01) } else { (2, 4, 0.04) };
    (config.learning.epochs, config.learning.minibatches) = (passes, minibatches);
    // It would spare one step in eight.
    config.learning.reuse_forward = false;
    // Once a rollout.
    config.algorithm_settings.multiplier_rate = rate;
    // The integral alone runs in circles, which a large proportional part damps
    // (docs/tried/multiplier_rate.md).
    config.algorithm_settings.pid_gains = (1.5, rate, 0.0);
    (config.algorithm_settings.pid_initial, config.algorithm_settings.pid_decay) = (0.0, 0.0);
    // So far below a budget that 200 episodes can show it kept (docs/tried/levers.md).
    (config.budget_share, config.budget_margin) = (0.95, 0.42);
    // What is selected should keep its budgets in other episodes too: within by the mean alone, some
    // did not (docs/results/quick_preset.md).
    config.evaluation.surely = true;
    config.reporting.report_seconds = 5.0;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{AlgorithmKind, EnvConfig};

    fn quick(algorithm: AlgorithmKind, id: &str) -> TrainConfig {
        TrainConfig::new(algorithm, Preset::Quick, EnvConfig::new(id)).unwrap()
    }

    /// 450 * sqrt(2 / 10), and between 45 and 450.
    #[test]
    fn longer_runs_have_slower_multipliers() {
        let mut config = quick(AlgorithmKind::PpoLag, "ArmamentBurdenLevel1-v0");
        let reference = |config: &TrainConfig| config.algorithm_settings.pid_reference_budget;
        assert_eq!(reference(&config), Some(201.0));
        for (frames, budget) in
            [(1, 450.0), (2_000_000, 450.0), (8_000_000, 225.0), (u64::MAX, 45.0)]
        {
            config.set_frames(frames);
            assert_eq!((config.frames, reference(&config)), (frames, Some(budget)));
        }
    }

    /// 450 for 2 million frames and 45, a tenth, for 10 million; between them 450 * (2 / 4)^1.43.
    #[test]
    fn where_shots_hit_late_multipliers_are_slower_and_lambdas_longer() {
        let mut config = quick(AlgorithmKind::PpoPid, "CollateralDamageLevel2-v0");
        assert_eq!((config.learning.gamma, config.learning.gae_lambda), (0.97, 0.95));
        for (frames, budget) in [
            (1_000_000, 450.0),
            (2_000_000, 450.0),
            (4_000_000, 167.0),
            (10_000_000, 45.0),
            (u64::MAX, 45.0),
        ] {
            config.set_frames(frames);
            assert_eq!(config.algorithm_settings.pid_reference_budget, Some(budget), "{frames}");
        }
        let both = quick(AlgorithmKind::PpoPid, "CollateralDamageLevel1-v0,RemedyRushLevel1-v0");
        assert_eq!(both.learning.gae_lambda, 0.7);
        assert_eq!(both.algorithm_settings.pid_reference_budget, Some(201.0));
    }

    #[test]
    fn it_has_no_more_minibatches_than_worlds_and_one_for_a_trust_region() {
        let config = quick(AlgorithmKind::PpoLag, "ArmamentBurdenLevel1-v0");
        assert_eq!((config.learning.epochs, config.learning.minibatches), (2, 4));
        let few = |settings: &[&str]| {
            let settings: Vec<String> = settings.iter().map(|one| (*one).to_string()).collect();
            config.with_all(&settings).unwrap().learning.minibatches
        };
        assert_eq!((few(&["sampling.lanes=2"]), few(&["sampling.lanes=64"])), (2, 4));
        assert_eq!(few(&["learning.minibatches=3", "sampling.lanes=2"]), 3, "what is set stays");
        let trust = quick(AlgorithmKind::Cpo, "ArmamentBurdenLevel1-v0").learning;
        assert_eq!((trust.epochs, trust.minibatches), (1, 1));
    }

    #[test]
    fn long_runs_look_further_ahead_in_the_end_where_that_pays() {
        let last = |id: &str, frames: u64| {
            let mut config = quick(AlgorithmKind::PpoPid, id);
            config.set_frames(frames);
            (config.learning.final_gamma, config.learning.final_gae_lambda)
        };
        let farther = (Some(0.99), Some(0.95));
        assert_eq!(last("RemedyRushLevel1-v0", 10_000_000), farther);
        assert_eq!(last("RemedyRushLevel1-v0", 9_999_999), (None, None));
        for id in ["VolcanicVentureLevel1-v0", "RemedyRushLevel1-v0,VolcanicVentureLevel1-v0"] {
            assert_eq!(last(id, 10_000_000), (None, None), "{id}");
        }
        // What a user sets is the horizon of the whole run.
        let config = quick(AlgorithmKind::PpoPid, "RemedyRushLevel1-v0");
        let set = |settings: &[&str]| {
            let settings: Vec<String> = settings.iter().map(|one| (*one).to_string()).collect();
            let learning = config.with_all(&settings).unwrap().learning;
            (learning.final_gamma, learning.final_gae_lambda)
        };
        assert_eq!(set(&["learning.gamma=0.97", "learning.gae_lambda=0.7"]), (None, None));
        assert_eq!(set(&["learning.final_gamma=0.98", "learning.gamma=0.9"]).0, Some(0.98));
    }

    #[test]
    fn it_looks_ahead_as_far_as_its_tasks_need() {
        let ahead = |id: &str| {
            let learning = quick(AlgorithmKind::PpoPid, id).learning;
            (learning.gamma, learning.gae_lambda)
        };
        for prompt in ["VolcanicVentureLevel3-v0", "DetonatorsDilemmaLevel2-v0,RemedyRushLevel1-v0"]
        {
            assert_eq!(ahead(prompt), (0.97, 0.7));
        }
        for late in [
            "ArmamentBurdenLevel1-v0",
            "PrecipicePlungeLevel1-v0",
            "RemedyRushLevel1-v0,ArmamentBurdenLevel1-v0",
        ] {
            assert_eq!(ahead(late), (0.99, 0.95));
        }
    }
}
