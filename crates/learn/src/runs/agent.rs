//! A trained agent, acting.
//!
//! Long because an agent and its memory change together.

use std::path::Path;
use std::sync::Arc;

use hasard_envs::CostTerm;
use serde::{Deserialize, Serialize};

use crate::algorithms::shaping;
use crate::config::constraint::find_terms;
use crate::config::{Products, ReturnNormaliser, TrainConfig};
use crate::error::LearnError;
use crate::learning::learner::Learner;
use crate::learning::normaliser::Moments;
use crate::networks::device::ComputeDevice;
use crate::networks::distribution::ActionShape;
use crate::networks::{Actor, ImageShape, ModelShape, Published};
use crate::random::{Purpose, Stream};
use crate::runs::agent_file::AgentFile;
use crate::runs::checkpoint::Store;
use crate::runs::run_directory::{GONE, damaged_selection, go_on, read_config, spoiled_selection};
use crate::sampling::privileged::Privileged;
use crate::sampling::shaping::{Shaping, seen};

/// Which checkpoint of a run acts.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Which {
    /// The one that the run selects: of those within all budgets, the one that returns most. The
    /// newest of a run without any.
    #[default]
    Selected,
    /// The newest whole one.
    Latest,
}

/// How actions are chosen.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Choice {
    /// Drawn from the policy, as while training.
    #[default]
    Sampled,
    /// The most probable one.
    Greedy,
}

/// All that acting needs of what was trained; any number of agents act by it.
pub struct TrainedPolicy {
    config: TrainConfig,
    shape: ModelShape,
    published: Published,
    device: ComputeDevice,
    /// Where the cost that shapes the agent's input is among the cost terms; `None` for the scalar
    /// cost.
    watched: Option<usize>,
    /// The units of the critics' values; none where they are not known.
    returns: Vec<Moments>,
    /// Discount of the costs that its critics predict.
    cost_gamma: f64,
    /// Frames that its run had made when it was loaded; `None` where it comes from no run.
    run_frames: Option<u64>,
}

/// A trained agent for some worlds side by side, each with an episode of its own.
pub struct Agent {
    shape: ModelShape,
    actor: Actor,
    shaping: Arc<dyn Shaping>,
    watched: Option<usize>,
    choice: Choice,
    state: Vec<Vec<f32>>,
    safety: Vec<f64>,
    /// Seed of each lane's episode, and its steps so far: what its draws come from.
    episodes: Vec<(u64, u64)>,
    /// What the network put out last, a row a lane.
    rows: Vec<f32>,
    /// The units of the critics' values; none where they are not known.
    units: Vec<Moments>,
    normaliser: ReturnNormaliser,
}

/// What an agent does in one world.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Action {
    /// Categorical sub-actions.
    pub actions: Vec<u8>,
    /// Continuous sub-actions.
    pub deltas: Vec<f32>,
}

/// What an agent carries from step to step, lane by lane.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct Memory {
    /// State of each network, `[lanes, units]`.
    pub state: Vec<Vec<f32>>,
    /// What is left of each lane's budget, for agents that watch it.
    pub safety: Vec<f64>,
    /// Seed of each lane's episode, and its steps so far: what its draws come from.
    pub episodes: Vec<(u64, u64)>,
}

impl Memory {
    /// All of it as bytes, for another process.
    #[must_use]
    pub fn bytes(&self) -> Vec<u8> {
        postcard::to_allocvec(self).expect("numbers are written into memory")
    }

    /// What [`Memory::bytes`] wrote; `None` of other bytes.
    #[must_use]
    pub fn of_bytes(bytes: &[u8]) -> Option<Memory> {
        postcard::from_bytes(bytes).ok()
    }
}

/// What an agent made of the moment it acted in last.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Thought {
    /// Probability of each choice of each categorical sub-action.
    pub probabilities: Vec<Vec<f32>>,
    /// Return that is expected from here on, in the normalised units of training.
    pub value: Option<f32>,
    /// The same of each constrained cost, for algorithms that estimate it.
    pub cost_values: Vec<f32>,
    /// All of these in the units of returns and costs themselves, discounted, the return first;
    /// empty where those are not known.
    pub in_own_units: Vec<f32>,
}

/// The settings of the run in a directory, or of the one that an agent's file comes from, so that
/// its worlds can be made.
pub fn run_config(directory: &Path) -> Result<TrainConfig, LearnError> {
    match AgentFile::at(directory)? {
        Some(file) => Ok(file.card.config),
        None => read_config(directory),
    }
}

