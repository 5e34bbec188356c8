//! Runs and their directories: resuming, stopping, locking, damage.
//!
//! Long because runs that go on after a stop are compared in many ways with one that never stopped.

mod tiny;

use hasard_envs::{EnvError, Environment, LaneState, VecEnv, VecOptions};
use hasard_learn::config::curriculum::Lesson;
use hasard_learn::config::{AlgorithmKind, Constraint, EnvConfig, Preset, TrainConfig};
use hasard_learn::networks::distribution::ActionShape;
use hasard_learn::runs::agent::{Agent, Choice, TrainedPolicy, Which};
use hasard_learn::runs::checkpoint::Loaded;
use hasard_learn::runs::evaluate::{Evaluation, play};
use hasard_learn::runs::run_directory::read_config;
use hasard_learn::runs::trainer::{Hooks, Start, train};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

fn checkpoints(run: &Path) -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> =
        fs::read_dir(run.join("checkpoints")).unwrap().map(|entry| entry.unwrap().path()).collect();
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
    let last = paths
        .iter()
        .rfind(|path| path.file_name().unwrap().to_str().unwrap().starts_with("frames_"))
        .unwrap();
    let mut state: Value =
        serde_json::from_slice(&fs::read(last.join("state.json")).unwrap()).unwrap();
    state["progress"].as_object_mut().unwrap().remove("wall_seconds");
    (
        fs::read(last.join("weights.safetensors")).unwrap(),
        fs::read(last.join("training.safetensors")).unwrap(),
        state,
    )
}

/// A run ended after half its frames and resumed equals the run that went straight through: every
/// weight, moment, multiplier, statistic and row of metrics, for several algorithms and ways of
/// sampling.
#[test]
fn a_resumed_run_equals_the_uninterrupted_one_bit_by_bit() {
    for (algorithm, samplers, groups, world_threads) in [
        (AlgorithmKind::PpoLag, 2, 1, 0),
        (AlgorithmKind::PpoPid, 1, 2, 1),
        (AlgorithmKind::PpoSaute, 2, 2, 0),
        (AlgorithmKind::Cup, 2, 1, 0),
        (AlgorithmKind::TrpoLag, 2, 1, 0),
        (AlgorithmKind::TrpoPid, 1, 1, 0),
    ] {
        let mut config = tiny::config(algorithm);
        if algorithm == AlgorithmKind::Cup {
            config.constraints.push(Constraint { term: Some("second".into()), budget: 1.0 });
        }
        if matches!(algorithm, AlgorithmKind::PpoPid | AlgorithmKind::Cup) {
            config.learning.budget_annealing = Some(0.6);
            config.learning.final_gamma = Some(0.9);
            config.learning.final_gae_lambda = Some(0.5);
        }
        if algorithm == AlgorithmKind::TrpoPid {
            // The TRPO family as released.
            let released = TrainConfig::plain(algorithm, Preset::Released, config.env.clone());
            config.algorithm_settings = released.algorithm_settings;
            config.constraint_statistic = released.constraint_statistic;
            config.network.initialisation = released.network.initialisation;
        }
        config.sampling.samplers = samplers;
        config.sampling.groups = groups;
        config.sampling.world_threads = world_threads;
        // A rollout that is no multiple of the episode, so that the run ends inside episodes.
        config.sampling.rollout = 13;
        config.learning.final_rate = Some(1e-3);
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
        let (resumed, ..) = tiny::run(Start::RESUME, &broken);
        assert!(!resumed.unwrap().stopped);
        let (a, b) = (last_files(&straight), last_files(&broken));
        assert!(a.0 == b.0, "{algorithm}: weights differ");
        assert!(a.1 == b.1, "{algorithm}: optimiser or lanes differ");
        assert_eq!(a.2, b.2, "{algorithm}");
        assert_eq!(rows(&straight), rows(&broken), "{algorithm}");
        // While all episodes are in the window, their costs add up to its mean times their number.
        let early = rows(&straight)
            .into_iter()
            .rfind(|row| row["episodes"].as_f64().unwrap() <= 100.0)
            .unwrap();
        let sum = early["cost_mean"].as_f64().unwrap_or(0.0) * early["episodes"].as_f64().unwrap();
        assert!((early["cost_total"].as_f64().unwrap() - sum).abs() < 1e-6, "{early}");
        // Of what the first episodes cost, down to the budget.
        if config.learning.budget_annealing.is_some() {
            let aims: Vec<f64> =
                rows(&straight).iter().map(|row| row["aimed_budget"].as_f64().unwrap()).collect();
            assert!(aims[0] >= aims[3] && aims[3] > 4.0 && aims[7] == 4.0, "{algorithm}: {aims:?}");
        }
        let last = rows(&straight).pop().unwrap();
        assert!(
            last["violation_total"].as_f64().unwrap() > 0.0
                && last["cost_total"].as_f64().unwrap() > sum,
            "{last}"
        );
        fs::remove_dir_all(straight).unwrap();
        fs::remove_dir_all(broken).unwrap();
    }
}

