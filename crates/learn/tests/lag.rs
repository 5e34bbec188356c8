//! How far the weights that sample may lag behind those that learn.

mod tiny;

use hasard_learn::config::AlgorithmKind;
use hasard_learn::runs::report::Report;
use hasard_learn::runs::session::{Beginning, Session};
use hasard_learn::runs::trainer::Start;
use std::fs;

#[test]
fn sampling_beside_learning_works_and_bounds_the_lag() {
    let mut config = tiny::config(AlgorithmKind::PpoLag);
    config.sampling.synchronous = false;
    config.sampling.accumulated = 2;
    config.reporting.checkpoint_seconds = 0.0;
    config.frames = 20 * config.frames_per_rollout();
    let path = tiny::directory("side-by-side");
    let (result, reports, warnings) = tiny::run(Start::Fresh(config.clone()), &path);
    result.unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    let updates_per_rollout = (config.learning.epochs * config.learning.minibatches) as f64;
    let lag_of =
        |report: &Report| report.learning.iter().find(|(name, _)| *name == "policy_lag").unwrap().1;
    let lags: Vec<f64> = reports.iter().map(lag_of).collect();
    assert!(lags.iter().all(|&lag| lag <= 3.0 * updates_per_rollout), "{lags:?}");
    assert!(lags.iter().any(|&lag| lag > 0.0), "a sampler that runs ahead is behind: {lags:?}");
    let kept = fs::read_dir(path.join("checkpoints")).unwrap().count();
    assert!(kept <= config.reporting.keep + 1, "{kept} checkpoints");
    fs::remove_dir_all(path).unwrap();
}

/// A rollout of weights that are older than allowed is not learned from, and says so; its episodes
/// count all the same.
#[test]
fn a_rollout_too_old_is_thrown_away() {
    let mut config = tiny::config(AlgorithmKind::PpoLag);
    config.sampling.max_policy_lag = 2;
    let mut session = Session::new(config, &Beginning::Nothing, &tiny::worlds).unwrap();
    for (updates, learned) in [(2, true), (3, false)] {
        let before = session.learner.parameters.clone();
        // The samplers have not heard of these updates.
        session.learner.version += updates;
        let (version, episodes) = (session.learner.version, session.watch.episodes);
        let mut warnings = Vec::new();
        let rollout = session.turn(&mut |warning| warnings.push(warning)).unwrap();
        assert_eq!(session.learner.parameters != before, learned, "{updates} updates behind");
        assert_eq!(session.learner.version > version, learned);
        assert_eq!(warnings.is_empty(), learned, "{warnings:?}");
        assert_eq!(session.watch.episodes, episodes + rollout.episodes().len() as u64);
        assert!(!rollout.episodes().is_empty());
        session.go_on(rollout);
    }
}
