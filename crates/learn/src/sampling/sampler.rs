//! A sampler: some worlds and the policy that acts in them.
//!
//! With two groups and a thread for the worlds, one half of them steps while the policy works on
//! the other. With several samplers that step their own worlds the same happens between the
//! samplers.
//!
//! Long because sampling, saving and restoring touch the same rows in the same order.

mod first_steps;

use std::ops::Range;
use std::sync::{Arc, RwLock};

use hasard_envs::{Batch, Insight, LaneState, VecEnv};

use crate::config::Constraint;
use crate::config::constraint::find_terms;
use crate::error::LearnError;
use crate::networks::{Actor, ModelShape, Notes, Published};
use crate::random::{Purpose, Stream};
use crate::sampling::auxiliary::Auxiliary;
use crate::sampling::privileged::Privileged;
use crate::sampling::rollout::Part;
use crate::sampling::shaping::{Shaping, seen};

/// Where samplers find the newest weights.
pub type Newest = RwLock<Arc<Published>>;

/// What a sampler's lanes carry from one rollout to the next, beside the worlds: all that a resumed
/// run needs.
#[derive(Clone, Debug, PartialEq)]
pub struct SamplerState {
    /// Worlds.
    pub worlds: Vec<LaneState>,
    /// State of each network.
    pub state: Vec<Vec<f32>>,
    /// Safety state of each lane.
    pub safety: Vec<f64>,
    /// Steps that each lane has made.
    pub steps: u64,
    /// Cost of each constraint in each lane's episode so far; empty where no critic sees it.
    pub spent: Vec<f64>,
}

impl SamplerState {
    /// Takes over a lane of another state of the same sampler.
    fn take(&mut self, lane: usize, other: &SamplerState) {
        let lanes = self.worlds.len();
        let own = |all: usize| lane * (all / lanes)..(lane + 1) * (all / lanes);
        self.worlds[lane] = other.worlds[lane].clone();
        for (to, from) in self.state.iter_mut().zip(&other.state) {
            to[own(from.len())].copy_from_slice(&from[own(from.len())]);
        }
        self.safety[lane] = other.safety[lane];
        self.spent[own(other.spent.len())].copy_from_slice(&other.spent[own(other.spent.len())]);
    }
}

/// The same lanes dealt to other samplers, in their order: what happens in a lane does not depend
/// on its sampler. `None` if they do not belong together, or are not as many as the shares.
#[must_use]
pub fn dealt_anew(states: Vec<SamplerState>, shares: &[Range<usize>]) -> Option<Vec<SamplerState>> {
    let steps = states.first()?.steps;
    let lanes: usize = states.iter().map(|state| state.worlds.len()).sum();
    if shares.last()?.end != lanes || states.iter().any(|state| state.steps != steps) {
        return None;
    }
    let networks = states[0].state.len();
    let whole = |network: usize| {
        states.iter().flat_map(|one| &one.state[network]).copied().collect::<Vec<f32>>()
    };
    let memories: Vec<Vec<f32>> = (0..networks).map(whole).collect();
    let safety: Vec<f64> = states.iter().flat_map(|one| &one.safety).copied().collect();
    let spent: Vec<f64> = states.iter().flat_map(|one| &one.spent).copied().collect();
    let constraints = spent.len() / lanes.max(1);
    let mut worlds = states.into_iter().flat_map(|one| one.worlds);
    let deal = |share: &Range<usize>| {
        let part = |memory: &Vec<f32>| {
            let units = memory.len() / lanes;
            memory[share.start * units..share.end * units].to_vec()
        };
        SamplerState {
            worlds: worlds.by_ref().take(share.len()).collect(),
            state: memories.iter().map(part).collect(),
            safety: safety[share.clone()].to_vec(),
            spent: spent[share.start * constraints..share.end * constraints].to_vec(),
            steps,
        }
    };
    Some(shares.iter().map(deal).collect())
}

