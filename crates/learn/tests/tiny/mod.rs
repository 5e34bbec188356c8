//! A tiny task of pixels with a known optimum, in place of the benchmark's worlds.

#![allow(dead_code)] // Each test file uses its own part of this.

use hasard_engine::math::Rng;
use hasard_envs::{
    ActionGroup, ActionSpace, BUTTONS, CostTerm, Environment, Episode, Step, VecEnv, VecOptions,
    episode_costs,
};
use hasard_learn::config::Convolution;
use hasard_learn::config::{AlgorithmKind, Constraint, EnvConfig, Preset, TrainConfig};
use hasard_learn::runs::report::Report;
use hasard_learn::runs::session::MakeWorlds;
use hasard_learn::runs::trainer::{Hooks, Start, Summary, train};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// Steps of an episode.
pub const STEPS: u32 = 10;
/// Side of the picture.
pub const SIDE: usize = 6;

/// Every step shows a rich or a poor picture, either half of the time. Taking a risk brings 1 when
/// rich and 0.4 when poor, and costs 1 either way; anything else brings and costs nothing.
///
/// Without a budget it is best always to take the risk: return 7, cost 10. Under a budget of 4 it
/// is best to take it in four fifths of the rich steps alone: return 4, cost 4. As a trap the risk
/// loses 0.4 when poor: without a budget it is best to take it when rich alone, return 5, where a
/// policy that is blind to the picture gets 3 at most.
///
/// The second cost is 1 for another sub-action that does nothing else.
pub struct Risk {
    space: ActionSpace,
    /// Reward of a risk when poor.
    poor: f64,
    rng: Rng,
    seed: u64,
    rich: bool,
    steps: u32,
    sums: (f64, [f64; 2]),
    last: [f64; 2],
    times_out: bool,
}

impl Risk {
    pub fn new(times_out: bool) -> Risk {
        Risk::with_poor(times_out, 0.4)
    }

    pub fn with_poor(times_out: bool, poor: f64) -> Risk {
        let button = |index: usize| (BUTTONS[index].0, BUTTONS[index].1);
        let group = |count: usize| ActionGroup { buttons: (0..count).map(button).collect() };
        Risk {
            space: ActionSpace { groups: vec![group(1), group(2)], deltas: vec![] },
            poor,
            rng: Rng::new(0),
            seed: 0,
            rich: false,
            steps: 0,
            sums: (0.0, [0.0; 2]),
            last: [0.0; 2],
            times_out,
        }
    }

    fn ended(&self) -> bool {
        self.steps >= STEPS
    }
}

impl Environment for Risk {
    fn action_space(&self) -> &ActionSpace {
        &self.space
    }

    fn observation_shape(&self) -> [usize; 3] {
        [SIDE, SIDE, 1]
    }

    fn cost_terms(&self) -> &'static [CostTerm] {
        &[CostTerm { name: "risk", counted: true }, CostTerm { name: "second", counted: false }]
    }

    fn reset(&mut self, seed: u64) {
        self.rng = Rng::new(seed);
        self.seed = seed;
        self.rich = self.rng.below(2) == 1;
        self.steps = 0;
        self.sums = (0.0, [0.0; 2]);
        self.last = [0.0; 2];
    }

    fn step(&mut self, actions: &[u8], _deltas: &[f32]) -> Step {
        if self.ended() {
            return Step {
                terminated: !self.times_out,
                truncated: self.times_out,
                ..Step::default()
            };
        }
        let risk = actions[0] == 1;
        let reward = if risk { if self.rich { 1.0 } else { self.poor } } else { 0.0 };
        let cost = if risk { 1.0 } else { 0.0 };
        self.last = [cost, if actions[1] == 2 { 1.0 } else { 0.0 }];
        self.sums.0 += reward;
        self.sums.1[0] += self.last[0];
        self.sums.1[1] += self.last[1];
        self.steps += 1;
        self.rich = self.rng.below(2) == 1;
        Step {
            reward,
            cost,
            terminated: self.ended() && !self.times_out,
            truncated: self.ended() && self.times_out,
        }
    }

    fn step_costs(&self) -> &[f64] {
        &self.last
    }

    fn observe(&mut self, out: &mut [u8]) {
        for (index, pixel) in out.iter_mut().enumerate() {
            let noise = (self.seed as usize).wrapping_mul(index + 1) % 40;
            *pixel =
                if self.rich == (index % 2 == 0) { 200 - noise as u8 } else { 20 + noise as u8 };
        }
    }

    fn episode(&self) -> Episode {
        Episode {
            task: None,
            lane: 0,
            seed: self.seed,
            episode_return: self.sums.0,
            cost: self.sums.1[0],
            costs: episode_costs(self.cost_terms(), &self.sums.1),
            length: self.steps,
            terminated: self.ended() && !self.times_out,
            truncated: self.ended() && self.times_out,
            stats: vec![],
        }
    }
}

/// The task until a number of steps, then a panic.
pub struct Broken {
    task: Risk,
    left: u32,
}

impl Broken {
    pub fn after(steps: u32) -> Broken {
        Broken { task: Risk::new(true), left: steps }
    }
}

