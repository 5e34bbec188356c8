//! The trainer: worlds, samplers, learner, algorithm and the run's directory put together.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use hasard_envs::{EnvError, FinalObservations, VecEnv, VecOptions};

use crate::algorithms::{self, Algorithm};
use crate::checkpoint::{Checkpoint, Loaded, Progress, Store};
use crate::config::TrainConfig;
use crate::device::ComputeDevice;
use crate::distribution::ActionShape;
use crate::error::LearnError;
use crate::gather::{Gatherer, panic_text};
use crate::heatmap::Heatmap;
use crate::learner::Learner;
use crate::metrics::Means;
use crate::model::{Actor, ImageShape, ModelShape};
use crate::random::{Purpose, Stream};
use crate::report::Report;
use crate::rollout::Rollout;
use crate::run_directory::RunDirectory;
use crate::sampler::{Sampler, SamplerState};
use crate::shaping::Shaping;
use crate::watch::Watch;
use crate::writer::Writer;

/// Makes batches of the run's worlds: one for each sampler, continuing each other's lanes.
pub type MakeWorlds<'a> = dyn Fn(VecOptions) -> Result<VecEnv, EnvError> + 'a;

/// What the caller of a run hears of it, and how it ends it.
pub struct Hooks<'a> {
    /// Raised by the caller to end the run cleanly, with a checkpoint.
    pub stop: &'a AtomicBool,
    /// Told every report.
    pub report: &'a mut dyn FnMut(&Report),
    /// Told what went wrong without ending the run.
    pub warn: &'a mut dyn FnMut(String),
}

/// How a run begins.
pub enum Start<'a> {
    /// In a new directory.
    Fresh(TrainConfig),
    /// From the last checkpoint in the directory; a number of frames given here replaces the run's.
    Resume {
        /// Length of the run, if it is to be another than before.
        frames: Option<u64>,
    },
    /// In a new directory, with the weights and pixel statistics of another run: the step of a curriculum.
    From(TrainConfig, &'a Path),
}

/// How a run ended.
#[derive(Clone, Debug)]
pub struct Summary {
    /// The last report.
    pub last: Report,
    /// The caller ended it.
    pub stopped: bool,
}

/// Trains in `directory` until the run's frames are used up or the caller ends it.
///
/// In synchronous mode everything that is learned follows from the settings alone; a run that was stopped, or killed, and
/// resumed equals one that never stopped, bit by bit.
pub fn train(
    start: Start<'_>,
    directory: &Path,
    make_worlds: &MakeWorlds<'_>,
    hooks: &mut Hooks<'_>,
) -> Result<Summary, LearnError> {
    let (run, config, loaded) = begin(start, directory, hooks)?;
    // A panic of the learner's own thread ends as an error too; checkpoints already written stay.
    catch_unwind(AssertUnwindSafe(|| Trainer::new(run, config, loaded, make_worlds)?.run(hooks)))
        .unwrap_or_else(|panic| Err(LearnError::Panic(panic_text("the learner", &*panic))))
}

enum From {
    Nothing,
    Everything(Box<Loaded>),
    Weights(Box<Loaded>),
}

fn begin(start: Start<'_>, directory: &Path, hooks: &mut Hooks<'_>) -> Result<(RunDirectory, TrainConfig, From), LearnError> {
    match start {
        Start::Fresh(config) => {
            config.check()?;
            Ok((RunDirectory::create(directory, &config)?, config, From::Nothing))
        }
        Start::From(config, other) => {
            config.check()?;
            let loaded = Store::new(other, 1).newest(hooks.warn)?;
            let loaded = loaded.ok_or_else(|| LearnError::content(other, "no checkpoint to take weights from is here"))?;
            Ok((RunDirectory::create(directory, &config)?, config, From::Weights(Box::new(loaded))))
        }
        Start::Resume { frames } => {
            let (run, mut config) = RunDirectory::open(directory)?;
            config.frames = frames.unwrap_or(config.frames);
            config.check()?;
            let loaded = Store::new(directory, config.reporting.keep).newest(hooks.warn)?;
            let at = loaded.as_ref().map_or(0, |loaded| loaded.progress.frames);
            if loaded.is_none() {
                (hooks.warn)(format!("{}: no checkpoint was written yet; the run starts again", directory.display()));
            }
            run.rewind_metrics(at, hooks.warn)?;
            Ok((run, config, loaded.map_or(From::Nothing, |loaded| From::Everything(Box::new(loaded)))))
        }
    }
}

struct Trainer {
    run: RunDirectory,
    config: TrainConfig,
    learner: Learner,
    algorithm: Box<dyn Algorithm>,
    gatherer: Gatherer,
    watch: Watch,
    /// Where the agents have been, if the worlds have places.
    heatmap: Option<Heatmap>,
    means: Means,
    frames: u64,
    rollouts: u64,
    seconds_before: f64,
    started: Instant,
    best_feasible: Option<f64>,
}

