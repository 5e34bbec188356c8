//! Runs that are stopped where it hurts: in the midst of evaluations, and before anything was
//! learned.

mod tiny;

use hasard_envs::{ActionSpace, CostTerm};
use hasard_envs::{Autoreset, EnvError, Environment, Episode, Step, VecEnv, VecOptions};
use hasard_learn::config::{AlgorithmKind, EnvConfig, TrainConfig};
use hasard_learn::runs::trainer::{Hooks, Start, Summary, train};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

fn config() -> TrainConfig {
    let mut config = tiny::config(AlgorithmKind::PpoLag);
    config.frames = 6 * config.frames_per_rollout();
    config.evaluation.every = Some(2 * config.frames_per_rollout());
    (config.evaluation.episodes, config.evaluation.confirming_episodes) = (40, Some(40));
    // Kept from the beginning: candidates are confirmed.
    config.constraints[0].budget = 100.0;
    config
}

/// The task, raising a flag at one of its steps: of the evaluation worlds made until then, the last
/// one's.
struct Bell {
    task: tiny::Risk,
    stop: Option<Arc<AtomicBool>>,
}

impl Environment for Bell {
    fn action_space(&self) -> &ActionSpace {
        self.task.action_space()
    }
    fn observation_shape(&self) -> [usize; 3] {
        self.task.observation_shape()
    }
    fn cost_terms(&self) -> &'static [CostTerm] {
        self.task.cost_terms()
    }
    fn reset(&mut self, seed: u64) {
        self.task.reset(seed);
    }
    fn step(&mut self, actions: &[u8], deltas: &[f32]) -> Step {
        if let Some(stop) = &self.stop {
            stop.store(true, Ordering::Relaxed);
        }
        self.task.step(actions, deltas)
    }
    fn step_costs(&self) -> &[f64] {
        self.task.step_costs()
    }
    fn observe(&mut self, out: &mut [u8]) {
        self.task.observe(out);
    }
    fn episode(&self) -> Episode {
        self.task.episode()
    }
}

/// Trains until the worlds of the evaluation number `at` have made a step; gives how many
/// evaluations there were.
fn train_until(start: Start, path: &Path, at: usize) -> (Summary, usize) {
    let stop = Arc::new(AtomicBool::new(false));
    let made = AtomicUsize::new(0);
    let worlds = |_: &EnvConfig, options: VecOptions| -> Result<VecEnv, EnvError> {
        let evaluated = matches!(options.autoreset, Autoreset::Disabled);
        let rings = evaluated && made.fetch_add(1, Ordering::Relaxed) == at;
        let stop = rings.then(|| Arc::clone(&stop));
        VecEnv::from_fn(options, move |_| {
            Ok(Box::new(Bell { task: tiny::Risk::new(true), stop: stop.clone() }))
        })
    };
    let mut hooks =
        Hooks { stop: &stop, report: &mut |_| {}, warn: &mut |warning| panic!("{warning}") };
    let summary = train(start, path, &worlds, &mut hooks).unwrap();
    (summary, made.into_inner())
}