/// Some worlds and the policy that acts in them.
pub struct Sampler {
    shape: ModelShape,
    worlds: VecEnv,
    actor: Actor,
    shaping: Arc<dyn Shaping>,
    /// Where each constraint's cost is in the cost terms; `None` for the scalar cost.
    constraints: Vec<Option<usize>>,
    /// Number of the first lane among those of all samplers.
    first_lane: usize,
    seed: u64,
    /// The batch of each group, while it is not with the worlds.
    batches: Vec<Option<Batch>>,
    state: Vec<Vec<f32>>,
    safety: Vec<f64>,
    steps: u64,
    after_state: Vec<Vec<f32>>,
    /// What is computed is kept for the learner.
    recording: bool,
    /// Steps of the trajectories that the learner takes.
    trajectory_steps: usize,
    /// What the critics see and the policy does not, of each lane's steps and costs in its episode
    /// so far.
    privileged: Privileged,
    /// What the worlds show beside observations.
    insight: Insight,
    /// What the network predicts of them.
    auxiliary: Auxiliary,
    ages: Vec<u32>,
    spent: Vec<f64>,
}

impl Sampler {
    /// A sampler whose worlds have just been made; they start their first episodes.
    pub fn new(
        shape: &ModelShape,
        mut worlds: VecEnv,
        actor: Actor,
        shaping: Arc<dyn Shaping>,
        constraints: &[Constraint],
        first_lane: usize,
        seed: u64,
    ) -> Result<Sampler, LearnError> {
        let groups = worlds.groups();
        for group in 0..groups {
            let batch = worlds.batch(group);
            worlds.send_reset(group, batch).map_err(world_error)?;
        }
        let mut batches = Vec::new();
        for group in 0..groups {
            batches.push(Some(worlds.recv(group).map_err(world_error)?));
        }
        let lanes = worlds.lanes();
        Ok(Sampler {
            constraints: find_terms(worlds.cost_terms(), constraints)?,
            state: shape.zero_state(lanes),
            after_state: shape.zero_state(lanes),
            safety: vec![1.0; lanes],
            shape: shape.clone(),
            worlds,
            actor,
            shaping,
            first_lane,
            seed,
            batches,
            steps: 0,
            recording: false,
            trajectory_steps: usize::MAX,
            privileged: Privileged::default(),
            insight: Insight::default(),
            auxiliary: Auxiliary::default(),
            ages: vec![0; lanes],
            spent: vec![0.0; lanes * constraints.len()],
        })
    }

    /// Lanes of this sampler.
    #[must_use]
    pub fn lanes(&self) -> usize {
        self.worlds.lanes()
    }

    /// Keeps what the networks compute, for a learner that will have the same weights.
    pub fn record(&mut self) {
        self.recording = true;
    }

    /// Shows the critics what the policy does not see, in worlds that show so much beside
    /// observations.
    pub fn show_critics(&mut self, privileged: Privileged, insight: Insight) {
        (self.privileged, self.insight) = (privileged, insight);
    }

    /// Keeps what the pictures show, for a network that predicts it.
    pub fn predict(&mut self, auxiliary: Auxiliary) {
        self.auxiliary = auxiliary;
    }

    /// Keeps the states at the beginning of every trajectory of so many steps.
    pub fn cut(&mut self, trajectory_steps: usize) {
        self.trajectory_steps = trajectory_steps.max(1);
    }

    /// Where everything is between two rollouts.
    pub fn save(&mut self) -> Result<SamplerState, LearnError> {
        Ok(SamplerState {
            worlds: self.worlds.save().map_err(world_error)?,
            state: self.state.clone(),
            safety: self.safety.clone(),
            steps: self.steps,
            spent: if self.privileged.count() > 0 { self.spent.clone() } else { Vec::new() },
        })
    }

