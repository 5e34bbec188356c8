//! A run in memory: worlds, samplers, learner and algorithm put together, without its directory.

use std::ops::Range;
use std::sync::{Arc, RwLock};
use std::time::Instant;

use hasard_envs::{CostTerm, EnvError, FinalObservations, Insight, VecEnv, VecOptions};

use crate::algorithms::{self, Algorithm};
use crate::config::{EnvConfig, TrainConfig};
use crate::error::LearnError;
use crate::learning::epochs::Epochs;
use crate::learning::learner::Learner;
use crate::learning::metrics::Means;
use crate::networks::device::ComputeDevice;
use crate::networks::distribution::ActionShape;
use crate::networks::{Actor, ImageShape, ModelShape};
use crate::random::{Purpose, Stream};
use crate::runs::agent_file::AgentFile;
use crate::runs::buttons;
use crate::runs::checkpoint::{Loaded, Progress};
use crate::runs::watch::Watch;
use crate::sampling::auxiliary::Auxiliary;
use crate::sampling::gather::Gatherer;
use crate::sampling::privileged::Privileged;
use crate::sampling::rollout::Rollout;
use crate::sampling::rollout_memory;
use crate::sampling::sampler::{Sampler, SamplerState, dealt_anew};
use crate::sampling::shared_rollout::{all_states, complete};
use crate::team::Team;

/// Makes batches of the worlds of an environment: one for each sampler, continuing each other's
/// lanes.
pub type MakeWorlds<'a> = dyn Fn(&EnvConfig, VecOptions) -> Result<VecEnv, EnvError> + 'a;

/// What a run begins with.
pub enum Beginning<'a> {
    /// Fresh weights.
    Nothing,
    /// Everything of a checkpoint.
    Everything(Box<Loaded>),
    /// Weights and normalisers of a checkpoint, and the order of its buttons.
    Weights(Box<Loaded>, Option<Vec<usize>>),
    /// Weights and statistics of pixels of an agent's file, these its bytes, and the order of its
    /// buttons.
    Agent(Vec<u8>, Option<Vec<usize>>),
    /// Weights, normalisers and counters of the lesson before.
    Lesson(&'a Session),
}

impl Beginning<'_> {
    /// How far the checkpoint is that a run goes on from.
    pub fn progress(&self) -> Option<&Progress> {
        match self {
            Beginning::Everything(loaded) => Some(&loaded.progress),
            _ => None,
        }
    }
}

/// A run in memory.
pub struct Session {
    /// Settings.
    pub config: TrainConfig,
    /// Networks and statistics.
    pub learner: Learner,
    /// The algorithm.
    pub algorithm: Box<dyn Algorithm>,
    /// Samplers.
    pub gatherer: Gatherer,
    /// Latest episodes.
    pub watch: Watch,
    /// Numbers since the last report.
    pub means: Means,
    /// Frames learned from.
    pub frames: u64,
    /// Rollouts learned from.
    pub rollouts: u64,
    /// The worlds' cost terms.
    pub cost_terms: &'static [CostTerm],
    /// The map's extent, if the worlds have places: x from, y from, x to, y to in map units.
    pub extent: Option<[i32; 4]>,
    /// The workers of the run.
    pub team: Team,
    /// Which of the parts of a rollout are this worker's samplers'.
    own_parts: Range<usize>,
    /// Names of cost terms and statistics.
    names: Vec<&'static str>,
}

/// The model that an algorithm wants for some worlds.
pub fn model_shape(config: &TrainConfig, worlds: &VecEnv) -> Result<ModelShape, LearnError> {
    let [height, width, channels] = worlds.observation_shape();
    let action = ActionShape::from(worlds.action_space());
    let cost_critics =
        if config.algorithm.has_cost_critics() { config.constraints.len() } else { 0 };
    let extra = algorithms::shaping(config).extra_inputs();
    let shape = ModelShape::new(
        ImageShape { height, width, channels },
        action,
        cost_critics,
        extra,
        &config.network,
    )?;
    shape
        .with_critic_inputs(Privileged::new(config).count())?
        .with_auxiliary(Auxiliary::new(config).outputs())?
        .with_mirror(config.network.mirror, config.env.action_space()?.as_ref())
}

impl Session {
    /// Makes everything, and lets the samplers begin.
    pub fn new(
        config: TrainConfig,
        beginning: &Beginning<'_>,
        make_worlds: &MakeWorlds<'_>,
    ) -> Result<Session, LearnError> {
        Session::of(Team::default(), config, beginning, make_worlds)
    }

    /// As [`Session::new`], one worker's share of the run of a team.
    pub fn of(
        team: Team,
        config: TrainConfig,
        beginning: &Beginning<'_>,
        make_worlds: &MakeWorlds<'_>,
    ) -> Result<Session, LearnError> {
        let device = ComputeDevice::of(&config)?;
        Session::made(team, &device, config, beginning, make_worlds)
    }

