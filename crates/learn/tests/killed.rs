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
    // A checkpoint after every rollout: whenever the run is killed, it is often while one is being written.
    config.reporting.checkpoint_seconds = 0.0;
    config.frames = 60 * config.frames_per_rollout();
    config
}

fn start(path: &Path) -> Start<'static> {
    if path.join("config.json").exists() { Start::Resume { frames: None } } else { Start::Fresh(config()) }
}

/// The child of the test below; does nothing by itself.
#[test]
fn child() {
    if let Some(path) = std::env::var_os(DIRECTORY) {
        let path = Path::new(&path);
        let (result, _, warnings) = tiny::run(start(path), path);
        assert!(warnings.iter().all(|warning| warning.contains("line") || warning.contains("no checkpoint")), "{warnings:?}");
        result.unwrap();
    }
}

fn weights(run: &Path) -> Vec<u8> {
    fs::read(run.join(format!("checkpoints/frames_{:012}/weights.safetensors", config().frames))).unwrap()
}

/// Killed with SIGKILL at three moments and resumed each time, the run ends where the uninterrupted one does.
#[test]
fn a_run_killed_three_times_equals_the_uninterrupted_one() {
    let straight = tiny::directory("never-killed");
    tiny::run(Start::Fresh(config()), &straight).0.unwrap();
    let broken = tiny::directory("killed");
    let seed = std::process::id();
    let mut delays = (0..3).map(|index| 60 + u64::from(seed.wrapping_mul(2_654_435_761).rotate_left(index * 7) % 120));
    let mut kills = 0;
    loop {
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "child", "--nocapture"])
            .env(DIRECTORY, &broken)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let Some(delay) = delays.next() else {
            assert!(child.wait().unwrap().success(), "the last resume must reach the end");
            break;
        };
        std::thread::sleep(Duration::from_millis(delay));
        child.kill().unwrap();
        kills += u32::from(!child.wait().unwrap().success());
    }
    println!("killed {kills} times before the end");
    assert!(weights(&straight) == weights(&broken), "weights differ after {kills} kills");
    let partial = fs::read_dir(broken.join("checkpoints"))
        .unwrap()
        .filter(|entry| entry.as_ref().unwrap().path().extension().is_some_and(|extension| extension == "partial"));
    assert_eq!(partial.count(), 0, "half-written checkpoints are left behind");
    fs::remove_dir_all(straight).unwrap();
    fs::remove_dir_all(broken).unwrap();
}

/// A disk without room: the run ends with an error that names the file, and what was written before is whole.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_ends_the_run_with_an_error_and_loses_nothing() {
    let path = tiny::directory("full-disk");
    let mut config = config();
    config.frames = 4 * config.frames_per_rollout();
    // Checkpoints fit, the report at the end does not: metrics go to the device that is always full.
    config.reporting.report_seconds = 1e9;
    fs::create_dir_all(&path).unwrap();
    let log = path.join("metrics.jsonl");
    std::os::unix::fs::symlink("/dev/full", &log).unwrap();
    let (result, ..) = tiny::run(Start::Fresh(config.clone()), &path);
    let message = result.unwrap_err();
    assert!(message.contains("metrics.jsonl") && message.contains("No space left"), "{message}");
    assert!(message.contains("--resume"), "{message}");
    fs::remove_file(&log).unwrap();
    let (result, _, warnings) = tiny::run(Start::Resume { frames: Some(2 * config.frames) }, &path);
    assert_eq!(result.unwrap().last.frames, 2 * config.frames);
    assert!(warnings.is_empty(), "{warnings:?}");
    fs::remove_dir_all(path).unwrap();
}
