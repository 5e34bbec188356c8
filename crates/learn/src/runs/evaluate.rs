//! A trained agent, acting.

use std::path::Path;

use crate::config::TrainConfig;
use crate::error::LearnError;
use crate::learning::learner::Learner;
use crate::networks::device::ComputeDevice;
use crate::networks::distribution::ActionShape;
use crate::networks::{Actor, ImageShape, ModelShape};
use crate::random::{Purpose, Stream};
use crate::runs::checkpoint::{Loaded, Store};
use crate::runs::run_directory::read_config;
use crate::sampling::shaping::Shaping;

/// Which checkpoint of a run acts.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Which {
    /// The newest whole one.
    #[default]
    Latest,
    /// The one with the best return within all budgets.
    Best,
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

/// A trained agent for some worlds side by side, each with an episode of its own.
pub struct Agent {
    shape: ModelShape,
    actor: Actor,
    shaping: Shaping,
    choice: Choice,
    state: Vec<Vec<f32>>,
    safety: Vec<f64>,
    /// Seed of each lane's episode, and its steps so far: what its draws come from.
    episodes: Vec<(u64, u64)>,
    /// What the network put out last, a row a lane.
    rows: Vec<f32>,
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
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Memory {
    /// State of each network, `[lanes, units]`.
    pub state: Vec<Vec<f32>>,
    /// What is left of each lane's budget, for agents that watch it.
    pub safety: Vec<f64>,
    /// Seed of each lane's episode, and its steps so far: what its draws come from.
    pub episodes: Vec<(u64, u64)>,
}

/// The settings of the run in a directory, so that its worlds can be made.
pub fn run_config(directory: &Path) -> Result<TrainConfig, LearnError> {
    read_config(directory)
}

impl Agent {
    /// Loads the agent of a run for `lanes` worlds with these observations (height, width, channels) and actions.
    pub fn load(
        directory: &Path,
        which: Which,
        choice: Choice,
        lanes: usize,
        observation: [usize; 3],
        action: ActionShape,
        warn: &mut dyn FnMut(String),
    ) -> Result<Agent, LearnError> {
        let mut config = read_config(directory)?;
        config.learning.threads = 1;
        let store = Store::new(directory, 1);
        let loaded = match which {
            Which::Latest => store.newest(warn)?,
            Which::Best if store.best().exists() => Some(Loaded::read(&store.best())?),
            Which::Best => None,
        };
        let missing = match which {
            Which::Latest => "no checkpoint was written yet; let the run go on with `hasard train --resume`",
            Which::Best => "no checkpoint kept all budgets; use the latest one",
        };
        let loaded = loaded.ok_or_else(|| LearnError::content(directory, missing))?;
        let [height, width, channels] = observation;
        let shaping = Shaping::new(&config);
        let cost_critics = if config.algorithm.has_cost_critics() { config.constraints.len() } else { 0 };
        let image = ImageShape { height, width, channels };
        let shape = ModelShape::new(image, action, cost_critics, shaping.extra_inputs(), &config.network)?;
        // Wherever it was trained, it acts on the processor.
        config.device = "cpu".into();
        let device = ComputeDevice::of(&config)?;
        let mut learner = Learner::new(&config, &shape, &device);
        loaded.restore_weights(&mut learner)?;
        let mut actor = Actor::new(&shape, &device);
        actor.load(&learner.publish());
        Ok(Agent {
            state: shape.zero_state(lanes),
            safety: vec![1.0; lanes],
            episodes: vec![(0, 0); lanes],
            rows: vec![0.0; lanes * shape.outputs()],
            shape,
            actor,
            shaping,
            choice,
        })
    }

    /// What the agent carries from step to step.
    #[must_use]
    pub fn memory(&self) -> Memory {
        Memory { state: self.state.clone(), safety: self.safety.clone(), episodes: self.episodes.clone() }
    }

    /// What an agent carries at the beginning of episodes, a lane for each seed.
    #[must_use]
    pub fn blank(&self, seeds: &[u64]) -> Memory {
        let episodes = seeds.iter().map(|&seed| (seed, 0)).collect();
        Memory { state: self.shape.zero_state(seeds.len()), safety: vec![1.0; seeds.len()], episodes }
    }

    /// Goes on from what an agent carried, with as many lanes as that had.
    ///
    /// # Errors
    /// When it is no memory of an agent like this one.
    pub fn remember(&mut self, memory: Memory) -> Result<(), LearnError> {
        let lanes = memory.episodes.len();
        let sizes = |state: &[Vec<f32>]| state.iter().map(Vec::len).collect::<Vec<_>>();
        if memory.safety.len() != lanes || sizes(&memory.state) != sizes(&self.shape.zero_state(lanes)) {
            return Err(LearnError::Config("this state is of another agent, or of another number of lanes".into()));
        }
        (self.state, self.safety, self.episodes) = (memory.state, memory.safety, memory.episodes);
        Ok(())
    }

    /// Starts the episode of `seed` in a lane.
    pub fn reset(&mut self, lane: usize, seed: u64) {
        self.safety[lane] = 1.0;
        self.episodes[lane] = (seed, 0);
        for (state, network) in self.state.iter_mut().zip(&self.shape.networks) {
            let units = network.state_size();
            state[lane * units..(lane + 1) * units].fill(0.0);
        }
    }

    /// The network's output rows, given the observations of all lanes one after the other: logits and parameters of the actions, then the
    /// critics' values. The agent has then seen these observations.
    pub fn rows(&mut self, observations: &[u8]) -> &[f32] {
        let lanes = self.safety.len();
        let extra: Vec<f32> = match self.shape.extra_inputs() {
            0 => Vec::new(),
            _ => self.safety.iter().map(|&safety| Shaping::seen(safety)).collect(),
        };
        self.rows.resize(lanes * self.shape.outputs(), 0.0);
        self.actor.act(observations, &extra, &mut self.state, 0..lanes, &mut self.rows, None);
        &self.rows
    }

    /// What to do in each lane, given the observations of all lanes one after the other.
    pub fn act(&mut self, observations: &[u8]) -> Vec<Action> {
        self.rows(observations);
        let width = self.shape.outputs();
        let action = &self.shape.action;
        let mut all = Vec::with_capacity(self.safety.len());
        for (row, (seed, step)) in self.rows.chunks_exact(width).zip(&mut self.episodes) {
            let mut one = Action { actions: vec![0; action.sizes.len()], deltas: vec![0.0; action.deltas] };
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
    #[must_use]
    pub fn thought(&self, lane: usize) -> Thought {
        let width = self.shape.outputs();
        let row = &self.rows[lane * width..(lane + 1) * width];
        let mut logits = row;
        let probabilities = self.shape.action.sizes.iter().map(|&size| {
            let (group, rest) = logits.split_at(size);
            logits = rest;
            let largest = group.iter().copied().fold(f32::NEG_INFINITY, f32::max);
            let exponentials: Vec<f32> = group.iter().map(|logit| (logit - largest).exp()).collect();
            let sum: f32 = exponentials.iter().sum();
            exponentials.iter().map(|one| one / sum).collect()
        });
        let probabilities = probabilities.collect();
        let mut values = row[self.shape.action.parameters()..].iter().copied();
        Thought { probabilities, value: values.next(), cost_values: values.collect() }
    }

    /// Tells what a step cost in a lane; agents that watch their budget need it.
    pub fn observe_cost(&mut self, lane: usize, cost: f64) {
        (_, self.safety[lane]) = self.shaping.step(self.safety[lane], 0.0, cost as f32);
    }
}