impl TrainedPolicy {
    /// The policy of published weights, for worlds with these cost terms.
    pub fn new(
        config: &TrainConfig,
        shape: &ModelShape,
        published: Published,
        device: ComputeDevice,
        cost_terms: &[CostTerm],
    ) -> Result<TrainedPolicy, LearnError> {
        // Only the algorithms of a single constraint shape what the network sees by it.
        let term = find_terms(cost_terms, &config.constraints[..1])?.swap_remove(0);
        let watched = term.filter(|_| shaping(config).extra_inputs() > 0);
        Ok(TrainedPolicy {
            config: config.clone(),
            shape: shape.clone(),
            published,
            device,
            watched,
            returns: Vec::new(),
            cost_gamma: config.cost_gamma_after(config.frames),
            run_frames: None,
        })
    }

    /// Loads the policy of a run, or of an agent's file, for worlds with these observations
    /// (height, width, channels) and actions.
    pub fn load(
        directory: &Path,
        which: Which,
        observation: [usize; 3],
        action: ActionShape,
        warn: &mut dyn FnMut(String),
    ) -> Result<TrainedPolicy, LearnError> {
        if let Some(file) = AgentFile::at(directory)? {
            let policy = TrainedPolicy::restored(
                &file.card.config,
                observation,
                action,
                |shape| file.check_fits(shape),
                |learner| file.restore_weights(learner),
            )?;
            let card = &file.card;
            let frames = card.selection.as_ref().map_or(card.config.frames, |one| one.frames);
            let cost_gamma = card.config.cost_gamma_after(frames);
            return Ok(TrainedPolicy { cost_gamma, ..policy }.in_units_of(&card.returns));
        }
        let config = read_config(directory)?;
        let store = Store::new(directory, 1);
        let selected = match which {
            Which::Selected => store.read_selected().map_err(|error| spoiled_selection(&error))?,
            Which::Latest => None,
        };
        let has_selected = selected.is_some();
        let loaded = match selected {
            Some((_, selected)) => Some(selected),
            None => store.newest(warn)?,
        };
        let loaded = loaded.ok_or_else(|| {
            if store.has_judged() {
                return LearnError::content(directory, GONE);
            }
            let command = go_on(&config, directory);
            LearnError::content(
                directory,
                format!("no checkpoint was written yet; let the run go on: {command}"),
            )
        })?;
        if which == Which::Selected {
            let missing = (!has_selected && store.has_judged()).then(|| {
                format!("{}: the checkpoint that it selected is gone", directory.display())
            });
            let instead = if has_selected { "the best candidate" } else { "the latest" };
            if let Some(problem) = damaged_selection(directory).or(missing) {
                warn(format!("{problem}; {instead} is played"));
            }
        }
        let policy = TrainedPolicy::restored(
            &config,
            observation,
            action,
            |shape| loaded.check_fits(shape),
            |learner| loaded.restore_weights(learner),
        )?;
        let cost_gamma = config.cost_gamma_after(loaded.progress.frames);
        let policy = TrainedPolicy { cost_gamma, run_frames: store.frames(), ..policy };
        Ok(policy.in_units_of(&loaded.progress.returns))
    }

    /// Its critics' values are normalised returns in the units of these moments, if there are some
    /// for each critic.
    #[must_use]
    pub fn in_units_of(self, returns: &[Moments]) -> TrainedPolicy {
        if returns.len() != 1 + self.shape.cost_critics {
            return self;
        }
        TrainedPolicy { returns: returns.to_vec(), ..self }
    }

    /// The units of what its critics say of each cost to come; none where they are not known, or
    /// where critics saw while they learned what an agent at work does not.
    #[must_use]
    pub fn cost_units(&self) -> &[Moments] {
        if !self.config.learning.critic_inputs.is_empty() {
            return &[];
        }
        self.returns.get(1..).unwrap_or_default()
    }

    /// Frames that its run had made when it was loaded, which may be more than its weights saw;
    /// `None` where it comes from no run.
    #[must_use]
    pub fn run_frames(&self) -> Option<u64> {
        self.run_frames
    }

    /// Discount of the costs that its critics predict.
    #[must_use]
    pub fn cost_gamma(&self) -> f64 {
        self.cost_gamma
    }

