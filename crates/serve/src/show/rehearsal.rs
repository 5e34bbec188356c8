//! An episode acted out once, without pictures for people: what every step brought is known before
//! it is shown, so that the time line shows costs to come, and every step can be jumped to by
//! acting the same again.

use super::performer::Performer;
use super::query::WatchQuery;
use crate::shared::Shared;
use hasard_engine::world::Command;
use hasard_envs::{ActionSpace, Env, EnvOptions, Move, PolicyRun};
use hasard_learn::runs::evaluate::{Agent, Choice, Thought};
use hasard_media::episode::EpisodeFile;
use hasard_play::{Stage, options_from_names};
use serde_json::{Value, json};
use std::path::Path;
use std::time::{Duration, Instant};

/// What a step brought.
struct Fact {
    command: Command,
    actions: Vec<u8>,
    reward: f64,
    cost: f64,
    /// The step's cost of each named term.
    terms: Vec<f64>,
    /// Sums so far.
    episode_return: f64,
    episode_cost: f64,
    thought: Option<Thought>,
}

enum Actor {
    Fixed(Box<PolicyRun>),
    Agent(Box<Agent>, Vec<u8>),
    Recorded(Box<EpisodeFile>),
}

/// The episode as far as it is acted out.
pub(super) struct Rehearsal {
    env: Env,
    actor: Actor,
    facts: Vec<Fact>,
    over: bool,
    /// What is shown of the agent's task and world.
    pub options: EnvOptions,
    pub id: String,
    pub seed: u64,
}

impl Rehearsal {
    /// Sets the scene.
    pub fn new(
        shared: &Shared,
        query: &WatchQuery,
        performer: &Performer,
    ) -> Result<Rehearsal, String> {
        let (id, options, seed) = match performer {
            Performer::Fixed(_) => (query.env.clone(), query.options(), query.seed),
            Performer::Agent { run, .. } => {
                let (trained, options) = shared.agents.options(run)?;
                let id = if query.env.is_empty() { trained } else { query.env.clone() };
                let (hard, trained_with) =
                    (query.hard || options.hard, (options.rules, options.hard));
                (id, EnvOptions { hard, actions_of: Some(trained_with), ..options }, query.seed)
            }
            Performer::Recorded(path) => {
                let file = EpisodeFile::read(path).map_err(|error| error.to_string())?;
                let header = file.header();
                let options = options_from_names(&header.options, &EnvOptions::default(), path)
                    .map_err(|error| error.to_string())?;
                (header.env.clone(), options, header.seed)
            }
        };
        let mut env = shared.stages.stage(&id, &options)?.env().sibling();
        env.reset(seed);
        let actor = match performer {
            Performer::Fixed(policy) => Actor::Fixed(Box::new(
                PolicyRun::new(*policy, &env, seed).map_err(|error| error.to_string())?,
            )),
            Performer::Agent { run, best, greedy } => {
                let choice = if *greedy { Choice::Greedy } else { Choice::Sampled };
                let mut agent = shared.agents.load(run, *best, choice, &env)?;
                agent.reset(0, seed);
                let observation = vec![0; env.observation_shape().iter().product()];
                Actor::Agent(Box::new(agent), observation)
            }
            Performer::Recorded(path) => {
                Actor::Recorded(Box::new(recorded(path, env.action_space())?))
            }
        };
        Ok(Rehearsal { env, actor, facts: Vec::new(), over: false, options, id, seed })
    }

    /// A stage to show it on.
    pub fn stage(&self, shared: &Shared) -> Result<Stage, String> {
        let mut stage = shared.stages.stage(&self.id, &self.options)?;
        stage.reset(self.seed);
        Ok(stage)
    }

    pub fn over(&self) -> bool {
        self.over
    }

    pub fn steps(&self) -> usize {
        self.facts.len()
    }

    /// Return and cost so far.
    pub fn sums(&self) -> (f64, f64) {
        self.facts.last().map_or((0.0, 0.0), |fact| (fact.episode_return, fact.episode_cost))
    }

    /// What is pressed in a step.
    pub fn command(&self, step: usize) -> Option<Command> {
        self.facts.get(step).map(|fact| fact.command)
    }

    /// Acts on for a time, or until a number of steps is known.
    pub fn go_on(&mut self, time: Duration, until: usize) {
        let begun = Instant::now();
        while !self.over && self.facts.len() < until && begun.elapsed() < time {
            self.step();
        }
    }