    /// As [`Session::new`], on a device that the settings do not name.
    pub fn on(
        device: &ComputeDevice,
        config: TrainConfig,
        beginning: &Beginning<'_>,
        make_worlds: &MakeWorlds<'_>,
    ) -> Result<Session, LearnError> {
        Session::made(Team::default(), device, config, beginning, make_worlds)
    }

    fn made(
        team: Team,
        device: &ComputeDevice,
        config: TrainConfig,
        beginning: &Beginning<'_>,
        make_worlds: &MakeWorlds<'_>,
    ) -> Result<Session, LearnError> {
        let sampling = &config.sampling;
        if team.ranks() > sampling.lanes {
            let (ranks, lanes) = (team.ranks(), sampling.lanes);
            return Err(LearnError::Config(format!(
                "{ranks} workers cannot share {lanes} worlds; start fewer, or give more worlds"
            )));
        }
        let (shares, own_parts) = team.shares(sampling.lanes, sampling.samplers);
        let own_lanes = shares[own_parts.clone()].iter().map(ExactSizeIterator::len).sum();
        rollout_memory::check(&config, own_lanes)?;
        let privileged = Privileged::new(&config);
        let auxiliary = Auxiliary::new(&config);
        let predicted = auxiliary.insight();
        let insight =
            Insight { depth: predicted.depth, labels: predicted.labels, ..privileged.insight() };
        let mut worlds = Vec::new();
        for share in &shares[own_parts.clone()] {
            let options = VecOptions {
                lanes: share.len(),
                threads: sampling.world_threads,
                groups: sampling.groups,
                seed: Stream::new(config.seed, Purpose::Worlds, 0, 0).bits(),
                first_lane: share.start as u64,
                final_observations: FinalObservations::Truncated,
                insight,
                ..VecOptions::default()
            };
            worlds.push(
                make_worlds(&config.env, options)
                    .map_err(|error| LearnError::Worlds(error.to_string()))?,
            );
        }
        let (extent, cost_terms) = (worlds[0].extent(), worlds[0].cost_terms());
        let names = cost_terms
            .iter()
            .map(|term| term.name)
            .chain(worlds[0].statistics().iter().copied())
            .collect();
        let shape = model_shape(&config, &worlds[0])?;
        let mut learner = Learner::new(&config, &shape, device);
        learner.join(&team);
        let mut algorithm = algorithms::make(&config);
        let mut watch = Watch::new(&config);
        let (mut frames, mut rollouts) = (0, 0);
        let mut states: Vec<Option<SamplerState>> = vec![None; shares.len()];
        let has_learned = matches!(
            beginning,
            Beginning::Weights(..) | Beginning::Agent(..) | Beginning::Lesson(_)
        );
        match beginning {
            Beginning::Nothing => {}
            Beginning::Weights(loaded, order) => {
                loaded.begin(&mut learner)?;
                order.iter().for_each(|order| buttons::reorder(&mut learner, order));
            }
            Beginning::Agent(bytes, order) => {
                let file = AgentFile::parse(bytes).map_err(LearnError::Config)?;
                file.begin(&mut learner)?;
                order.iter().for_each(|order| buttons::reorder(&mut learner, order));
            }
            Beginning::Lesson(before) => {
                learner.inherit(&before.learner)?;
                (frames, rollouts) = (before.frames, before.rollouts);
                watch.episodes = before.watch.episodes;
                watch.totals.clone_from(&before.watch.totals);
                watch.first.clone_from(&before.watch.first);
            }
            Beginning::Everything(loaded) => {
                let saved =
                    dealt_anew(loaded.restore(&mut learner)?, &shares).ok_or_else(|| {
                        LearnError::Config(
                            "the checkpoint has another number of worlds than the run".into(),
                        )
                    })?;
                states = saved.into_iter().map(Some).collect();
                let progress: &Progress = &loaded.progress;
                let misfit = |error| {
                    LearnError::Config(format!("the checkpoint's multipliers do not fit: {error}"))
                };
                algorithm.load(&progress.algorithm).map_err(misfit)?;
                watch = progress.watch.resumed(&config)?;
                (frames, rollouts) = (progress.frames, progress.rollouts);
            }
        }
        let mut samplers = Vec::new();
        for ((worlds, state), share) in
            worlds.into_iter().zip(states.drain(own_parts.clone())).zip(&shares[own_parts.clone()])
        {
            let actor = Actor::new(&shape, device);
            let shaping = algorithms::shaping(&config);
            let mut sampler = Sampler::new(
                &shape,
                worlds,
                actor,
                shaping,
                &config.constraints,
                share.start,
                config.seed,
            )?;
            sampler.cut(config.trajectory_steps());
            sampler.show_critics(privileged.clone(), insight);
            sampler.predict(auxiliary);
            // Of rollouts that are cut, what the networks computed would fill the memory.
            let whole = config.trajectory_steps() == sampling.rollout;
            if sampling.synchronous && config.learning.reuse_forward && whole {
                sampler.record();
            }
            match state {
                Some(state) => {
                    sampler.restore(state)?;
                    if config.reseeded_at(frames) {
                        sampler.reseed(Stream::new(config.seed, Purpose::Worlds, 0, 0).bits())?;
                    }
                }
                None if sampling.spread_out && has_learned => {
                    let newest = RwLock::new(Arc::new(learner.publish()));
                    sampler.play_apart(sampling.lanes, config.episode_steps, &newest)?
                }
                None if sampling.spread_out => {
                    sampler.spread_out(sampling.lanes, config.episode_steps)?
                }
                None => {}
            }
            samplers.push(sampler);
        }
        let gatherer = if sampling.synchronous {
            Gatherer::in_turn(samplers, sampling.rollout, learner.publish())
        } else {
            Gatherer::ahead(
                samplers,
                sampling.rollout,
                sampling.accumulated + 1,
                learner.publish(),
            )?
        };
        let means = Means::default();
        Ok(Session {
            learner,
            algorithm,
            gatherer,
            watch,
            means,
            frames,
            rollouts,
            cost_terms,
            extent,
            team,
            own_parts,
            names,
            config,
        })
    }