    /// A policy for the processor, whose weights `restore` puts into a learner, if `check_fits`
    /// finds as many as its shape has.
    pub(crate) fn restored(
        config: &TrainConfig,
        [height, width, channels]: [usize; 3],
        action: ActionShape,
        check_fits: impl FnOnce(&ModelShape) -> Result<(), LearnError>,
        restore: impl FnOnce(&mut Learner) -> Result<(), LearnError>,
    ) -> Result<TrainedPolicy, LearnError> {
        let space = config.env.action_space()?;
        if let Some(own) = space.as_ref().map(ActionShape::from)
            && own != action
        {
            return Err(LearnError::Config(format!(
                "an agent of {} cannot act here: its buttons are others; play it in its own environment",
                config.env.id
            )));
        }
        let mut config = config.clone();
        config.learning.threads = 1;
        let image = ImageShape { height, width, channels };
        let cost_critics =
            if config.algorithm.has_cost_critics() { config.constraints.len() } else { 0 };
        let shape = ModelShape::new(
            image,
            action,
            cost_critics,
            shaping(&config).extra_inputs(),
            &config.network,
        )?
        .with_critic_inputs(Privileged::new(&config).count())?
        .with_mirror(config.network.mirror, space.as_ref())?;
        // Before memory is taken for as many weights as the settings speak of.
        check_fits(&shape)?;
        // Wherever it was trained, and by whatever products, it acts on every processor.
        config.device = "cpu".into();
        config.learning.products = Products::Float32;
        let device = ComputeDevice::of(&config)?;
        let mut learner = Learner::new(&config, &shape, &device);
        restore(&mut learner)?;
        let terms = config.env.cost_terms()?.unwrap_or_default();
        TrainedPolicy::new(&config, &shape, learner.publish(), device, terms)
    }

    /// The run's settings.
    #[must_use]
    pub fn config(&self) -> &TrainConfig {
        &self.config
    }

    /// The same policy, computed by kernels whose bits are those of every processor.
    #[must_use]
    pub fn on_plain_kernels(self) -> TrainedPolicy {
        TrainedPolicy { device: ComputeDevice::plain(), ..self }
    }

    /// An agent for `lanes` worlds.
    #[must_use]
    pub fn agent(&self, choice: Choice, lanes: usize) -> Agent {
        let mut actor = Actor::new(&self.shape, &self.device);
        actor.load(&self.published);
        Agent {
            state: self.shape.zero_state(lanes),
            safety: vec![1.0; lanes],
            episodes: vec![(0, 0); lanes],
            rows: vec![0.0; lanes * self.shape.outputs()],
            shape: self.shape.clone(),
            actor,
            shaping: shaping(&self.config),
            watched: self.watched,
            choice,
            units: if self.config.learning.critic_inputs.is_empty() {
                self.returns.clone()
            } else {
                Vec::new()
            },
            normaliser: self.config.learning.normaliser,
        }
    }
}

impl Agent {
    /// Loads the agent of a run for `lanes` worlds with these observations (height, width,
    /// channels) and actions.
    pub fn load(
        directory: &Path,
        which: Which,
        choice: Choice,
        lanes: usize,
        observation: [usize; 3],
        action: ActionShape,
        warn: &mut dyn FnMut(String),
    ) -> Result<Agent, LearnError> {
        Ok(TrainedPolicy::load(directory, which, observation, action, warn)?.agent(choice, lanes))
    }

    /// Starts the episode of `seed` in a lane.
    ///
    /// # Panics
    /// If there is no such lane.
    pub fn reset(&mut self, lane: usize, seed: u64) {
        self.safety[lane] = 1.0;
        self.episodes[lane] = (seed, 0);
        for (state, network) in self.state.iter_mut().zip(&self.shape.networks) {
            let units = network.state_size();
            state[lane * units..(lane + 1) * units].fill(0.0);
        }
    }

    /// What the agent carries from step to step.
    #[must_use]
    pub fn memory(&self) -> Memory {
        Memory {
            state: self.state.clone(),
            safety: self.safety.clone(),
            episodes: self.episodes.clone(),
        }
    }

    /// What an agent carries at the beginning of episodes, a lane for each seed.
    #[must_use]
    pub fn blank(&self, seeds: &[u64]) -> Memory {
        let episodes = seeds.iter().map(|&seed| (seed, 0)).collect();
        Memory {
            state: self.shape.zero_state(seeds.len()),
            safety: vec![1.0; seeds.len()],
            episodes,
        }
    }