    /// Goes on from where another sampler of the same kind was.
    pub fn restore(&mut self, saved: SamplerState) -> Result<(), LearnError> {
        let fits = saved.state.len() == self.state.len()
            && saved.state.iter().zip(&self.state).all(|(a, b)| a.len() == b.len())
            && saved.safety.len() == self.safety.len()
            && (saved.spent.is_empty() || saved.spent.len() == self.spent.len());
        if !fits {
            return Err(LearnError::Config("the saved lanes are not those of this run".into()));
        }
        let action = &self.shape.action;
        let age = |lane: &LaneState| {
            let made = |parts: usize, each: usize| parts.checked_div(each).unwrap_or(0);
            made(lane.actions.len(), action.sizes.len()).max(made(lane.deltas.len(), action.deltas))
                as u32
        };
        self.ages = saved.worlds.iter().map(age).collect();
        if !saved.spent.is_empty() {
            self.spent = saved.spent;
        }
        let mut whole = self.worlds.whole_batch();
        self.worlds.restore(saved.worlds, &mut whole).map_err(world_error)?;
        let pixels = self.shape.pixels();
        for group in 0..self.worlds.groups() {
            let lanes = self.worlds.group_lanes(group);
            let batch =
                self.batches[group].as_mut().expect("no group is under way between rollouts");
            batch
                .observations
                .copy_from_slice(&whole.observations[lanes.start * pixels..lanes.end * pixels]);
            let shown = batch.insight.len() / lanes.len();
            batch.insight.copy_from_slice(&whole.insight[lanes.start * shown..lanes.end * shown]);
        }
        (self.state, self.safety, self.steps) = (saved.state, saved.safety, saved.steps);
        Ok(())
    }

    /// The episodes after the running ones are those of another seed.
    pub fn reseed(&mut self, seed: u64) -> Result<(), LearnError> {
        self.worlds.seed(seed).map_err(world_error)
    }

    /// Gathers `steps` steps of all lanes.
    pub fn fill(
        &mut self,
        part: &mut Part,
        steps: usize,
        newest: &Newest,
    ) -> Result<(), LearnError> {
        let groups = self.worlds.groups();
        part.prepare(&self.shape, steps, self.lanes(), groups, self.constraints.len());
        part.trajectory_steps = self.trajectory_steps.min(steps);
        part.shown.resize(steps * self.lanes() * self.auxiliary.cells(), 0);
        part.initial_state.resize_with(self.state.len(), Vec::new);
        let trajectories = part.trajectories();
        for (initial, state) in part.initial_state.iter_mut().zip(&self.state) {
            initial.resize(trajectories * state.len(), 0.0);
        }
        part.recordings.resize_with(
            if self.recording { self.shape.networks.len() } else { 0 },
            Default::default,
        );
        for step in 0..steps {
            let published =
                Arc::clone(&newest.read().unwrap_or_else(|poisoned| poisoned.into_inner()));
            self.actor.load(&published);
            part.versions[step] = published.version;
            for group in 0..groups {
                if step > 0 {
                    self.receive(group, step - 1, part)?;
                }
                if step.is_multiple_of(part.trajectory_steps) {
                    self.note_state(group, step / part.trajectory_steps, part);
                }
                self.act(group, step, part)?;
            }
        }
        self.steps += steps as u64;
        for group in 0..groups {
            self.receive(group, steps - 1, part)?;
            let batch = self.batches[group].as_ref().expect("just received");
            part.frames[steps * groups + group].copy_from_slice(&batch.observations);
            // The value of what follows is asked with a copy of the state: the next rollout asks
            // again with new weights.
            let lanes = self.worlds.group_lanes(group);
            for (copy, state) in self.after_state.iter_mut().zip(&self.state) {
                copy.copy_from_slice(state);
            }
            self.write_extra(part, steps, lanes.clone());
            self.write_privileged(part, steps, lanes.clone(), &batch.insight);
            let (seen, extra, outputs) =
                (self.shape.critic_inputs, self.shape.extra_inputs(), self.shape.outputs());
            let rows = steps * self.lanes() + lanes.start..steps * self.lanes() + lanes.end;
            self.actor.act(
                &batch.observations,
                &part.extra[rows.start * extra..rows.end * extra],
                &part.privileged[rows.start * seen..rows.end * seen],
                &mut self.after_state,
                lanes,
                &mut part.outputs[rows.start * outputs..rows.end * outputs],
                None,
            );
        }
        Ok(())
    }

