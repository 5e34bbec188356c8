//! Runs whose matrices Muon steps.

mod tiny;

use hasard_learn::config::{AlgorithmKind, Optimiser, TrainConfig};
use hasard_learn::runs::trainer::Start;

fn config(algorithm: AlgorithmKind) -> TrainConfig {
    let mut config = tiny::config(algorithm);
    config.learning.optimiser = Optimiser::Muon;
    config
}

/// Its momentum is in the checkpoint.
#[test]
fn runs_resume_exactly_and_for_any_number_of_threads() {
    for algorithm in [AlgorithmKind::PpoPid, AlgorithmKind::Cup] {
        let mut config = config(algorithm);
        config.frames = 4 * config.frames_per_rollout();
        let all = tiny::however_trained(&tiny::worlds, &config, &format!("muon-{algorithm}"));
        config.learning.optimiser = Optimiser::Adam;
        let plain = tiny::directory(&format!("muon-adam-{algorithm}"));
        let adam = tiny::trained_in(&tiny::worlds, Start::Fresh(config), &plain);
        assert!(adam != all, "the optimiser changes nothing");
        std::fs::remove_dir_all(plain).unwrap();
    }
}

/// The best return is 7.
#[test]
fn it_learns_the_tiny_task() {
    let path = tiny::directory("muon-learns");
    let (result, reports, warnings) = tiny::run(Start::Fresh(config(AlgorithmKind::Ppo)), &path);
    result.unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    let last = reports.last().unwrap().means.unwrap().0;
    assert!(last > 6.5, "{last}");
    std::fs::remove_dir_all(path).unwrap();
}