    fn step(&mut self) {
        let space = self.env.action_space();
        let mut thought = None;
        let (command, actions) = match &mut self.actor {
            Actor::Fixed(policy) => match policy.next_move(&self.env) {
                Move::Action(actions, deltas) => (space.command(actions, deltas), actions.to_vec()),
                Move::Buttons(command) => (command, pressed(space, command)),
            },
            Actor::Agent(agent, observation) => {
                self.env.observe(observation);
                let action = agent.act(observation).swap_remove(0);
                thought = Some(agent.thought(0));
                (self.env.action_space().command(&action.actions, &action.deltas), action.actions)
            }
            Actor::Recorded(file) => match file.step(self.facts.len()) {
                Some((actions, deltas)) => (space.command(actions, deltas), actions.to_vec()),
                None => {
                    self.over = true;
                    return;
                }
            },
        };
        let step = self.env.step_buttons(command);
        if let Actor::Agent(agent, _) = &mut self.actor {
            agent.observe_cost(0, step.cost, self.env.step_costs());
        }
        let episode = self.env.episode();
        self.facts.push(Fact {
            command,
            actions,
            reward: step.reward,
            cost: step.cost,
            terms: self.env.step_costs().to_vec(),
            episode_return: episode.episode_return,
            episode_cost: episode.cost,
            thought,
        });
        self.over = step.ended();
    }

    /// What is known of the episode from a step on, for the time line.
    pub fn known_from(&self, first: usize) -> Value {
        let facts = &self.facts[first.min(self.facts.len())..];
        // A term that is measured beside the cost is no cost.
        let kind = |counted: bool| if counted { "cost" } else { "noted" };
        let mut events = Vec::new();
        for (at, fact) in facts.iter().enumerate() {
            let step = first + at + 1;
            if fact.reward > 0.0 {
                events.push(json!({ "step": step, "kind": "reward", "what": "reward", "size": fact.reward }));
            }
            for (term, size) in
                self.env.cost_terms().iter().zip(&fact.terms).filter(|(_, size)| **size > 0.0)
            {
                events.push(json!({ "step": step, "kind": kind(term.counted), "what": term.name, "size": size }));
            }
        }
        let round = |value: f64| (value * 1000.0).round() / 1000.0;
        json!({
            "kind": "steps",
            "from": first,
            "returns": facts.iter().map(|fact| round(fact.episode_return)).collect::<Vec<_>>(),
            "costs": facts.iter().map(|fact| round(fact.episode_cost)).collect::<Vec<_>>(),
            "events": events,
            "over": self.over,
        })
    }

    /// What does not change in the course of the episode.
    pub fn scene(&self) -> Value {
        let space = self.env.action_space();
        let groups: Vec<Vec<&str>> = space
            .groups
            .iter()
            .map(|group| group.buttons.iter().map(|(name, _)| *name).collect())
            .collect();
        let budget = self.env.id().safety_budget(self.options.rules, self.options.hard);
        json!({
            "kind": "scene", "env": self.id, "seed": self.seed.to_string(), "budget": budget, "groups": groups,
            "terms": self.env.cost_terms().iter().map(|term| term.name).collect::<Vec<_>>(),
            "frame_skip": self.options.frame_skip, "length": self.env.episode_steps(),
        })
    }

    /// A step's numbers; `step` counts from 1, 0 is the beginning. What the agent thinks is of the
    /// step to come.
    pub fn moment(&self, step: usize) -> Value {
        let fact = step.checked_sub(1).and_then(|at| self.facts.get(at));
        let mut terms = vec![0.0; self.env.cost_terms().len()];
        for fact in &self.facts[..step.min(self.facts.len())] {
            terms.iter_mut().zip(&fact.terms).for_each(|(sum, term)| *sum += term);
        }
        let next = self.facts.get(step).or(fact);
        let thought = next.and_then(|fact| fact.thought.as_ref());
        json!({
            "step": step,
            "return": fact.map_or(0.0, |fact| fact.episode_return),
            "cost": fact.map_or(0.0, |fact| fact.episode_cost),
            "reward": fact.map_or(0.0, |fact| fact.reward),
            "step_cost": fact.map_or(0.0, |fact| fact.cost),
            "terms": terms,
            "actions": next.map(|fact| &fact.actions),
            "probabilities": thought.map(|thought| &thought.probabilities),
            "value": thought.and_then(|thought| thought.value),
            "cost_values": thought.map(|thought| &thought.cost_values),
            "expected": thought.map(|thought| &thought.in_own_units),
        })
    }
}

fn recorded(path: &Path, space: &ActionSpace) -> Result<EpisodeFile, String> {
    let file = EpisodeFile::read(path).map_err(|error| error.to_string())?;
    file.check_actions(&space.sizes(), space.deltas.len(), path)
        .map_err(|error| error.to_string())?;
    Ok(file)
}

/// The choice in each group that comes nearest to buttons.
fn pressed(space: &ActionSpace, command: Command) -> Vec<u8> {
    let choice = |group: &hasard_envs::ActionGroup| {
        group
            .buttons
            .iter()
            .position(|&(_, button)| command.buttons.any(button))
            .map_or(0, |at| at as u8 + 1)
    };
    space.groups.iter().map(choice).collect()
}