    /// Waits for the next rollout and learns from it.
    pub fn turn(&mut self, warn: &mut dyn FnMut(String)) -> Result<Rollout, LearnError> {
        let waiting = Instant::now();
        let own = self.gatherer.next_rollout()?;
        let rollout = complete(&self.team, self.learner.shape(), &self.names, own)?;
        self.means.add("seconds_waiting", waiting.elapsed().as_secs_f64());
        let learning = Instant::now();
        let learned = self.learn(&rollout, warn);
        // What was computed without the others' part is no outcome.
        self.team.check()?;
        learned?;
        self.means.add("seconds_learning", learning.elapsed().as_secs_f64());
        self.frames += rollout.rows() as u64 * u64::from(self.config.env.frame_skip);
        self.rollouts += 1;
        Ok(rollout)
    }

    /// Gives the samplers the present weights and lets them gather another rollout in the memory of
    /// one that is done with.
    pub fn go_on(&mut self, mut rollout: Rollout) {
        let published = self.learner.publish();
        let parts = rollout.parts.drain(self.own_parts.clone()).collect();
        self.gatherer.go_on(Rollout { parts }, published);
    }

    /// Where the samplers of all workers are.
    pub fn save_samplers(&mut self) -> Result<Vec<SamplerState>, LearnError> {
        all_states(&self.team, self.gatherer.save()?)
    }

    /// Everything that is learned from a rollout.
    fn learn(&mut self, rollout: &Rollout, warn: &mut dyn FnMut(String)) -> Result<(), LearnError> {
        for episode in rollout.episodes() {
            self.watch.add(episode, &self.config.constraints)?;
        }
        let lag = self.learner.version.saturating_sub(rollout.oldest_version());
        self.means.add("policy_lag", lag as f64);
        if lag > self.config.sampling.max_policy_lag {
            self.watch.thrown_away();
            warn(format!(
                "a rollout was {lag} updates old and was thrown away; raise the policy lag allowed, or use --sync"
            ));
            return Ok(());
        }
        let learning = self.config.learning.clone();
        let done = self.config.progress(self.frames);
        self.learner.rate = learning.rate_after(done);
        self.means.add("learning_rate", self.learner.rate);
        self.learner.exploration_coefficient = learning.exploration_after(done);
        (self.learner.config.learning.gamma, self.learner.config.learning.gae_lambda) =
            learning.horizon_after(done);
        if learning.budget_annealing.is_some() || self.config.keeps_a_margin() {
            for (constraint, one) in self.config.constraints.iter().enumerate() {
                let name = match &one.term {
                    None => "aimed_budget".into(),
                    Some(term) => format!("aimed_budget/{term}"),
                };
                self.means.add(name, self.watch.aim(&self.config, constraint, done));
            }
        }
        if !learning.reuse_forward {
            self.learner.absorb(rollout)?;
        }
        let prepared = self.learner.prepare(rollout);
        for (name, share) in prepared.explained_variances(&self.config) {
            self.means.add(name, share);
        }
        let epochs = Epochs::new(&self.config, self.rollouts, rollout.trajectories());
        let signals = |costs: &[f64]| self.watch.signals(&self.config, done, costs);
        self.algorithm.learn(&mut self.learner, &prepared, &epochs, &signals, &mut self.means)?;
        algorithms::value_phase(
            &self.config,
            &mut self.learner,
            &prepared,
            self.rollouts,
            &mut self.means,
        )?;
        self.watch.learned();
        if learning.reuse_forward {
            self.learner.absorb(rollout)?;
        }
        Ok(())
    }
}
