//! Runs and their directories: resuming, stopping, locking, damage.

mod tiny;

use hasard_learn::config::AlgorithmKind;
use hasard_learn::trainer::{Hooks, Start, train};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

fn checkpoints(run: &Path) -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> = fs::read_dir(run.join("checkpoints")).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

/// Rows of the metrics without what a clock decides.
fn rows(run: &Path) -> Vec<Value> {
    let text = fs::read_to_string(run.join("metrics.jsonl")).unwrap();
    text.lines()
        .map(|line| {
            let mut row: Value = serde_json::from_str(line).unwrap();
            let fields = row.as_object_mut().unwrap();
            for name in ["wall_s", "fps", "seconds_waiting", "seconds_learning"] {
                fields.remove(name);
            }
            row
        })
        .collect()
}

fn last_files(run: &Path) -> (Vec<u8>, Vec<u8>, Value) {
    let paths = checkpoints(run);
    let last = paths.iter().rfind(|path| path.file_name().unwrap().to_str().unwrap().starts_with("frames_")).unwrap();
    let mut state: Value = serde_json::from_slice(&fs::read(last.join("state.json")).unwrap()).unwrap();
    state["progress"].as_object_mut().unwrap().remove("wall_seconds");
    (fs::read(last.join("weights.safetensors")).unwrap(), fs::read(last.join("training.safetensors")).unwrap(), state)
}

/// A run ended after half its frames and resumed equals the run that went straight through: every weight, moment,
/// multiplier, statistic and row of metrics, for several algorithms and ways of sampling.
#[test]
fn a_resumed_run_equals_the_uninterrupted_one_bit_by_bit() {
    for (algorithm, samplers, groups, world_threads) in
        [(AlgorithmKind::PpoLag, 2, 1, 0), (AlgorithmKind::PpoPid, 1, 2, 1), (AlgorithmKind::PpoSaute, 2, 2, 0)]
    {
        let mut config = tiny::config(algorithm);
        config.sampling.samplers = samplers;
        config.sampling.groups = groups;
        config.sampling.world_threads = world_threads;
        // A rollout that is no multiple of the episode, so that the run ends inside episodes.
        config.sampling.rollout = 13;
        config.learning.final_rate = 1e-3;
        let rollout = config.frames_per_rollout();
        config.frames = 8 * rollout;
        let straight = tiny::directory(&format!("straight-{algorithm}"));
        tiny::run(Start::Fresh(config.clone()), &straight).0.unwrap();
        let broken = tiny::directory(&format!("broken-{algorithm}"));
        // Stops after three rollouts, as Ctrl-C does.
        let stop = AtomicBool::new(false);
        let mut count = 0;
        let summary = train(
            Start::Fresh(config.clone()),
            &broken,
            &tiny::worlds,
            &mut Hooks {
                stop: &stop,
                report: &mut |_| {
                    count += 1;
                    stop.store(count == 3, Ordering::Relaxed);
                },
                warn: &mut |warning| panic!("{warning}"),
            },
        )
        .unwrap();
        assert!(summary.stopped);
        assert!(summary.last.frames < config.frames);
        let (resumed, ..) = tiny::run(Start::Resume { frames: None }, &broken);
        assert!(!resumed.unwrap().stopped);
        let (a, b) = (last_files(&straight), last_files(&broken));
        assert!(a.0 == b.0, "{algorithm}: weights differ");
        assert!(a.1 == b.1, "{algorithm}: optimiser or lanes differ");
        assert_eq!(a.2, b.2, "{algorithm}");
        assert_eq!(rows(&straight), rows(&broken), "{algorithm}");
        fs::remove_dir_all(straight).unwrap();
        fs::remove_dir_all(broken).unwrap();
    }
}

/// The number of learner threads may change rounding; that of samplers and groups changes nothing that is sampled first.
#[test]
fn the_first_rollout_does_not_depend_on_how_lanes_are_dealt_out() {
    let mut all = Vec::new();
    for (samplers, groups, world_threads) in [(1, 1, 0), (4, 1, 0), (1, 2, 2), (2, 4, 1)] {
        let mut config = tiny::config(AlgorithmKind::Ppo);
        config.sampling.samplers = samplers;
        config.sampling.groups = groups;
        config.sampling.world_threads = world_threads;
        config.frames = 3 * config.frames_per_rollout();
        let path = tiny::directory(&format!("deal-{samplers}-{groups}"));
        tiny::run(Start::Fresh(config), &path).0.unwrap();
        all.push(last_files(&path).0);
        fs::remove_dir_all(path).unwrap();
    }
    assert!(all.iter().all(|weights| *weights == all[0]), "weights after three rollouts differ");
}

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
    for report in &reports {
        let lag = report.learning.iter().find(|(name, _)| *name == "policy_lag").unwrap().1;
        assert!(lag <= 3.0 * updates_per_rollout, "{lag}");
    }
    assert!(checkpoints(&path).len() <= config.reporting.keep + 1);
    fs::remove_dir_all(path).unwrap();
}

