//! Runs whose options come to the same settings are one run: a budget of 50 and none, where 50 is
//! the scenario's own.

use hasard_learn::config::TrainConfig;
use hasard_learn::runs::run_directory::read_config;
use hasard_sweep::Job;
use std::path::PathBuf;

/// The jobs without those that repeat an earlier one. A job that has nothing yet takes the
/// directory of an equal run of the same folder.
pub fn share(pairs: Vec<(Job, TrainConfig)>) -> Vec<(Job, TrainConfig)> {
    let mut kept: Vec<(Job, TrainConfig)> = Vec::new();
    let mut learned: Vec<TrainConfig> = Vec::new();
    for (mut job, config) in pairs {
        let what = what_is_learned(&config);
        if learned.contains(&what) {
            continue;
        }
        if job.is_new()
            && let Some(equal) = job.siblings().into_iter().find(|directory| {
                read_config(directory).is_ok_and(|found| what_is_learned(&found) == what)
            })
        {
            job.move_to(equal);
        }
        learned.push(what);
        kept.push((job, config));
    }
    kept
}

/// The settings of a run from its beginning, less those that change none of its bits.
fn what_is_learned(config: &TrainConfig) -> TrainConfig {
    let mut config = config.clone().begun();
    config.version.clear();
    if let Some(init_from) = &mut config.init_from {
        init_from.place = PathBuf::new();
    }
    (config.learning.threads, config.sampling.samplers, config.sampling.world_threads) = (0, 0, 0);
    config
}