/// The model that an algorithm wants for some worlds.
pub fn model_shape(config: &TrainConfig, worlds: &VecEnv) -> Result<ModelShape, LearnError> {
    let [height, width, channels] = worlds.observation_shape();
    let space = worlds.action_space();
    let action = ActionShape { sizes: space.sizes(), deltas: space.deltas.len() };
    let cost_critics = if config.algorithm.has_cost_critics() { config.constraints.len() } else { 0 };
    let extra = Shaping::new(config).extra_inputs();
    ModelShape::new(ImageShape { height, width, channels }, action, cost_critics, extra, &config.network)
}

impl Trainer {
    fn new(run: RunDirectory, config: TrainConfig, from: From, make_worlds: &MakeWorlds<'_>) -> Result<Trainer, LearnError> {
        let device = ComputeDevice::named(&config.device)?;
        let sampling = &config.sampling;
        let lanes = sampling.lanes / sampling.samplers;
        let mut worlds = Vec::new();
        for index in 0..sampling.samplers {
            let options = VecOptions {
                lanes,
                threads: sampling.world_threads,
                groups: sampling.groups,
                seed: Stream::new(config.seed, Purpose::Worlds, 0, 0).bits(),
                first_lane: (index * lanes) as u64,
                final_observations: FinalObservations::Truncated,
                ..VecOptions::default()
            };
            worlds.push(make_worlds(options).map_err(|error| LearnError::Worlds(error.to_string()))?);
        }
        let shape = model_shape(&config, &worlds[0])?;
        let mut learner = Learner::new(&config, &shape, &device);
        let mut algorithm = algorithms::make(&config)?;
        let mut watch = Watch::new(&config);
        let (mut frames, mut rollouts, mut seconds_before, mut best_feasible) = (0, 0, 0.0, None);
        let mut states: Vec<Option<SamplerState>> = vec![None; sampling.samplers];
        match from {
            From::Nothing => {}
            From::Weights(loaded) => loaded.restore_weights(&mut learner)?,
            From::Everything(loaded) => {
                let saved = loaded.restore(&mut learner)?;
                if saved.len() != sampling.samplers {
                    return Err(LearnError::Config("the checkpoint has another number of samplers".into()));
                }
                states = saved.into_iter().map(Some).collect();
                let progress = loaded.progress;
                let misfit = |error| LearnError::Config(format!("the checkpoint's multipliers do not fit: {error}"));
                algorithm.load(&progress.algorithm).map_err(misfit)?;
                watch = progress.watch;
                (frames, rollouts) = (progress.frames, progress.rollouts);
                (seconds_before, best_feasible) = (progress.wall_seconds, progress.best_feasible);
            }
        }
        let heatmap = worlds[0].extent().map(|extent| Heatmap::new(extent, sampling.lanes, config.frames, frames));
        let mut samplers = Vec::new();
        for (index, (worlds, state)) in worlds.into_iter().zip(states).enumerate() {
            let actor = Actor::new(&shape, &device);
            let shaping = Shaping::new(&config);
            let mut sampler = Sampler::new(&shape, worlds, actor, shaping, &config.constraints, index * lanes, config.seed)?;
            if let Some(state) = state {
                sampler.restore(state)?;
            }
            samplers.push(sampler);
        }
        let ahead = if sampling.synchronous { 1 } else { sampling.accumulated + 1 };
        let gatherer = Gatherer::new(samplers, sampling.rollout, ahead, learner.publish());
        Ok(Trainer {
            run,
            learner,
            algorithm,
            gatherer,
            watch,
            heatmap,
            means: Means::default(),
            frames,
            rollouts,
            seconds_before,
            started: Instant::now(),
            best_feasible,
            config,
        })
    }

    fn wall_seconds(&self) -> f64 {
        self.seconds_before + self.started.elapsed().as_secs_f64()
    }