/// Neither samplers, groups and threads, of whatever number, nor what the samplers keep for the
/// learner changes a bit.
#[test]
fn a_run_does_not_depend_on_how_lanes_are_dealt_out() {
    let mut all = Vec::new();
    for (samplers, groups, world_threads, threads) in
        [(1, 1, 0, 1), (4, 1, 0, 2), (1, 2, 2, 3), (2, 4, 1, 1), (3, 1, 0, 3), (40, 1, 0, 50)]
    {
        // The multiplier looks at the latest episodes: in the order in which they ended.
        let mut config = tiny::config(AlgorithmKind::PpoLag);
        config.sampling.samplers = samplers;
        config.sampling.groups = groups;
        config.sampling.world_threads = world_threads;
        config.learning.threads = threads;
        config.frames = 3 * config.frames_per_rollout();
        let path = tiny::directory(&format!("deal-{samplers}-{groups}"));
        tiny::run(Start::Fresh(config), &path).0.unwrap();
        all.push(last_files(&path).0);
        fs::remove_dir_all(path).unwrap();
    }
    assert!(all.iter().all(|weights| *weights == all[0]), "weights after three rollouts differ");
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
    assert!(fs::read_dir(&path).unwrap().any(|entry| {
        entry.unwrap().file_name().to_str().unwrap().starts_with("events.out.tfevents")
    }));
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
            report: &mut |_| inner = Some(tiny::run(Start::RESUME, &path).0),
            warn: &mut |_| {},
        },
    )
    .unwrap();
    let message = inner.unwrap().unwrap_err();
    assert!(message.contains("another trainer"), "{message}");
    let message = tiny::run(Start::Fresh(config), &path).0.unwrap_err();
    assert!(message.contains("--resume"), "{message}");
    let nowhere = tiny::directory("nowhere");
    let message = tiny::run(Start::RESUME, &nowhere).0.unwrap_err();
    assert!(message.contains("nothing is here"), "{message}");
    fs::remove_dir_all(path).unwrap();
}

/// Does something to a checkpoint.
type Damage = fn(&Path);

/// Damage of every kind to the newest checkpoint: the run goes on from the one before it, and says
/// so.
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
        let (result, reports, warnings) = tiny::run(Start::RESUME, &path);
        result.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(reports.len(), 1, "{name}: one rollout was done again");
        assert!(warnings[0].contains("going back"), "{name}: {warnings:?}");
        assert!(
            warnings.iter().any(|warning| warning.contains("line 5 is damaged")),
            "{name}: {warnings:?}"
        );
        assert_eq!(rows(&path), before, "{name}");
        for checkpoint in checkpoints(&path) {
            truncate(&checkpoint.join("state.json"));
        }
        let message = tiny::run(
            Start::Resume { settings: vec![format!("frames={}", config.frames * 2)] },
            &path,
        )
        .0
        .unwrap_err();
        assert!(message.contains("every checkpoint is damaged"), "{message}");
        fs::remove_dir_all(path).unwrap();
    }
}

fn truncate(path: &Path) {
    let bytes = fs::read(path).unwrap();
    fs::write(path, &bytes[..bytes.len() / 2]).unwrap();
}