    /// Notes the state that a trajectory of each lane of a group begins in.
    fn note_state(&self, group: usize, trajectory: usize, part: &mut Part) {
        let lanes = self.worlds.group_lanes(group);
        for ((initial, state), network) in
            part.initial_state.iter_mut().zip(&self.state).zip(&self.shape.networks)
        {
            let own = lanes.start * network.state_size()..lanes.end * network.state_size();
            initial[trajectory * state.len()..][own.clone()].copy_from_slice(&state[own]);
        }
    }

    fn write_extra(&self, part: &mut Part, step: usize, lanes: std::ops::Range<usize>) {
        if self.shape.extra_inputs() == 1 {
            for lane in lanes {
                part.extra[step * self.safety.len() + lane] = seen(self.safety[lane]);
            }
        }
    }

    /// Writes what the critics see of some lanes at a step, when their worlds show so much.
    fn write_privileged(&self, part: &mut Part, step: usize, lanes: Range<usize>, shown: &[u8]) {
        let (count, constraints) = (self.shape.critic_inputs, self.constraints.len());
        if count > 0 {
            let bytes = self.insight.bytes();
            for (index, lane) in lanes.enumerate() {
                let row = (step * self.ages.len() + lane) * count;
                let spent = &self.spent[lane * constraints..(lane + 1) * constraints];
                self.privileged.write(
                    self.ages[lane],
                    spent,
                    self.insight,
                    &shown[index * bytes..(index + 1) * bytes],
                    &mut part.privileged[row..row + count],
                );
            }
        }
    }

    /// Writes what the pictures of some lanes show at a step.
    fn write_shown(&self, part: &mut Part, step: usize, lanes: Range<usize>, shown: &[u8]) {
        let cells = self.auxiliary.cells();
        if cells > 0 {
            let first = (step * part.lanes + lanes.start) * cells;
            let to = part.shown[first..].chunks_exact_mut(cells);
            for (to, row) in to.zip(shown.chunks_exact(self.insight.bytes())) {
                let targets = self.auxiliary.targets(self.insight, row);
                to.iter_mut().zip(targets).for_each(|(to, class)| *to = class);
            }
        }
    }

    /// Chooses a group's actions and hands it to the worlds.
    fn act(&mut self, group: usize, step: usize, part: &mut Part) -> Result<(), LearnError> {
        let mut batch = self.batches[group].take().expect("the group is here");
        let lanes = self.worlds.group_lanes(group);
        let first_row = step * self.lanes();
        let rows = first_row + lanes.start..first_row + lanes.end;
        let (seen, extra, outputs) =
            (self.shape.critic_inputs, self.shape.extra_inputs(), self.shape.outputs());
        self.write_extra(part, step, lanes.clone());
        self.write_privileged(part, step, lanes.clone(), &batch.insight);
        self.write_shown(part, step, lanes.clone(), &batch.insight);
        let out = &mut part.outputs[rows.start * outputs..rows.end * outputs];
        let extra = &part.extra[rows.start * extra..rows.end * extra];
        let notes = Notes {
            recordings: &mut part.recordings,
            steps: part.steps,
            all_lanes: part.lanes,
            step,
        };
        let seen = &part.privileged[rows.start * seen..rows.end * seen];
        self.actor.act(
            &batch.observations,
            extra,
            seen,
            &mut self.state,
            lanes.clone(),
            out,
            Some(notes),
        );
        let action = &self.shape.action;
        let (count, deltas) = (action.sizes.len(), action.deltas);
        for (index, lane) in lanes.clone().enumerate() {
            let number = (self.first_lane + lane) as u64;
            let mut stream =
                Stream::new(self.seed, Purpose::Actions, number, self.steps + step as u64);
            part.log_probabilities[first_row + lane] = action.sample(
                &out[index * outputs..(index + 1) * outputs],
                &mut stream,
                &mut batch.actions[index * count..(index + 1) * count],
                &mut batch.deltas[index * deltas..(index + 1) * deltas],
            );
        }
        part.actions[rows.start * count..rows.end * count].copy_from_slice(&batch.actions);
        part.deltas[rows.start * deltas..rows.end * deltas].copy_from_slice(&batch.deltas);
        // The worlds write over all observations, so the frames change hands without being copied.
        std::mem::swap(
            &mut part.frames[step * self.worlds.groups() + group],
            batch.observations.to_mut(),
        );
        self.worlds.send(group, batch).map_err(world_error)
    }