#[test]
fn rows_have_their_stable_keys() {
    let mut config = tiny::config(AlgorithmKind::PpoLag);
    config.frames = 4 * config.frames_per_rollout();
    let path = tiny::directory("keys");
    tiny::run(Start::Fresh(config.clone()), &path).0.unwrap();
    let text = fs::read_to_string(path.join("metrics.jsonl")).unwrap();
    let last: Value = serde_json::from_str(text.lines().last().unwrap()).unwrap();
    for key in [
        "frames",
        "updates",
        "wall_s",
        "fps",
        "episodes",
        "return_mean",
        "cost_mean",
        "length_mean",
        "budget",
        "multiplier",
        "loss",
        "policy_loss",
        "value_loss",
        "cost_value_loss",
        "entropy",
        "kl_divergence",
        "cost/risk",
    ] {
        assert!(last[key].is_number(), "{key} in {last}");
    }
    assert_eq!(last["frames"], config.frames);
    assert!(
        fs::read_dir(&path)
            .unwrap()
            .any(|entry| { entry.unwrap().file_name().to_str().unwrap().starts_with("events.out.tfevents") })
    );
    fs::remove_dir_all(path).unwrap();
}

#[test]
fn a_second_trainer_and_a_second_run_are_refused() {
    let mut config = tiny::config(AlgorithmKind::Ppo);
    config.frames = config.frames_per_rollout();
    let path = tiny::directory("second");
    let stop = AtomicBool::new(false);
    let mut inner = None;
    train(
        Start::Fresh(config.clone()),
        &path,
        &tiny::worlds,
        &mut Hooks {
            stop: &stop,
            report: &mut |_| inner = Some(tiny::run(Start::Resume { frames: None }, &path).0),
            warn: &mut |_| {},
        },
    )
    .unwrap();
    let message = inner.unwrap().unwrap_err();
    assert!(message.contains("another trainer"), "{message}");
    let message = tiny::run(Start::Fresh(config), &path).0.unwrap_err();
    assert!(message.contains("--resume"), "{message}");
    let nowhere = tiny::directory("nowhere");
    let message = tiny::run(Start::Resume { frames: None }, &nowhere).0.unwrap_err();
    assert!(message.contains("no run is here"), "{message}");
    fs::remove_dir_all(path).unwrap();
}

/// Does something to a checkpoint.
type Damage = fn(&Path);

/// Damage of every kind to the newest checkpoint: the run goes on from the one before it, and says so.
#[test]
fn a_damaged_checkpoint_gives_way_to_the_one_before() {
    let mut config = tiny::config(AlgorithmKind::PpoLag);
    config.reporting.checkpoint_seconds = 0.0;
    config.frames = 4 * config.frames_per_rollout();
    let damages: [(&str, Damage); 5] = [
        ("truncated", |path| truncate(&path.join("weights.safetensors"))),
        ("flipped", |path| {
            let file = path.join("training.safetensors");
            let mut bytes = fs::read(&file).unwrap();
            let middle = bytes.len() / 2;
            bytes[middle] ^= 4;
            fs::write(&file, bytes).unwrap();
        }),
        ("no state", |path| fs::remove_file(path.join("state.json")).unwrap()),
        ("half a state", |path| truncate(&path.join("state.json"))),
        ("empty", |path| {
            fs::remove_dir_all(path).unwrap();
            fs::create_dir(path).unwrap();
        }),
    ];
    for (name, damage) in damages {
        let path = tiny::directory(&format!("damage-{}", name.replace(' ', "-")));
        tiny::run(Start::Fresh(config.clone()), &path).0.unwrap();
        let before = rows(&path);
        let newest = path.join(format!("checkpoints/frames_{:012}", config.frames));
        damage(&newest);
        // A metrics line cut off in the middle, as a killed process leaves it.
        let metrics = path.join("metrics.jsonl");
        let mut text = fs::read_to_string(&metrics).unwrap();
        text.push_str("{\"frames\": 12");
        fs::write(&metrics, text).unwrap();
        let (result, reports, warnings) = tiny::run(Start::Resume { frames: None }, &path);
        result.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(reports.len(), 1, "{name}: one rollout was done again");
        assert!(warnings[0].contains("going back"), "{name}: {warnings:?}");
        assert!(warnings.iter().any(|warning| warning.contains("line 5 is damaged")), "{name}: {warnings:?}");
        assert_eq!(rows(&path), before, "{name}");
        for checkpoint in checkpoints(&path) {
            truncate(&checkpoint.join("state.json"));
        }
        let message = tiny::run(Start::Resume { frames: Some(config.frames * 2) }, &path).0.unwrap_err();
        assert!(message.contains("every checkpoint is damaged"), "{message}");
        fs::remove_dir_all(path).unwrap();
    }
}

fn truncate(path: &Path) {
    let bytes = fs::read(path).unwrap();
    fs::write(path, &bytes[..bytes.len() / 2]).unwrap();
}
