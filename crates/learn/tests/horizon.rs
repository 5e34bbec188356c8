//! The schedule of the discount and of lambda, in whole runs.

mod tiny;

use hasard_learn::config::{AlgorithmKind, TrainConfig};
use hasard_learn::runs::trainer::Start;

/// The weights after a few rollouts.
fn weights(config: &TrainConfig, name: &str) -> Vec<u8> {
    let path = tiny::directory(name);
    tiny::run(Start::Fresh(config.clone()), &path).0.unwrap();
    tiny::weights(&path)
}

/// The first rollout is learned from at the schedule's start. The second is learned from halfway to
/// an end at two rollouts, or at an end that is half as far and was reached meanwhile: the same,
/// also where an algorithm has the discount in its own formula.
#[test]
fn discount_and_lambda_follow_their_schedules() {
    for algorithm in [AlgorithmKind::PpoPid, AlgorithmKind::Cup] {
        let run = |rollouts: u64, last: Option<(f64, f64)>, schedule: Option<u64>| {
            let mut config = tiny::config(algorithm);
            let rollout = config.frames_per_rollout();
            config.frames = rollouts * rollout;
            (config.learning.gamma, config.learning.gae_lambda) = (0.5, 0.75);
            (config.learning.final_gamma, config.learning.final_gae_lambda) = last.unzip();
            config.learning.schedule_frames = schedule.map(|rollouts| rollouts * rollout);
            weights(&config, &format!("horizon-{algorithm}-{rollouts}-{last:?}-{schedule:?}"))
        };
        let far = Some((0.875, 0.25));
        assert!(run(1, far, Some(1)) == run(1, None, None), "{algorithm}: the first rollout");
        let both = run(2, far, Some(2));
        assert!(both == run(2, Some((0.6875, 0.5)), Some(1)), "{algorithm}: the second");
        assert!(both != run(2, None, None), "{algorithm}: constant");
        assert!(both != run(2, Some((0.6875, 0.75)), Some(1)), "{algorithm}: discount alone");
        assert!(both != run(2, Some((0.5, 0.5)), Some(1)), "{algorithm}: lambda alone");
    }
}