    /// Takes a group back and notes what its step brought.
    fn receive(&mut self, group: usize, step: usize, part: &mut Part) -> Result<(), LearnError> {
        let mut batch = self.worlds.recv(group).map_err(world_error)?;
        let lanes = self.worlds.group_lanes(group);
        let first_row = step * self.lanes();
        let (count, terms) = (self.constraints.len(), self.worlds.cost_terms().len());
        for (index, lane) in lanes.clone().enumerate() {
            let row = first_row + lane;
            for (constraint, term) in self.constraints.iter().enumerate() {
                part.costs[row * count + constraint] = match term {
                    None => batch.costs[index],
                    Some(term) => batch.cost_terms[index * terms + term],
                };
            }
            self.ages[lane] += 1;
            let costs = &part.costs[row * count..(row + 1) * count];
            self.spent[lane * count..]
                .iter_mut()
                .zip(costs)
                .for_each(|(spent, &cost)| *spent += f64::from(cost));
            let (reward, safety) =
                self.shaping.step(self.safety[lane], batch.rewards[index], part.costs[row * count]);
            part.rewards[row] = reward.clamp(-1000.0, 1000.0);
            self.safety[lane] = safety;
            part.positions[row] = batch.positions[index];
            part.done[row] = batch.terminated[index] || batch.truncated[index];
        }
        for (place, (index, observation)) in batch.finals().enumerate() {
            let lane = lanes.start + index;
            let mut row = vec![0.0; self.shape.outputs()];
            for ((copy, state), network) in
                self.after_state.iter_mut().zip(&self.state).zip(&self.shape.networks)
            {
                let units = network.state_size();
                copy[..units].copy_from_slice(&state[lane * units..(lane + 1) * units]);
            }
            let seen = [seen(self.safety[lane])];
            let extra = &seen[..self.shape.extra_inputs()];
            let mut shown = vec![0.0; self.shape.critic_inputs];
            let constraints = self.constraints.len();
            self.privileged.write(
                self.ages[lane],
                &self.spent[lane * constraints..(lane + 1) * constraints],
                self.insight,
                batch.final_insight(place),
                &mut shown,
            );
            self.actor.act(observation, extra, &shown, &mut self.after_state, 0..1, &mut row, None);
            part.cut_off.push((first_row + lane, row));
        }
        for lane in lanes {
            if part.done[first_row + lane] {
                self.safety[lane] = 1.0;
                self.ages[lane] = 0;
                self.spent[lane * count..(lane + 1) * count].fill(0.0);
                for (state, network) in self.state.iter_mut().zip(&self.shape.networks) {
                    let units = network.state_size();
                    state[lane * units..(lane + 1) * units].fill(0.0);
                }
            }
        }
        for mut episode in batch.episodes.drain(..) {
            episode.lane += self.first_lane;
            part.episodes.push((step, episode));
        }
        self.batches[group] = Some(batch);
        Ok(())
    }
}

fn world_error(error: hasard_envs::EnvError) -> LearnError {
    LearnError::Worlds(error.to_string())
}
