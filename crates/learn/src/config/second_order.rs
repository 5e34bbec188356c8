//! What the presets of second-order algorithms have beside the others'.

use crate::config::{Preset, TrainConfig};

/// Steps of each of the 32 worlds between two steps of the policy: 16,384 samples.
///
/// A second-order step trusts its sample: a Fisher matrix of a hundred steps, or advantages of a
/// thousand, are an accident of these, and a line search that asks the same sample cannot see it.
/// OmniSafe takes 20,000 samples a step, TRPO's paper 50,000 and more.
const STEPS: usize = 512;

/// Steps that gradients flow back through, as everywhere in the benchmark. It also bounds the
/// memory: a rollout is learned from part by part.
const RECURRENCE: usize = 32;

/// Samples of a critic's step of Adam: as many as the first-order algorithms take.
const CRITIC_BATCH: usize = 1024;

/// Whole rollouts for each step of the policy, and critics that follow it. What moves once an
/// update moves as much a frame as before.
pub(super) fn gather_more(config: &mut TrainConfig) {
    let times = (STEPS / config.sampling.rollout).max(1);
    config.sampling.rollout = STEPS;
    config.learning.recurrence = Some(RECURRENCE);
    // A trust region lies about the policy that acted; the statistics of pixels must not move it
    // first.
    config.learning.reuse_forward = true;
    let settings = &mut config.algorithm_settings;
    // Passes of the critics over the rollout: OmniSafe makes ten. One in `quick`, sixteen steps, is
    // what its time allows.
    let passes = if config.preset == Preset::Quick { 1 } else { 5 };
    settings.critic_steps = passes * STEPS * config.sampling.lanes / CRITIC_BATCH;
    settings.critic_batch = Some(CRITIC_BATCH);
    settings.multiplier_rate *= times as f64;
    settings.pid_gains.1 *= times as f64;
    settings.pid_decay = settings.pid_decay.powi(times as i32);
    settings.pid_delay = (settings.pid_delay / times).max(1);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{AlgorithmKind, EnvConfig};

    /// A5: at least 16,000 samples and ten steps of the critics for each step of the policy; the
    /// released code has neither.
    #[test]
    fn second_order_steps_have_samples_enough() {
        use AlgorithmKind::{Cpo, Trpo, TrpoLag, TrpoPid};
        for algorithm in [Trpo, TrpoLag, TrpoPid, Cpo] {
            let make = |preset| {
                TrainConfig::new(algorithm, preset, EnvConfig::new("VolcanicVentureLevel1-v0"))
                    .unwrap()
            };
            for preset in [Preset::Paper, Preset::Quick] {
                let config = make(preset);
                let samples = config.sampling.lanes * config.sampling.rollout;
                let settings = &config.algorithm_settings;
                assert!(samples >= 16_000 && settings.critic_steps >= 10, "{algorithm} {preset}");
                assert!(
                    samples as f64 * settings.fisher_fraction >= 1600.0,
                    "{algorithm} {preset}"
                );
                // The critics see all of the rollout.
                assert!(
                    settings.critic_steps * settings.critic_batch.unwrap() >= samples,
                    "{algorithm} {preset}"
                );
                assert_eq!(
                    (config.learning.epochs, config.learning.minibatches),
                    (1, 1),
                    "{algorithm} {preset}"
                );
            }
            let released = make(Preset::Released);
            assert_eq!(
                (released.sampling.rollout, released.algorithm_settings.critic_steps),
                (32, 1)
            );
            assert_eq!(
                (released.learning.recurrence, released.algorithm_settings.critic_batch),
                (None, None)
            );
        }
        let first = TrainConfig::new(
            AlgorithmKind::PpoLag,
            Preset::Quick,
            EnvConfig::new("VolcanicVentureLevel1-v0"),
        )
        .unwrap();
        assert_eq!((first.sampling.rollout, first.learning.recurrence), (32, None));
    }

    /// A step is sixteen of the first order's rollouts here: what a multiplier gains a rollout it
    /// gains sixteen times a step, what decays a rollout decays sixteen times, and a delay of ten
    /// rollouts is over with the next step.
    #[test]
    fn multipliers_move_as_much_a_frame() {
        use AlgorithmKind::{PpoLag, PpoPid, TrpoLag, TrpoPid};
        let settings = |algorithm, preset| {
            let env = EnvConfig::new("VolcanicVentureLevel1-v0");
            TrainConfig::new(algorithm, preset, env).unwrap().algorithm_settings
        };
        let close =
            |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found}");
        for algorithm in [TrpoLag, TrpoPid] {
            let paper = settings(algorithm, Preset::Paper);
            close(paper.multiplier_rate, 0.16);
            assert_eq!((paper.pid_gains.0, paper.pid_gains.2), (0.1, 0.01));
            close(paper.pid_gains.1, 0.16);
            close(paper.pid_decay, 0.44012666865176565);
            assert_eq!(paper.pid_delay, 1);
        }
        for algorithm in [PpoLag, PpoPid] {
            let paper = settings(algorithm, Preset::Paper);
            assert_eq!((paper.multiplier_rate, paper.pid_gains), (0.01, (0.1, 0.01, 0.01)));
            assert_eq!((paper.pid_decay, paper.pid_delay), (0.95, 10));
        }
    }
}
