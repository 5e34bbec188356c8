//! Runs that end badly: killed at any moment, or with a full disk.

mod tiny;

use hasard_learn::config::{AlgorithmKind, TrainConfig};
use hasard_learn::runs::trainer::Start;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

const DIRECTORY: &str = "HASARD_TEST_RUN";

fn config() -> TrainConfig {
    let mut config = tiny::config(AlgorithmKind::PpoLag);
    // A checkpoint after every rollout: whenever the run is killed, it is often while one is being
    // written.
    config.reporting.checkpoint_seconds = 0.0;
    // Long enough to be still at it when it is killed for the third time.
    config.frames = 240 * config.frames_per_rollout();
    // Candidates are written and replaced meanwhile too.
    config.evaluation.every = Some(5 * config.frames_per_rollout());
    config.evaluation.confirming_episodes = Some(32);
    config
}

fn start(path: &Path) -> Start {
    if path.join("config.json").exists() { Start::RESUME } else { Start::Fresh(config()) }
}

/// The child of the test below; does nothing by itself.
#[test]
fn child() {
    if let Some(path) = std::env::var_os(DIRECTORY) {
        let path = Path::new(&path);
        let (result, _, warnings) = tiny::run(start(path), path);
        assert!(
            warnings
                .iter()
                .all(|warning| warning.contains("line") || warning.contains("no checkpoint")),
            "{warnings:?}"
        );
        result.unwrap();
    }
}

fn weights(run: &Path) -> Vec<u8> {
    fs::read(run.join(format!("checkpoints/frames_{:012}/weights.safetensors", config().frames)))
        .unwrap()
}

/// What a run selects, and the weights of it.
fn selected(run: &Path) -> (serde_json::Value, Vec<u8>) {
    let written: serde_json::Value =
        serde_json::from_slice(&fs::read(run.join("selected.json")).unwrap()).unwrap();
    let frames = written["frames"].as_u64().unwrap();
    let best =
        fs::read(run.join(format!("checkpoints/best_{frames:012}/weights.safetensors"))).unwrap();
    (written, best)
}

/// Frames of the newest checkpoint of a run.
fn reached(run: &Path) -> u64 {
    let entries = fs::read_dir(run.join("checkpoints")).into_iter().flatten();
    let frames = entries.filter_map(|entry| {
        entry.ok()?.file_name().to_str()?.strip_prefix("frames_")?.parse().ok()
    });
    frames.max().unwrap_or(0)
}

/// Killed with SIGKILL at three moments and resumed each time, the run ends where the uninterrupted
/// one does.
#[test]
fn a_run_killed_three_times_equals_the_uninterrupted_one() {
    let straight = tiny::directory("never-killed");
    tiny::run(Start::Fresh(config()), &straight).0.unwrap();
    let broken = tiny::directory("killed");
    let seed = std::process::id();
    let mut moments = (0..3).map(|index| seed.wrapping_mul(2_654_435_761).rotate_left(index * 7));
    loop {
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "child", "--nocapture"])
            .env(DIRECTORY, &broken)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let Some(moment) = moments.next() else {
            assert!(child.wait().unwrap().success(), "the last resume must reach the end");
            break;
        };
        // Somewhere within the ten rollouts after the next checkpoint: by progress, for machines
        // are not equally fast.
        let before = reached(&broken);
        let further = before + u64::from(1 + moment % 10) * config().frames_per_rollout();
        while reached(&broken) < further {
            assert!(child.try_wait().unwrap().is_none(), "the run ended before it was killed");
            std::thread::sleep(Duration::from_micros(200));
        }
        std::thread::sleep(Duration::from_micros(u64::from(moment >> 8 & 0xFFF)));
        child.kill().unwrap();
        assert!(!child.wait().unwrap().success(), "the run ended before it was killed");
        assert!(reached(&broken) < config().frames, "the run was over when it was killed");
    }
    assert!(weights(&straight) == weights(&broken), "weights differ");
    assert_eq!(selected(&straight), selected(&broken), "another checkpoint is selected");
    let partial = fs::read_dir(broken.join("checkpoints")).unwrap().filter(|entry| {
        entry.as_ref().unwrap().path().extension().is_some_and(|extension| extension == "partial")
    });
    assert_eq!(partial.count(), 0, "half-written checkpoints are left behind");
    fs::remove_dir_all(straight).unwrap();
    fs::remove_dir_all(broken).unwrap();
}

/// A disk without room: the run ends with an error that names the file, and what was written before
/// is whole.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_ends_the_run_with_an_error_and_loses_nothing() {
    let path = tiny::directory("full-disk");
    let mut config = config();
    config.frames = 4 * config.frames_per_rollout();
    // Checkpoints fit, the report at the end does not: metrics go to the device that is always
    // full.
    config.reporting.report_seconds = 1e9;
    fs::create_dir_all(&path).unwrap();
    let log = path.join("metrics.jsonl");
    std::os::unix::fs::symlink("/dev/full", &log).unwrap();
    let (result, ..) = tiny::run(Start::Fresh(config.clone()), &path);
    let message = result.unwrap_err();
    assert!(message.contains("metrics.jsonl") && message.contains("No space left"), "{message}");
    assert!(message.contains("--resume"), "{message}");
    fs::remove_file(&log).unwrap();
    let (result, _, warnings) =
        tiny::run(Start::Resume { settings: vec![format!("frames={}", 2 * config.frames)] }, &path);
    assert_eq!(result.unwrap().last.frames, 2 * config.frames);
    assert!(warnings.is_empty(), "{warnings:?}");
    fs::remove_dir_all(path).unwrap();
}

/// A run that goes back to an older checkpoint makes other ones than its selection was made from; and
/// a folder with a selection alone is no place for a run.
#[test]
fn a_selection_of_what_is_made_anew_is_made_anew() {
    let run = tiny::directory("selection-ahead");
    let mut config = config();
    config.frames = 40 * config.frames_per_rollout();
    config.reporting.keep = 40;
    tiny::run(Start::Fresh(config.clone()), &run).0.unwrap();
    let before = selected(&run);
    // As if the run had gone another way: this selection is of other policies.
    let mut other = before.0.clone();
    other["surely_within"] = (!other["surely_within"].as_bool().unwrap()).into();
    fs::write(run.join("selected.json"), other.to_string()).unwrap();
    for entry in fs::read_dir(run.join("checkpoints")).unwrap() {
        let path = entry.unwrap().path();
        let frames = path.file_name().unwrap().to_str().unwrap().strip_prefix("frames_");
        if frames.is_some_and(|frames| frames.parse::<u64>().unwrap() > config.frames / 2) {
            fs::remove_dir_all(path).unwrap();
        }
    }
    tiny::run(Start::RESUME, &run).0.unwrap();
    assert_eq!(selected(&run), before);
    for gone in ["config.json", "metrics.jsonl"] {
        fs::remove_file(run.join(gone)).unwrap();
    }
    fs::remove_dir_all(run.join("checkpoints")).unwrap();
    let error = tiny::run(Start::Fresh(config), &run).0.unwrap_err().to_string();
    assert!(error.contains("a selection of a run"), "{error}");
    assert!(run.join("selected.json").is_file() && !run.join("config.json").exists());
}