/// An agent loaded from a run does what the run learned, the same for the same seed, whatever acts
/// beside it.
#[test]
fn a_loaded_agent_acts_as_it_learned() {
    let mut config = tiny::config(AlgorithmKind::Ppo);
    config.frames = 80 * config.frames_per_rollout();
    let path = tiny::directory("agent");
    tiny::run(Start::Fresh(config), &path).0.unwrap();
    let play = |choice: Choice, lanes: usize, first_seed: u64| -> Vec<(f64, f64)> {
        let shape = ActionShape { sizes: vec![2, 3], deltas: 0 };
        let observation = [tiny::SIDE, tiny::SIDE, 1];
        let mut warn = |warning| panic!("{warning}");
        let mut agent =
            Agent::load(&path, Which::Latest, choice, lanes, observation, shape, &mut warn)
                .unwrap();
        let mut worlds: Vec<tiny::Risk> = (0..lanes).map(|_| tiny::Risk::new(true)).collect();
        for (lane, world) in worlds.iter_mut().enumerate() {
            world.reset(first_seed + lane as u64);
            agent.reset(lane, first_seed + lane as u64);
        }
        for _ in 0..tiny::STEPS {
            let mut observations = vec![0; lanes * tiny::SIDE * tiny::SIDE];
            for (world, out) in
                worlds.iter_mut().zip(observations.chunks_exact_mut(tiny::SIDE * tiny::SIDE))
            {
                world.observe(out);
            }
            for (lane, (world, action)) in
                worlds.iter_mut().zip(agent.act(&observations)).enumerate()
            {
                let step = world.step(&action.actions, &action.deltas);
                agent.observe_cost(lane, step.cost, world.step_costs());
            }
        }
        worlds.iter().map(|world| (world.episode().episode_return, world.episode().cost)).collect()
    };
    let together = play(Choice::Sampled, 4, 100);
    let alone: Vec<_> = (100..104).flat_map(|seed| play(Choice::Sampled, 1, seed)).collect();
    assert_eq!(together, alone);
    assert!(
        together.iter().all(|(_, cost)| *cost >= 8.0),
        "{together:?}: PPO learns to take every risk"
    );
    assert!(play(Choice::Greedy, 3, 7).iter().all(|(_, cost)| *cost == 10.0));
    let mut warn = |_| {};
    let wrong = ActionShape { sizes: vec![9], deltas: 0 };
    let Err(error) =
        Agent::load(&path, Which::Latest, Choice::Greedy, 1, [6, 6, 1], wrong, &mut warn)
    else {
        panic!("weights of another shape were accepted")
    };
    assert!(error.to_string().contains("does not fit"), "{error}");
    fs::remove_dir_all(path).unwrap();
}

#[test]
fn a_residual_encoder_takes_the_place_of_the_convolutions() {
    let mut config = tiny::config(AlgorithmKind::PpoLag);
    assert!(!config.network.convolutions.is_empty());
    config.network.residual = vec![32];
    config.frames = 2 * config.frames_per_rollout();
    let path = tiny::directory("residual");
    tiny::run(Start::Fresh(config), &path).0.unwrap();
    let loaded = Loaded::read(checkpoints(&path).last().unwrap()).unwrap();
    let tensors = loaded.tensors().unwrap();
    assert_eq!(
        tensors.tensor("network0.stage0.block1.convolution1.weight").unwrap().shape(),
        [3, 3, 32, 32]
    );
    assert!(tensors.names().iter().all(|name| !name.starts_with("network0.convolution")));
    let shape = ActionShape { sizes: vec![2, 3], deltas: 0 };
    let side = tiny::SIDE;
    let mut agent =
        Agent::load(&path, Which::Latest, Choice::Greedy, 2, [side, side, 1], shape, &mut |_| {})
            .unwrap();
    assert_eq!(agent.act(&vec![9; 2 * side * side]).len(), 2);
    fs::remove_dir_all(path).unwrap();
}

#[test]
fn first_episodes_end_spread_over_time() {
    let count = |spread_out: bool| {
        let mut config = tiny::config(AlgorithmKind::Ppo);
        config.sampling.spread_out = spread_out;
        config.sampling.rollout = 5;
        config.frames = config.frames_per_rollout();
        let path = tiny::directory(if spread_out { "spread" } else { "not-spread" });
        let (_, reports, _) = tiny::run(Start::Fresh(config), &path);
        fs::remove_dir_all(path).unwrap();
        reports[0].episodes
    };
    assert_eq!(count(false), 0);
    assert!((12..=20).contains(&count(true)), "about half of 32 episodes of 10 steps end within 5");
}