    /// Goes on from what an agent carried, with as many lanes as that had.
    ///
    /// # Errors
    /// When it is no memory of an agent like this one.
    pub fn remember(&mut self, memory: Memory) -> Result<(), LearnError> {
        let lanes = memory.episodes.len();
        let sizes = |state: &[Vec<f32>]| state.iter().map(Vec::len).collect::<Vec<_>>();
        if memory.safety.len() != lanes
            || sizes(&memory.state) != sizes(&self.shape.zero_state(lanes))
        {
            return Err(LearnError::Config(
                "this state is of another agent, or of another number of lanes".into(),
            ));
        }
        (self.state, self.safety, self.episodes) = (memory.state, memory.safety, memory.episodes);
        Ok(())
    }

    /// The network's output rows, given the observations of all lanes one after the other: logits
    /// and parameters of the actions, then the critics' values. The agent has then seen these
    /// observations.
    ///
    /// # Panics
    /// If they are not as many bytes as the lanes' observations have.
    pub fn rows(&mut self, observations: &[u8]) -> &[f32] {
        let lanes = self.safety.len();
        let bytes = lanes * self.shape.networks.first().map_or(0, |one| one.image.size());
        assert_eq!(
            observations.len(),
            bytes,
            "the observations of {lanes} lanes are {bytes} bytes"
        );
        let extra: Vec<f32> = match self.shape.extra_inputs() {
            0 => Vec::new(),
            _ => self.safety.iter().map(|&safety| seen(safety)).collect(),
        };
        // Critics see no more than the policy here, as at an episode's start: nothing acts by them.
        let privileged = vec![0.0; lanes * self.shape.critic_inputs];
        self.rows.resize(lanes * self.shape.outputs(), 0.0);
        self.actor.act(
            observations,
            &extra,
            &privileged,
            &mut self.state,
            0..lanes,
            &mut self.rows,
            None,
        );
        &self.rows
    }

    /// What to do in each lane, given the observations of all lanes one after the other.
    ///
    /// # Panics
    /// As [`Agent::rows`].
    pub fn act(&mut self, observations: &[u8]) -> Vec<Action> {
        self.rows(observations);
        let width = self.shape.outputs();
        let action = &self.shape.action;
        let mut all = Vec::with_capacity(self.safety.len());
        for (row, (seed, step)) in self.rows.chunks_exact(width).zip(&mut self.episodes) {
            let mut one =
                Action { actions: vec![0; action.sizes.len()], deltas: vec![0.0; action.deltas] };
            match self.choice {
                Choice::Greedy => action.greedy(row, &mut one.actions, &mut one.deltas),
                Choice::Sampled => {
                    let mut stream = Stream::new(*seed, Purpose::Evaluation, *seed, *step);
                    action.sample(row, &mut stream, &mut one.actions, &mut one.deltas);
                }
            }
            *step += 1;
            all.push(one);
        }
        all
    }

    /// What the agent made of the moment of its last action in a lane.
    ///
    /// # Panics
    /// If there is no such lane, or it has not acted yet.
    #[must_use]
    pub fn thought(&self, lane: usize) -> Thought {
        let width = self.shape.outputs();
        let row = &self.rows[lane * width..(lane + 1) * width];
        let values = &row[self.shape.action.parameters()..];
        let worth = |(moments, &value): (&Moments, &f32)| match self.normaliser {
            ReturnNormaliser::Running => moments.denormalise(value),
            ReturnNormaliser::PopArt => moments.scale_up(value),
        };
        Thought {
            probabilities: self.shape.action.probabilities(row),
            value: values.first().copied(),
            cost_values: values.get(1..).unwrap_or_default().to_vec(),
            in_own_units: self.units.iter().zip(values).map(worth).collect(),
        }
    }

    /// What each critic of a cost expected in a lane at its last action, in the normalised units of
    /// training.
    ///
    /// # Panics
    /// If there is no such lane, or it has not acted yet.
    #[must_use]
    pub fn cost_values(&self, lane: usize) -> &[f32] {
        let width = self.shape.outputs();
        let values = &self.rows[lane * width + self.shape.action.parameters()..(lane + 1) * width];
        values.get(1..).unwrap_or_default()
    }

    /// The cost term that it watches while it acts; `None` for the cost of all, or for agents that
    /// watch none.
    #[must_use]
    pub fn watched(&self) -> Option<usize> {
        self.watched
    }

    /// Notes what a step cost in a lane, in all and by cost terms; agents that watch their budget
    /// need it, and watch what they watched while they learned.
    ///
    /// # Panics
    /// If there is no such lane.
    pub fn observe_cost(&mut self, lane: usize, cost: f64, terms: &[f64]) {
        let watched = self.watched.and_then(|term| terms.get(term).copied()).unwrap_or(cost);
        (_, self.safety[lane]) = self.shaping.step(self.safety[lane], 0.0, watched as f32);
    }
}