    fn run(mut self, hooks: &mut Hooks<'_>) -> Result<Summary, LearnError> {
        let store = Store::new(self.run.path(), self.config.reporting.keep);
        let writer = Writer::new(self.run.path(), store)?;
        let (mut last_report, mut last_checkpoint) = (Instant::now(), Instant::now());
        let mut reported_frames = self.frames;
        let mut last = None;
        let mut over = self.frames >= self.config.frames;
        while !over {
            let waiting = Instant::now();
            let rollout = self.gatherer.next_rollout()?;
            self.means.add("seconds_waiting", waiting.elapsed().as_secs_f64());
            let learning = Instant::now();
            self.learn(&rollout, hooks)?;
            self.means.add("seconds_learning", learning.elapsed().as_secs_f64());
            self.frames += rollout.rows() as u64 * u64::from(self.config.env.frame_skip);
            self.rollouts += 1;
            // Asked once a rollout: from here on it is decided whether samplers are told to go on.
            over = self.frames >= self.config.frames || hooks.stop.load(Ordering::Relaxed);
            if over || last_report.elapsed().as_secs_f64() >= self.config.reporting.report_seconds {
                let seconds = last_report.elapsed().as_secs_f64().max(1e-9);
                let report = self.report((self.frames - reported_frames) as f64 / seconds);
                (last_report, reported_frames) = (Instant::now(), self.frames);
                writer.row(self.frames, report.row());
                (hooks.report)(&report);
                last = Some(report);
                over = over || hooks.stop.load(Ordering::Relaxed);
            }
            if let Some(heatmap) = &mut self.heatmap {
                heatmap.add(&rollout);
                heatmap.line(self.frames, over).into_iter().for_each(|line| writer.heatmap(line));
            }
            writer.check()?;
            if over || last_checkpoint.elapsed().as_secs_f64() >= self.config.reporting.checkpoint_seconds {
                let (checkpoint, best) = self.checkpoint()?;
                // The last checkpoint waits for the disk; one on the way is left out if the disk is far behind.
                let _ = writer.checkpoint(checkpoint, best, over);
                last_checkpoint = Instant::now();
            }
            if !over {
                self.gatherer.go_on(rollout, self.learner.publish());
            }
        }
        writer.finish()?;
        let last = match last {
            Some(report) => report,
            None => self.report(0.0),
        };
        Ok(Summary { last, stopped: self.frames < self.config.frames })
    }

    /// Everything that is learned from a rollout.
    fn learn(&mut self, rollout: &Rollout, hooks: &mut Hooks<'_>) -> Result<(), LearnError> {
        for episode in rollout.parts.iter().flat_map(|part| &part.episodes) {
            self.watch.add(episode, &self.config.constraints);
        }
        let lag = self.learner.version.saturating_sub(rollout.oldest_version());
        self.means.add("policy_lag", lag as f64);
        if lag > self.config.sampling.max_policy_lag {
            (hooks.warn)(format!(
                "a rollout was {lag} updates old and was thrown away; raise the policy lag allowed, or use --sync"
            ));
            return Ok(());
        }
        let learning = self.config.learning.clone();
        let done = (self.frames as f64 / self.config.frames as f64).min(1.0);
        self.learner.rate = learning.rate + (learning.final_rate - learning.rate) * done;
        self.means.add("learning_rate", self.learner.rate);
        let prepared = self.learner.prepare(rollout);
        let mut lanes: Vec<usize> = (0..rollout.lanes()).collect();
        let size = lanes.len().div_ceil(learning.minibatches);
        for epoch in 0..learning.epochs {
            if learning.minibatches > 1 {
                Stream::new(self.config.seed, Purpose::Shuffle, self.rollouts, epoch as u64).shuffle(&mut lanes);
            }
            for some in lanes.chunks(size) {
                let mut minibatch = self.learner.minibatch(&prepared, some);
                let signals = self.watch.signals(&self.config, &minibatch.mean_costs);
                self.algorithm.constrain(&signals);
                self.algorithm.update(&mut self.learner, &mut minibatch, &signals, &mut self.means)?;
            }
        }
        Ok(())
    }

    fn report(&mut self, frames_per_second: f64) -> Report {
        let mut report = Report::take(&self.config, &self.watch, &mut self.means, self.algorithm.multipliers());
        report.frames = self.frames;
        report.updates = self.learner.version;
        report.wall_seconds = self.wall_seconds();
        report.frames_per_second = frames_per_second;
        report
    }

    /// Takes a checkpoint, and says whether the run has never been as good within its budgets.
    fn checkpoint(&mut self) -> Result<(Checkpoint, bool), LearnError> {
        let report = Report::take(&self.config, &self.watch, &mut Means::default(), Vec::new());
        let best = match report.means {
            // A few episodes say little; and the window must be full of them before it may set a record.
            Some((mean, ..)) if report.feasible() && self.watch.recent.len() >= self.config.reporting.window.min(30) => {
                self.best_feasible.is_none_or(|best| mean > best).then_some(mean)
            }
            _ => None,
        };
        self.best_feasible = best.or(self.best_feasible);
        let samplers = self.gatherer.save()?;
        let progress = Progress {
            frames: self.frames,
            rollouts: self.rollouts,
            updates: self.learner.version,
            wall_seconds: self.wall_seconds(),
            best_feasible: self.best_feasible,
            returns: self.learner.returns.clone(),
            optimiser_steps: self.learner.optimisers.iter().map(|adam| adam.steps).collect(),
            algorithm: self.algorithm.save(),
            watch: self.watch.clone(),
            samplers: samplers.iter().map(|sampler| (sampler.steps, sampler.safety.clone())).collect(),
            pixel_count: self.learner.pixels.count,
        };
        Ok((Checkpoint::take(&self.learner, &samplers, progress)?, best.is_some()))
    }
}