/// What is there in the end, without what a clock decides.
fn outcome(run: &Path) -> (Vec<Value>, Value, Vec<String>, Vec<u8>) {
    let text = fs::read_to_string(run.join("metrics.jsonl")).unwrap();
    let rows = text.lines().map(|line| {
        let row: Value = serde_json::from_str(line).unwrap();
        row.as_object()
            .unwrap()
            .iter()
            .filter(|(name, _)| {
                !["wall_s", "fps"].contains(&name.as_str()) && !name.starts_with("seconds_")
            })
            .map(|(name, value)| (name.clone(), value.clone()))
            .collect()
    });
    let mut names: Vec<String> = fs::read_dir(run.join("checkpoints"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.retain(|name| name.starts_with("best") || name.ends_with(&config().frames.to_string()));
    names.sort();
    let weights =
        run.join(format!("checkpoints/frames_{:012}/weights.safetensors", config().frames));
    let selected = serde_json::from_slice(&fs::read(run.join("selected.json")).unwrap()).unwrap();
    (rows.collect(), selected, names, fs::read(weights).unwrap())
}

/// Stopped in each of its evaluations, confirmations and closing episodes in turn, and twice in the
/// same one, a run ends where the uninterrupted one does: rows, selected checkpoint, weights.
#[test]
fn a_run_stopped_in_any_evaluation_equals_the_uninterrupted_one() {
    let straight = tiny::directory("stopped-never");
    let (summary, evaluations) = train_until(Start::Fresh(config()), &straight, usize::MAX);
    assert!(!summary.stopped && evaluations > 4, "{evaluations}");
    let expected = outcome(&straight);
    for at in 0..evaluations {
        let path = tiny::directory(&format!("stopped-{at}"));
        let (summary, made) = train_until(Start::Fresh(config()), &path, at);
        assert!(
            summary.stopped && made == at + 1,
            "it went on after its evaluation {at} was stopped"
        );
        assert!(!path.join("selected.json").exists(), "{at}: closed without its closing episodes");
        let (summary, _) = train_until(Start::RESUME, &path, 0);
        assert!(summary.stopped, "{at}");
        let (summary, _) = train_until(Start::RESUME, &path, usize::MAX);
        assert!(!summary.stopped, "{at}");
        assert!(outcome(&path) == expected, "{at}: {:?}\n{:?}", outcome(&path).0, expected.0);
        fs::remove_dir_all(path).unwrap();
    }
    fs::remove_dir_all(straight).unwrap();
}

/// Trains until it is refused, with `moved` called with every report and before every evaluation.
fn refused_once_moved(path: &Path, moved: &(dyn Fn(bool) + Sync)) {
    let stop = AtomicBool::new(false);
    let mut hooks = Hooks { stop: &stop, report: &mut |_| moved(false), warn: &mut |_| {} };
    let worlds = |_: &EnvConfig, options: VecOptions| {
        if matches!(options.autoreset, Autoreset::Disabled) {
            moved(true);
        }
        VecEnv::from_fn(options, |_| Ok(Box::new(tiny::Risk::new(true))))
    };
    let message = train(Start::Fresh(config()), path, &worlds, &mut hooks)
        .map(|_| ())
        .unwrap_err()
        .to_string();
    assert!(message.contains("was moved or removed") && message.contains("--resume"), "{message}");
}

/// A run whose folder was moved made another in its place, ended well and was torn in two.
#[cfg(unix)]
#[test]
fn a_run_whose_folder_is_moved_ends_there() {
    for in_evaluation in [false, true] {
        let (path, away) = (tiny::directory("stopped-moved"), tiny::directory("stopped-away"));
        refused_once_moved(&path, &|evaluates| {
            if evaluates == in_evaluation && path.exists() {
                fs::rename(&path, &away).unwrap();
            }
        });
        assert!(!path.exists(), "{in_evaluation}");
        // Put back, it goes on: from the beginning, as it had no checkpoint yet.
        fs::rename(&away, &path).unwrap();
        tiny::run(Start::RESUME, &path).0.unwrap();
        assert!(path.join("selected.json").exists());
        fs::remove_dir_all(path).unwrap();
    }
}

/// Another run had begun at the old place: what it has so far is its own.
#[cfg(unix)]
#[test]
fn a_moved_run_leaves_what_is_in_its_place() {
    let (path, away) = (tiny::directory("stopped-placed"), tiny::directory("stopped-placed-away"));
    refused_once_moved(&path, &|_| {
        if !away.exists() {
            fs::rename(&path, &away).unwrap();
            fs::create_dir_all(path.join("checkpoints")).unwrap();
            fs::write(path.join("config.json"), "another's").unwrap();
        }
    });
    assert_eq!(fs::read(path.join("config.json")).unwrap(), b"another's");
    assert!(path.join("checkpoints").exists());
    for at in [path, away] {
        fs::remove_dir_all(at).unwrap();
    }
}

/// A run whose best candidate is damaged ends with the others, and says which it passed over.
#[test]
fn a_damaged_candidate_is_one_no_more() {
    let path = tiny::directory("stopped-damaged");
    let (summary, _) = train_until(Start::Fresh(config()), &path, 3);
    assert!(summary.stopped);
    let candidates = |path: &Path| {
        let entries = fs::read_dir(path.join("checkpoints")).unwrap();
        let mut found: Vec<_> = entries
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.to_str().unwrap().contains("best_"))
            .collect();
        found.sort();
        found
    };
    let before = candidates(&path);
    assert!(before.len() > 1, "{before:?}");
    let weights = before[0].join("weights.safetensors");
    let bytes = fs::read(&weights).unwrap();
    fs::write(&weights, &bytes[..bytes.len() / 2]).unwrap();
    let (result, _, warnings) = tiny::run(Start::RESUME, &path);
    result.unwrap();
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(
        warnings[0].contains(before[0].file_name().unwrap().to_str().unwrap())
            && warnings[0].contains("a candidate no more"),
        "{warnings:?}"
    );
    let left = candidates(&path);
    assert!(left.len() == 1 && left[0] != before[0], "{left:?}");
    fs::remove_dir_all(path).unwrap();
}

/// A run that ended without an evaluation is evaluated when it is resumed and asked for one.
#[test]
fn a_finished_run_is_evaluated_when_that_is_asked_for() {
    let path = tiny::directory("stopped-late");
    let mut config = config();
    config.evaluation.every = Some(0);
    train_until(Start::Fresh(config), &path, usize::MAX);
    let rows = fs::read(path.join("metrics.jsonl")).unwrap();
    assert!(!path.join("selected.json").exists());
    let (summary, made) = train_until(
        Start::Resume { settings: vec!["evaluation.every=512".into()] },
        &path,
        usize::MAX,
    );
    assert!(
        summary.selection.is_some_and(|selection| selection.selected.closing.is_some())
            && made >= 2
    );
    assert!(path.join("selected.json").exists());
    assert_eq!(fs::read(path.join("metrics.jsonl")).unwrap(), rows);
    // Once is enough.
    assert_eq!(train_until(Start::RESUME, &path, usize::MAX).1, 0);
    fs::remove_dir_all(path).unwrap();
}

/// Nothing that counts as a run is left where nothing was learned, whatever went wrong.
#[test]
fn a_run_that_learned_nothing_leaves_nothing() {
    for (name, after) in [("at once", 1), ("in the first rollout", 12)] {
        let path = tiny::directory("stopped-early");
        let worlds = |_: &EnvConfig, options| {
            VecEnv::from_fn(options, |_| Ok(Box::new(tiny::Broken::after(after))))
        };
        let stop = AtomicBool::new(false);
        let mut hooks = Hooks { stop: &stop, report: &mut |_| {}, warn: &mut |_| {} };
        let message = train(Start::Fresh(config()), &path, &worlds, &mut hooks)
            .map(|_| ())
            .unwrap_err()
            .to_string();
        assert!(message.contains("gave way"), "{message}");
        assert!(
            !path.exists(),
            "{name}: {:?}",
            fs::read_dir(&path).unwrap().map(|e| e.unwrap().file_name()).collect::<Vec<_>>()
        );
    }
    // What was there before stays.
    let path = tiny::directory("stopped-notes");
    fs::create_dir_all(&path).unwrap();
    fs::write(path.join("notes.txt"), "mine").unwrap();
    let worlds =
        |_: &EnvConfig, options| VecEnv::from_fn(options, |_| Ok(Box::new(tiny::Broken::after(1))));
    let stop = AtomicBool::new(false);
    let mut hooks = Hooks { stop: &stop, report: &mut |_| {}, warn: &mut |_| {} };
    assert!(train(Start::Fresh(config()), &path, &worlds, &mut hooks).is_err());
    let left: Vec<_> =
        fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["notes.txt"]);
    fs::remove_dir_all(path).unwrap();
}