/// Weights carry over from one run to the next; counters, multipliers and optimisers start anew.
#[test]
fn a_curriculum_carries_weights_over() {
    let mut config = tiny::config(AlgorithmKind::PpoLag);
    config.frames = 2 * config.frames_per_rollout();
    let (first, second) = (tiny::directory("first-level"), tiny::directory("second-level"));
    tiny::run(Start::Fresh(config.clone()), &first).0.unwrap();
    config.learning.rate = 0.0;
    let (result, reports, _) = tiny::run(Start::From(config, first.clone()), &second);
    assert_eq!(
        result.unwrap().last.updates,
        8,
        "two rollouts of two epochs of two minibatches, counted from zero"
    );
    assert_eq!(reports.len(), 2);
    // With a learning rate of zero the weights at the end are those at the start; the pixel
    // statistics go on.
    let weights = |run: &Path| last_files(run).0;
    let (a, b) = (weights(&first), weights(&second));
    let parameters = |bytes: &[u8]| {
        let tensors = safetensors::SafeTensors::deserialize(bytes).unwrap();
        let names = tensors
            .names()
            .into_iter()
            .filter(|name| name.starts_with("network"))
            .collect::<Vec<_>>();
        let mut all: Vec<(String, Vec<u8>)> = names
            .iter()
            .map(|name| (name.to_string(), tensors.tensor(name).unwrap().data().to_vec()))
            .collect();
        all.sort();
        all
    };
    assert!(parameters(&a) == parameters(&b));
    assert!(a != b, "the pixel statistics have gone on");
    fs::remove_dir_all(first).unwrap();
    fs::remove_dir_all(second).unwrap();
}

/// The settings mended, the same command finds its directory free; what else was in it stays.
#[test]
fn a_run_that_cannot_begin_leaves_nothing_behind() {
    let mut config = tiny::config(AlgorithmKind::PpoLag);
    config.frames = config.frames_per_rollout();
    let good = config.clone();
    config.constraints[0].term = Some("rain".into());
    let path = tiny::directory("cannot-begin");
    assert!(
        tiny::run(Start::Fresh(config.clone()), &path).0.unwrap_err().to_string().contains("rain")
    );
    assert!(!path.exists());
    fs::create_dir_all(&path).unwrap();
    fs::write(path.join("notes.txt"), "mine").unwrap();
    assert!(tiny::run(Start::Fresh(config), &path).0.is_err());
    let left: Vec<_> =
        fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["notes.txt"]);
    tiny::run(Start::Fresh(good), &path).0.unwrap();
    fs::remove_dir_all(path).unwrap();
}

/// A world that panics ends the run with a clear error, and the checkpoints before it stay.
#[test]
fn a_panic_in_a_world_ends_the_run_with_an_error() {
    let mut config = tiny::config(AlgorithmKind::Ppo);
    config.reporting.checkpoint_seconds = 0.0;
    config.frames = 50 * config.frames_per_rollout();
    for world_threads in [0, 1] {
        config.sampling.world_threads = world_threads;
        let path = tiny::directory(&format!("panic-{world_threads}"));
        let stop = AtomicBool::new(false);
        let mut warn = |_| {};
        let result = train(
            Start::Fresh(config.clone()),
            &path,
            &|_, options| VecEnv::from_fn(options, |_| Ok(Box::new(tiny::Broken::after(60)))),
            &mut Hooks { stop: &stop, report: &mut |_| {}, warn: &mut warn },
        );
        let message = result.unwrap_err().to_string();
        assert!(message.contains("the floor gave way"), "{message}");
        assert!(!checkpoints(&path).is_empty());
        fs::remove_dir_all(path).unwrap();
    }
}

/// Two lessons of the tiny task: the second level's worlds time out, the first level's end.
fn lessons(env: &EnvConfig, options: VecOptions) -> Result<VecEnv, EnvError> {
    let second = env.id == "RemedyRushLevel2-v0";
    VecEnv::from_fn(options, move |_| Ok(Box::new(tiny::Risk::new(second))))
}