impl Environment for Broken {
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
        self.left = self.left.checked_sub(1).expect("the floor gave way");
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

/// A batch of the task.
pub fn worlds(env: &EnvConfig, options: VecOptions) -> Result<VecEnv, hasard_envs::EnvError> {
    let poor = if env.id == "Trap" { -0.4 } else { 0.4 };
    VecEnv::from_fn(options, |_| Ok(Box::new(Risk::with_poor(true, poor))))
}

/// Settings that solve the task in seconds.
pub fn config(algorithm: AlgorithmKind) -> TrainConfig {
    let mut config = TrainConfig::plain(
        algorithm,
        Preset::Paper,
        EnvConfig { frame_skip: 1, ..EnvConfig::new("Risk") },
    );
    config.episode_steps = STEPS;
    config.constraints = vec![Constraint { term: None, budget: 4.0 }];
    config.network.convolutions = vec![Convolution { channels: 32, kernel: 4, stride: 2 }];
    config.network.dense = vec![32];
    config.network.recurrent = Some(32);
    config.sampling.lanes = 32;
    config.sampling.rollout = 16;
    config.sampling.samplers = 2;
    config.sampling.synchronous = true;
    config.learning.threads = 1;
    config.learning.rate = 3e-3;
    // Tests that want evaluations ask for them.
    config.evaluation.every = Some(0);
    config.learning.epochs = 2;
    config.learning.minibatches = 2;
    // Rollouts are short here: as many steps as the preset's would be eighty passes.
    (config.algorithm_settings.critic_steps, config.algorithm_settings.critic_batch) = (2, None);
    config.learning.gamma = 0.9;
    config.reporting.report_seconds = 0.0;
    config.reporting.checkpoint_seconds = 1e9;
    config.frames = 512 * 40;
    config
}

/// A directory of its own for a test, empty.
pub fn directory(name: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("hasard-learn-{}-{name}", std::process::id()));
    let _ = std::fs::remove_dir_all(&path);
    path
}

/// Trains to the end, collecting reports and warnings.
pub fn run(start: Start, directory: &Path) -> (Result<Summary, String>, Vec<Report>, Vec<String>) {
    let (mut reports, mut warnings) = (Vec::new(), Vec::new());
    let stop = AtomicBool::new(false);
    let result = train(
        start,
        directory,
        &worlds,
        &mut Hooks {
            stop: &stop,
            report: &mut |report| reports.push(report.clone()),
            warn: &mut |warning| warnings.push(warning),
        },
    );
    (result.map_err(|error| error.to_string()), reports, warnings)
}

/// The weights of the last checkpoint of a run.
pub fn weights(run: &std::path::Path) -> Vec<u8> {
    let all =
        std::fs::read_dir(run.join("checkpoints")).unwrap().map(|entry| entry.unwrap().path());
    let last = all
        .filter(|path| path.file_name().unwrap().to_str().unwrap().starts_with("frames_"))
        .max()
        .unwrap();
    std::fs::read(last.join("weights.safetensors")).unwrap()
}

/// Settings of a few short rollouts of Remedy Rush, in episodes of eleven steps.
pub fn remedy_rush(algorithm: AlgorithmKind) -> TrainConfig {
    let mut config = config(algorithm);
    config.env.id = "RemedyRushLevel1-v0".into();
    (config.env.frame_skip, config.episode_steps) = (4, 11);
    (config.sampling.lanes, config.sampling.rollout) = (6, 7);
    config
}

/// Trains in other worlds than the task's, without a warning, and gives the last weights.
pub fn trained_in(make_worlds: &MakeWorlds<'_>, start: Start, path: &Path) -> Vec<u8> {
    let stop = AtomicBool::new(false);
    let mut warn = |warning: String| panic!("{warning}");
    let mut hooks = Hooks { stop: &stop, report: &mut |_| {}, warn: &mut warn };
    train(start, path, make_worlds, &mut hooks).unwrap();
    weights(path)
}

/// The weights of a run, which neither a stop in the midst of episodes nor samplers, groups and
/// threads change by a bit.
pub fn however_trained(make_worlds: &MakeWorlds<'_>, config: &TrainConfig, name: &str) -> Vec<u8> {
    let go = |start: Start, path: &Path| trained_in(make_worlds, start, path);
    let path = |part: &str| directory(&format!("{name}-{part}"));
    let (straight, broken, dealt) = (path("straight"), path("broken"), path("dealt"));
    let all = go(Start::Fresh(config.clone()), &straight);
    go(Start::Fresh(TrainConfig { frames: config.frames / 2, ..config.clone() }), &broken);
    let settings = vec![format!("frames={}", config.frames), "sampling.samplers=3".into()];
    assert!(go(Start::Resume { settings }, &broken) == all, "{name}: the resumed run differs");
    let mut other = config.clone();
    (other.sampling.samplers, other.sampling.groups, other.sampling.world_threads) = (1, 2, 2);
    other.learning.threads = 3;
    assert!(go(Start::Fresh(other), &dealt) == all, "{name}: threads change a bit");
    for path in [straight, broken, dealt] {
        std::fs::remove_dir_all(path).unwrap();
    }
    all
}