/// A curriculum that is stopped after every single rollout, and so in the midst of a lesson, at its
/// last rollout and at the next one's first, ends where the one that never stopped does; and it is
/// another run than its last level alone.
#[test]
fn a_curriculum_stopped_at_every_moment_equals_the_uninterrupted_one() {
    let mut config = tiny::config(AlgorithmKind::PpoPid);
    config.env.id = "RemedyRushLevel1-v0".into();
    config.sampling.rollout = 13;
    config.learning.budget_annealing = Some(0.8);
    let rollout = config.frames_per_rollout();
    // The first lesson ends inside its third rollout.
    config.set_curriculum(vec![
        Lesson { level: 1, frames: 3 * rollout - 5 },
        Lesson { level: 2, frames: 3 * rollout + 5 },
    ]);
    let go = |start: Start, path: &Path, rollouts: usize| {
        let stop = AtomicBool::new(false);
        let mut count = 0;
        let mut report = |_: &hasard_learn::runs::report::Report| {
            count += 1;
            stop.store(count == rollouts, Ordering::Relaxed);
        };
        let mut warn = |warning: String| panic!("{warning}");
        train(
            start,
            path,
            &lessons,
            &mut Hooks { stop: &stop, report: &mut report, warn: &mut warn },
        )
        .unwrap()
        .stopped
    };
    let straight = tiny::directory("lessons-straight");
    assert!(!go(Start::Fresh(config.clone()), &straight, usize::MAX));
    let levels: Vec<Value> = rows(&straight).iter().map(|row| row["level"].clone()).collect();
    assert_eq!(levels, [1, 1, 1, 2, 2, 2]);
    // An annealed budget comes down through the lessons, from what the run's first episodes cost.
    let aims: Vec<f64> =
        rows(&straight).iter().map(|row| row["aimed_budget"].as_f64().unwrap()).collect();
    assert!(aims[1..].windows(2).all(|two| two[0] >= two[1]), "{aims:?}");
    assert!(aims[2] > aims[3] && aims[3] > 4.0 && aims[5] == 4.0, "{aims:?}");
    let broken = tiny::directory("lessons-broken");
    let mut stopped = go(Start::Fresh(config.clone()), &broken, 1);
    let mut times = 1;
    while stopped {
        stopped = go(Start::RESUME, &broken, 1);
        times += 1;
    }
    assert_eq!(times, 6);
    let (a, b) = (last_files(&straight), last_files(&broken));
    assert!(a.0 == b.0, "weights differ");
    assert!(a.1 == b.1, "optimiser or lanes differ");
    assert_eq!(a.2, b.2);
    assert_eq!(rows(&straight), rows(&broken));
    // Optimisers start anew with the lesson: three rollouts of two epochs of two minibatches.
    assert_eq!(
        (&a.2["progress"]["optimiser_steps"][0], &a.2["progress"]["updates"]),
        (&json!(12), &json!(24))
    );
    let alone = tiny::directory("lessons-alone");
    let last = TrainConfig { curriculum: Vec::new(), ..config };
    go(Start::Fresh(last), &alone, usize::MAX);
    assert!(last_files(&alone).0 != a.0, "the first lesson changed nothing");
    for path in [straight, broken, alone] {
        fs::remove_dir_all(path).unwrap();
    }
}

/// A panic in the learner's own thread ends the run with an error too, and the run goes on from its
/// last checkpoint.
#[test]
fn a_panic_of_the_learner_ends_the_run_with_an_error_and_it_goes_on() {
    let mut config = tiny::config(AlgorithmKind::PpoLag);
    config.reporting.checkpoint_seconds = 0.0;
    config.frames = 6 * config.frames_per_rollout();
    let straight = tiny::directory("never-panicked");
    tiny::run(Start::Fresh(config.clone()), &straight).0.unwrap();
    let path = tiny::directory("learner-panic");
    let stop = AtomicBool::new(false);
    let third = 3 * config.frames_per_rollout();
    let mut hear = |report: &hasard_learn::runs::report::Report| {
        assert!(report.frames < third, "the tape tore")
    };
    let result = train(
        Start::Fresh(config),
        &path,
        &tiny::worlds,
        &mut Hooks { stop: &stop, report: &mut hear, warn: &mut |_| {} },
    );
    let message = result.unwrap_err().to_string();
    assert!(message.contains("the learner") && message.contains("the tape tore"), "{message}");
    tiny::run(Start::RESUME, &path).0.unwrap();
    assert_eq!(rows(&path), rows(&straight));
    fs::remove_dir_all(straight).unwrap();
    fs::remove_dir_all(path).unwrap();
}

/// A run is evaluated by frames; it selects the best checkpoint within its budget, and says what
/// that is worth.
#[test]
fn a_run_selects_its_best_checkpoint_within_the_budget() {
    let mut config = tiny::config(AlgorithmKind::PpoLag);
    config.frames = 60 * config.frames_per_rollout();
    config.evaluation.every = Some(4 * config.frames_per_rollout());
    config.algorithm_settings.multiplier_rate = 0.4;
    // Of episodes that the clock ends after ten steps, half of the steps see all of the cost to
    // come that has some weight.
    config.learning.cost_gamma = Some(0.5);
    let path = tiny::directory("selection");
    let (summary, reports, _) = tiny::run(Start::Fresh(config.clone()), &path);
    let evaluated: Vec<_> = reports
        .iter()
        .filter_map(|report| Some((report.frames, report.evaluation.clone()?)))
        .collect();
    assert_eq!(evaluated.len(), 15);
    let selection = summary.unwrap().selection.unwrap();
    let selected = &selection.selected;
    assert!(selected.confirmed && selected.chosen_by.within(), "{selected:?}");
    assert!(evaluated.iter().any(|(frames, _)| *frames == selected.frames));
    // Of the candidates that kept the budget none returned more, but those that failed further
    // episodes.
    let by_candidacy = &evaluated.iter().find(|(frames, _)| *frames == selected.frames).unwrap().1;
    for (frames, other) in &evaluated {
        let failed = selection.failed.iter().any(|one| one.frames == *frames);
        assert!(
            failed
                || !other.within()
                || other.episode_return.mean <= by_candidacy.episode_return.mean,
            "{frames}"
        );
    }
    let closing = selected.closing.as_ref().unwrap();
    assert_eq!((closing.episodes, closing.constraints[0].budget), (100, 4.0));
    // The best is 4 at cost 4; a policy that is blind to the picture gets 0.7 out of each unit of
    // cost.
    assert!(closing.within() && closing.episode_return.mean > 2.9, "{closing:?}");
    // Rows have it too, and other episodes of the agent that is loaded from the directory cost as
    // much.
    let last = rows(&path).pop().unwrap();
    assert!(last["eval/cost_mean"].is_number() && last["eval/episodes"] == 32, "{last}");
    let written: Value =
        serde_json::from_slice(&fs::read(path.join("selected.json")).unwrap()).unwrap();
    assert_eq!(
        (&written["frames"], &written["last"]["frames"]),
        (&json!(selected.frames), &json!(config.frames))
    );
    assert_eq!(
        (&written["last"]["episodes"], &written["closing"]["episodes"]),
        (&json!(100), &json!(100))
    );
    // Its episodes stay with the run, and are those of the closing evaluation.
    let lines = |name: &str| -> Vec<Value> {
        let text = fs::read_to_string(path.join(name)).unwrap();
        text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    };
    let episodes_of = |name: &str| {
        lines(name).iter().map(|line| line["cost"].as_f64().unwrap()).collect::<Vec<_>>()
    };
    let kept = episodes_of("closing_episodes.jsonl");
    assert_eq!((kept.len(), kept.iter().sum::<f64>() / 100.0), (100, closing.cost.mean));
    assert_eq!(lines("closing_episodes.jsonl")[0]["uncounted"], json!(["second"]));
    let last_costs = episodes_of("last_policy_episodes.jsonl");
    assert_eq!(
        last_costs.iter().sum::<f64>() / 100.0,
        selection.last.as_ref().unwrap().closing.cost.mean
    );
    // 15 evaluations of 32 episodes, then confirmations and closings of 100, of ten frames each.
    let sets = 2 * selection.failed.len() as u64 + 3;
    let failed_at_once = selection.failed.iter().filter(|one| one.closing.is_none()).count() as u64;
    // The last policy is closed once, be it a candidate that came so far or not.
    let came_so_far = |one: &hasard_learn::runs::selection::Candidate| {
        one.frames == config.frames && one.closing.is_some()
    };
    let shared = u64::from(came_so_far(selected) || selection.failed.iter().any(came_so_far));
    assert_eq!(selection.selection_frames, 15 * 320 + 1000 * (sets - failed_at_once - shared));
    // What its critic of the cost expects is near what comes, in every bin.
    let calibration: Value =
        serde_json::from_slice(&fs::read(path.join("calibration.json")).unwrap()).unwrap();
    let of_cost = &calibration["constraints"][0];
    assert!(
        of_cost["steps"].as_u64().unwrap() > 0 && of_cost["bins"].as_array().unwrap().len() == 10,
        "{calibration}"
    );
    for bin in of_cost["bins"].as_array().unwrap() {
        let (predicted, observed) =
            (bin["predicted"].as_f64().unwrap(), bin["observed"].as_f64().unwrap());
        assert!((predicted - observed).abs() < 1.5, "{bin}");
    }
    let shape = ActionShape { sizes: vec![2, 3], deltas: 0 };
    let mut warn = |warning| panic!("{warning}");
    let policy =
        TrainedPolicy::load(&path, Which::Selected, [tiny::SIDE, tiny::SIDE, 1], shape, &mut warn)
            .unwrap();
    let seeds: Vec<u64> = (0..100).collect();
    let episodes = play(&policy, Choice::Sampled, &tiny::worlds, &seeds, 2).unwrap();
    let others = Evaluation::of(&episodes, &config.constraints).unwrap();
    assert!((others.cost.mean - closing.cost.mean).abs() < 0.8, "{others:?} {closing:?}");
    // The number of threads changes nothing.
    assert_eq!(
        play(&policy, Choice::Sampled, &tiny::worlds, &seeds[..7], 3).unwrap(),
        episodes[..7]
    );
    assert_eq!(episodes.iter().map(|episode| episode.seed).collect::<Vec<_>>(), seeds);
    // What it expects at the start of an episode, in the return's and the cost's own units, is near
    // what its episodes bring.
    let mut worlds =
        tiny::worlds(&config.env, VecOptions { lanes: 100, ..VecOptions::default() }).unwrap();
    let mut batch = worlds.whole_batch();
    worlds
        .restore(
            seeds.iter().map(|&seed| LaneState { seed, ..LaneState::default() }).collect(),
            &mut batch,
        )
        .unwrap();
    let mut agent = policy.agent(Choice::Sampled, 100);
    agent.act(&batch.observations);
    let expected = |critic: usize| {
        (0..100).map(|lane| f64::from(agent.thought(lane).in_own_units[critic])).sum::<f64>()
            / 100.0
    };
    // Ten equal steps, discounted; a clock that ends them cuts nothing off what a critic expects,
    // so that it may be more.
    let discounted = |mean: f64, gamma: f64| {
        [1.0 - gamma.powi(10), 1.0].map(|part| mean / 10.0 * part / (1.0 - gamma))
    };
    for (critic, mean, gamma) in [(0, others.episode_return.mean, 0.9), (1, others.cost.mean, 0.5)]
    {
        let [least, most] = discounted(mean, gamma);
        let slack = 0.3 * most;
        assert!(
            (least - slack..=most + slack).contains(&expected(critic)),
            "{} of {least} to {most}",
            expected(critic)
        );
    }
    let best: Vec<_> = checkpoints(&path)
        .into_iter()
        .filter(|one| one.to_str().unwrap().contains("best_"))
        .collect();
    assert_eq!(best.len(), 1, "{best:?}");
    // Asked again, the run is over and says the same.
    let (again, ..) = tiny::run(Start::RESUME, &path);
    assert_eq!(again.unwrap().selection, Some(selection));
    fs::remove_dir_all(path).unwrap();
}

/// The worth of a run does not hang on whether it was evaluated.
#[test]
fn evaluations_change_nothing_that_is_learned() {
    let mut config = tiny::config(AlgorithmKind::PpoSaute);
    config.frames = 6 * config.frames_per_rollout();
    let (never, often) = (tiny::directory("never-evaluated"), tiny::directory("often-evaluated"));
    tiny::run(Start::Fresh(config.clone()), &never).0.unwrap();
    config.evaluation.every = Some(1);
    tiny::run(Start::Fresh(config), &often).0.unwrap();
    assert!(
        last_files(&never).0 == last_files(&often).0
            && last_files(&never).1 == last_files(&often).1
    );
    fs::remove_dir_all(never).unwrap();
    fs::remove_dir_all(often).unwrap();
}

/// A run may go on with another seed, learning rate, length and number of samplers; what changed is
/// written down, and holds when the run is resumed once more.
#[test]
fn a_run_goes_on_with_other_settings_and_says_so() {
    let mut config = tiny::config(AlgorithmKind::PpoLag);
    config.frames = 2 * config.frames_per_rollout();
    let frames = |rollouts: u64| rollouts * config.frames_per_rollout();
    let settings = [format!("frames={}", frames(4)), "seed=7".into(), "learning.rate=1e-4".into()];
    let begun = tiny::directory("begun");
    tiny::run(Start::Fresh(config.clone()), &begun).0.unwrap();
    // Other numbers of samplers are no other run.
    let mut ends = Vec::new();
    for samplers in [1, 2, 4] {
        let path = tiny::directory(&format!("goes-on-{samplers}"));
        copy(&begun, &path);
        let settings: Vec<String> =
            settings.iter().cloned().chain([format!("sampling.samplers={samplers}")]).collect();
        let (summary, reports, _) = tiny::run(Start::Resume { settings: settings.to_vec() }, &path);
        assert_eq!(summary.unwrap().last.frames, frames(4));
        assert!(reports.iter().all(|report| {
            report.learning.iter().any(|(name, rate)| *name == "learning_rate" && *rate == 1e-4)
        }));
        let kept = read_config(&path).unwrap();
        let changed: Vec<_> =
            kept.changes.iter().map(|change| (change.setting.as_str(), change.frames)).collect();
        assert_eq!(
            changed,
            [("frames", frames(2)), ("learning.rate", frames(2)), ("seed", frames(2))]
        );
        assert_eq!((kept.frames, kept.seed, kept.learning.rate), (frames(4), 7, 1e-4));
        ends.push(last_files(&path).0);
        fs::remove_dir_all(path).unwrap();
    }
    assert!(
        ends[0] == ends[1] && ends[1] == ends[2],
        "the number of samplers changed what was learned"
    );
    // Another seed is another run, and what cannot change is refused by name.
    let same = tiny::directory("same-seed");
    copy(&begun, &same);
    tiny::run(Start::Resume { settings: vec![settings[0].clone(), settings[2].clone()] }, &same)
        .0
        .unwrap();
    assert!(last_files(&same).0 != ends[0]);
    let refused = tiny::run(Start::Resume { settings: vec!["learning.gamma=0.5".into()] }, &same)
        .0
        .unwrap_err();
    assert!(refused.contains("learning.gamma") && refused.contains("--init-from"), "{refused}");
    fs::remove_dir_all(begun).unwrap();
    fs::remove_dir_all(same).unwrap();
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let target = to.join(entry.file_name());
        if entry.file_type().unwrap().is_dir() {
            copy(&entry.path(), &target)
        } else {
            fs::copy(entry.path(), target).unwrap();
        }
    }
}

/// Two constraints with networks of their own: both terms are judged and reported, and the run that
/// stops and goes on equals the one that went straight through.
#[test]
fn two_constraints_are_kept_apart_and_resumed() {
    let mut config = tiny::config(AlgorithmKind::TrpoLag);
    let constraint = |term: &str, budget| Constraint { term: Some(term.into()), budget };
    config.constraints = vec![constraint("risk", 4.0), constraint("second", 2.0)];
    config.sampling.rollout = 13;
    config.frames = 4 * config.frames_per_rollout();
    config.evaluation.every = Some(2 * config.frames_per_rollout());
    config.evaluation.confirming_episodes = Some(32);
    let (straight, broken) = (tiny::directory("two-straight"), tiny::directory("two-broken"));
    let (summary, ..) = tiny::run(Start::Fresh(config.clone()), &straight);
    let selected = summary.unwrap().selection.unwrap().selected;
    let judged: Vec<_> = selected
        .evaluation()
        .constraints
        .iter()
        .map(|one| (one.term.as_deref(), one.budget))
        .collect();
    assert_eq!(judged, [(Some("risk"), 4.0), (Some("second"), 2.0)]);
    let last = rows(&straight).pop().unwrap();
    assert!(last["eval/cost/risk"].is_number() && last["eval/cost/second"].is_number(), "{last}");
    assert_eq!(last["constraint_costs"].as_array().unwrap().len(), 2);
    let half = config.frames / 2;
    tiny::run(Start::Fresh(TrainConfig { frames: half, ..config.clone() }), &broken).0.unwrap();
    let settings = [format!("frames={}", config.frames)];
    tiny::run(Start::Resume { settings: settings.to_vec() }, &broken).0.unwrap();
    assert!(last_files(&straight).0 == last_files(&broken).0, "weights differ");
    assert!(last_files(&straight).1 == last_files(&broken).1, "optimisers or lanes differ");
    fs::remove_dir_all(straight).unwrap();
    fs::remove_dir_all(broken).unwrap();
}
