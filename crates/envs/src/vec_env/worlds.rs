//! The batch of worlds as one type.
//!
//! Long because every way to step a batch is a method of one type, and most of it is what they promise.

use super::alike::alike;
use super::checks::Shape;
use super::chosen::{Chosen, Restart};
use super::crew::Crew;
use super::job::{Job, Task};
use super::lane::Lane;
use super::lane_state::LaneState;
use super::mixed::{self, MixedTask, Mixture};
use super::options::{Autoreset, VecOptions};
use crate::machine_memory::{check as check_memory, machine_memory};
use crate::{ActionSpace, Batch, CostTerm, Env, EnvError, EnvOptions, Environment};
use std::ops::Range;
use std::sync::{Arc, Mutex};

/// A batch of worlds.
///
/// Either all lanes step together ([`reset`](VecEnv::reset), [`step`](VecEnv::step)), or each group
/// by itself ([`send`](VecEnv::send), [`recv`](VecEnv::recv)): then a policy works on one group
/// while the others step. A lane's episodes depend on the batch's seed and the lane's number alone;
/// the number of threads, the batch's width and the way of stepping change nothing. A lane that is
/// stepped before its first reset begins its first episode with that step.
///
/// ```
/// use hasard_envs::{EnvOptions, VecEnv, VecOptions};
/// let options = VecOptions { lanes: 4, threads: 2, groups: 2, ..VecOptions::default() };
/// let mut worlds = VecEnv::new("RemedyRushLevel1-v0", &EnvOptions::default(), options)?;
/// for group in 0..2 {
///     let batch = worlds.batch(group);
///     worlds.send_reset(group, batch)?;
/// }
/// for _ in 0..3 {
///     for group in 0..2 {
///         let mut batch = worlds.recv(group)?;
///         batch.actions.fill(1); // what the policy says to batch.observations
///         worlds.send(group, batch)?;
///     }
/// }
/// # Ok::<(), hasard_envs::EnvError>(())
/// ```
pub struct VecEnv {
    shape: Shape,
    extent: Option<[i32; 4]>,
    mixture: Option<Mixture>,
    crew: Crew,
    /// Lanes whose episode is over and whose next one has not begun.
    resting: Vec<bool>,
    /// Of each slot, the batch that an error kept from going on its way.
    kept: Vec<Option<Batch>>,
    /// An environment panicked; nothing can be trusted any more.
    failed: Option<String>,
}

impl VecEnv {
    /// A batch of one environment of the benchmark, or of several, joined by commas, which the
    /// lanes take in turn ([`VecEnv::mixed`]); map, pictures and tables are shared by all lanes of
    /// a task.
    pub fn new(
        id: &str,
        env_options: &EnvOptions,
        options: VecOptions,
    ) -> Result<VecEnv, EnvError> {
        VecEnv::of_envs(&mixed::environments(id, env_options)?, options)
    }

    /// A batch of siblings of an environment, or of several, which the lanes take in turn.
    pub fn of_envs(envs: &[Env], options: VecOptions) -> Result<VecEnv, EnvError> {
        let sibling = |task: usize| Box::new(envs[task].sibling()) as Box<dyn Environment>;
        if envs.len() == 1 {
            return VecEnv::from_fn(options, |_| Ok(sibling(0)));
        }
        VecEnv::mixed(Mixture::of(envs)?, options, |task, _| Ok(sibling(task)))
    }

    /// A batch of different tasks with one action space: the lane of number `n` has task `n` modulo
    /// the number of tasks. `make` is given a task and the lane's index.
    ///
    /// ```
    /// use hasard_envs::{EnvOptions, VecEnv, VecOptions};
    /// let ids = "RemedyRushLevel1-v0,CollateralDamageLevel1-v0";
    /// let worlds = VecEnv::new(ids, &EnvOptions::default(), VecOptions::default())?;
    /// assert_eq!(worlds.tasks().len(), 2);
    /// // TURN, FORWARD, SPEED and JUMP of the one and ATTACK of the other.
    /// assert_eq!(worlds.action_space().sizes(), [3, 2, 2, 2, 2]);
    /// # Ok::<(), hasard_envs::EnvError>(())
    /// ```
    pub fn mixed(
        mixture: Mixture,
        options: VecOptions,
        mut make: impl FnMut(usize, usize) -> Result<Box<dyn Environment>, EnvError>,
    ) -> Result<VecEnv, EnvError> {
        let mut worlds = VecEnv::of_tasks(options, mixture.count(), |lane| {
            let task = mixture.task_of(options.first_lane.wrapping_add(lane as u64));
            Ok(mixture.lane(task, make(task, lane)?))
        })?;
        worlds.mixture = Some(mixture);
        Ok(worlds)
    }

    /// The tasks of a mixed batch; none where all lanes have the same.
    #[must_use]
    pub fn tasks(&self) -> Vec<MixedTask> {
        self.mixture.as_ref().map(Mixture::tasks).unwrap_or_default()
    }

    /// Which of [`VecEnv::tasks`] a lane has; 0 where there is but one.
    #[must_use]
    pub fn task_of(&self, lane: usize) -> usize {
        let number = self.shape.options.first_lane.wrapping_add(lane as u64);
        self.mixture.as_ref().map_or(0, |mixture| mixture.task_of(number))
    }

    /// A batch of any environments; `make` is given the lane's index. All must be alike: the same
    /// actions, shape of observations, cost terms and statistics.
    pub fn from_fn(
        options: VecOptions,
        make: impl FnMut(usize) -> Result<Box<dyn Environment>, EnvError>,
    ) -> Result<VecEnv, EnvError> {
        VecEnv::of_tasks(options, 1, make)
    }

    /// A batch whose lanes take so many tasks in turn.
    fn of_tasks(
        options: VecOptions,
        tasks: usize,
        mut make: impl FnMut(usize) -> Result<Box<dyn Environment>, EnvError>,
    ) -> Result<VecEnv, EnvError> {
        options.check()?;
        let mut lanes: Vec<Lane> = Vec::with_capacity(options.lanes);
        for index in 0..options.lanes {
            let env = make(index)?;
            if index == 0 {
                check_memory(options.lanes, env.observation_shape(), machine_memory())?;
            }
            alike(lanes.first().map_or(&*env, Lane::env), &*env, index)?;
            let number = options.first_lane.wrapping_add(index as u64);
            lanes.push(Lane::new(index, number, options, env));
        }
        let env = lanes[0].env();
        let shape = Shape {
            space: env.action_space().clone(),
            observation: env.observation_shape(),
            cost_terms: env.cost_terms(),
            statistics: env.stat_names(),
            options,
            envs: lanes.iter().map(|lane| lane.fingerprint).collect(),
        };
        let extent = env.extent();
        let slots = || 0..=options.groups;
        Ok(VecEnv {
            shape,
            extent,
            mixture: None,
            crew: Crew::new(lanes, options, tasks)?,
            resting: vec![false; options.lanes],
            kept: slots().map(|_| None).collect(),
            failed: None,
        })
    }

    /// The action space of every lane.
    #[must_use]
    pub const fn action_space(&self) -> &ActionSpace {
        &self.shape.space
    }

    /// Shape of a lane's observation.
    #[must_use]
    pub const fn observation_shape(&self) -> [usize; 3] {
        self.shape.observation
    }

    /// The cost terms, in the order of [`Batch::cost_terms`].
    #[must_use]
    pub const fn cost_terms(&self) -> &'static [CostTerm] {
        self.shape.cost_terms
    }

    /// Names of the statistics, in the order of [`Batch::statistics`].
    #[must_use]
    pub fn statistics(&self) -> &[&'static str] {
        &self.shape.statistics
    }

    /// The map's extent: x from, y from, x to, y to in map units; `None` for environments without
    /// places.
    #[must_use]
    pub const fn extent(&self) -> Option<[i32; 4]> {
        self.extent
    }

    /// Number of lanes.
    #[must_use]
    pub const fn lanes(&self) -> usize {
        self.shape.options.lanes
    }

    /// Number of groups.
    #[must_use]
    pub const fn groups(&self) -> usize {
        self.shape.options.groups
    }

    /// The lanes of a group; the group after the last stands for all lanes together.
    #[must_use]
    pub fn group_lanes(&self, group: usize) -> Range<usize> {
        self.shape.options.group_lanes(group)
    }

    /// Which lanes' episodes are over without the next one having begun, `[lanes]`: under
    /// [`Autoreset::Disabled`] those that rest until they are reset, under [`Autoreset::NextStep`]
    /// those whose next step starts an episode.
    #[must_use]
    pub fn resting(&self) -> &[bool] {
        &self.resting
    }

    /// Whether no batch is under way.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        (0..=self.shape.options.groups).all(|slot| !self.crew.under_way(slot))
    }

    /// A batch with buffers of the right lengths for a group.
    #[must_use]
    pub fn batch(&self, group: usize) -> Batch {
        self.batch_of(self.group_lanes(group).len())
    }

    /// A batch for all lanes together.
    #[must_use]
    pub fn whole_batch(&self) -> Batch {
        self.batch_of(self.shape.options.lanes)
    }

    /// A batch for so many lanes, whichever they are: see [`VecEnv::step_lanes`].
    #[must_use]
    pub fn batch_of(&self, lanes: usize) -> Batch {
        let statistics =
            if self.shape.options.statistics { self.shape.statistics.len() } else { 0 };
        Batch {
            actions: vec![0; lanes * self.shape.space.groups.len()],
            deltas: vec![0.0; lanes * self.shape.space.deltas.len()],
            observations: vec![0; lanes * self.shape.observation.iter().product::<usize>()].into(),
            rewards: vec![0.0; lanes].into(),
            costs: vec![0.0; lanes].into(),
            cost_terms: vec![0.0; lanes * self.shape.cost_terms.len()].into(),
            statistics: vec![0.0; lanes * statistics].into(),
            positions: vec![[0, 0]; lanes].into(),
            insight: vec![0; lanes * self.shape.options.insight.bytes()].into(),
            terminated: vec![false; lanes].into(),
            truncated: vec![false; lanes].into(),
            ..Batch::default()
        }
    }

    /// Starts the next episode in every lane. The batch's outputs are then those of a step that
    /// brought nothing.
    pub fn reset(&mut self, batch: &mut Batch) -> Result<(), EnvError> {
        self.exchange(batch, Job::Reset)
    }

    /// Resets each lane as `how[lane]` says: some, with a seed each or without, while others
    /// stay where they are. The batch shows all of them.
    pub fn restart(&mut self, how: &[Restart], batch: &mut Batch) -> Result<(), EnvError> {
        self.shape.check_restarts(how)?;
        self.exchange(batch, Job::Restart(how.into()))
    }

    /// Steps every lane by the batch's actions and fills its outputs.
    pub fn step(&mut self, batch: &mut Batch) -> Result<(), EnvError> {
        self.shape.check_actions(batch, &Chosen::Range(0..self.shape.options.lanes))?;
        self.exchange(batch, Job::Step)
    }

    /// Steps some lanes, each once and in any order, by the actions of a batch for so many lanes
    /// ([`VecEnv::batch_of`]).
    pub fn step_lanes(&mut self, lanes: &[usize], batch: &mut Batch) -> Result<(), EnvError> {
        self.shape.check_lanes(lanes)?;
        let lanes = Chosen::List(lanes.into());
        self.shape.check_actions(batch, &lanes)?;
        self.exchange_with(batch, Task { job: Job::Step, lanes })
    }

    /// Hands a group's batch over for the start of the next episode in each of its lanes.
    pub fn send_reset(&mut self, group: usize, batch: Batch) -> Result<(), EnvError> {
        self.hand_over(group, batch, Job::Reset)
    }

    /// Hands a group's batch over to be stepped by its actions. On an error the batch waits for
    /// [`VecEnv::reclaim`].
    pub fn send(&mut self, group: usize, batch: Batch) -> Result<(), EnvError> {
        self.hand_over(group, batch, Job::Step)
    }

    /// Waits until a group has been stepped, and takes its batch back. If an environment panicked,
    /// the batch waits for [`VecEnv::reclaim`], its outputs half written.
    pub fn recv(&mut self, group: usize) -> Result<Batch, EnvError> {
        self.shape.check_group(group)?;
        let (batch, result) = self.take(group)?;
        match result {
            Ok(()) => Ok(batch),
            Err(error) => {
                self.kept[group] = Some(batch);
                Err(error)
            }
        }
    }

    /// The batch that could not be sent to a group, or that was under way when an environment
    /// panicked: an error never costs the caller its buffers.
    pub fn reclaim(&mut self, group: usize) -> Option<Batch> {
        self.kept.get_mut(group)?.take()
    }

    /// Starts the lanes' streams of episode seeds anew, as if the batch had been made with this
    /// seed. Running episodes go on.
    pub fn seed(&mut self, seed: u64) -> Result<(), EnvError> {
        let mut batch = self.whole_batch();
        self.exchange(&mut batch, Job::Seed(seed))
    }

    /// Where every lane is. No group may be under way.
    pub fn save(&mut self) -> Result<Vec<LaneState>, EnvError> {
        let states = Arc::new(Mutex::new(vec![LaneState::default(); self.shape.options.lanes]));
        let mut batch = self.whole_batch();
        self.exchange(&mut batch, Job::Save(Arc::clone(&states)))?;
        let mut states = states.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        Ok(std::mem::take(&mut *states))
    }

    /// Brings every lane to a saved state, by repeating its episode so far, and shows it as after a
    /// step that brought nothing. What was saved from another environment, or from one made with
    /// other options, is refused.
    pub fn restore(&mut self, states: Vec<LaneState>, batch: &mut Batch) -> Result<(), EnvError> {
        self.shape.check_states(&states)?;
        self.exchange(batch, Job::Restore(Arc::new(states)))
    }

    /// What is wrong with a group's batch (`group` = [`VecEnv::groups`] for all lanes), if
    /// anything.
    pub fn check(&self, group: usize, batch: &Batch) -> Result<(), EnvError> {
        self.shape.check_lengths(self.group_lanes(group).len(), batch)
    }

    /// Whether a slot's lanes are free: all lanes together are busy while any group is.
    fn check_turn(&self, slot: usize) -> Result<(), EnvError> {
        if let Some(message) = &self.failed {
            return Err(EnvError::Panicked { message: message.clone() });
        }
        let whole = self.shape.options.groups;
        if self.crew.under_way(slot)
            || (slot == whole && (0..whole).any(|group| self.crew.under_way(group)))
        {
            return Err(EnvError::Turn {
                why: "a group of lanes is under way; receive it first".to_string(),
            });
        }
        Ok(())
    }

    /// Checks a group's batch and gives it to the crew, or keeps it to be reclaimed.
    fn hand_over(&mut self, group: usize, batch: Batch, job: Job) -> Result<(), EnvError> {
        // A batch of no group at all still has a place where it can be reclaimed from: that of all
        // lanes.
        let slot = group.min(self.shape.options.groups);
        let lanes = Chosen::Range(self.group_lanes(group));
        let check = || {
            self.shape.check_group(group)?;
            if matches!(job, Job::Step) {
                self.shape.check_actions(&batch, &lanes)?;
            }
            self.check(group, &batch)?;
            self.check_turn(group)
        };
        if let Err(error) = check() {
            self.kept[slot] = Some(batch);
            return Err(error);
        }
        self.give(slot, batch, Task { job, lanes });
        Ok(())
    }

    /// Gives all lanes a job and waits for it.
    fn exchange(&mut self, batch: &mut Batch, job: Job) -> Result<(), EnvError> {
        self.exchange_with(batch, Task { job, lanes: Chosen::Range(0..self.shape.options.lanes) })
    }

    /// Gives lanes a job and waits for it. The caller has its batch back in any case.
    fn exchange_with(&mut self, batch: &mut Batch, task: Task) -> Result<(), EnvError> {
        let whole = self.shape.options.groups;
        self.shape.check_lengths(task.lanes.count(), batch)?;
        self.check_turn(whole)?;
        // What only moves streams of seeds, or reads them, shows nothing and changes no lane's
        // rest.
        let shows = !matches!(task.job, Job::Seed(_) | Job::Save(_));
        let lanes = shows.then(|| task.lanes.clone());
        self.give(whole, std::mem::take(batch), task);
        let (returned, result) = self.take(whole)?;
        *batch = returned;
        if let (Ok(()), Some(lanes)) = (&result, lanes) {
            self.note_rest(batch, &lanes);
        }
        result
    }

    fn give(&mut self, slot: usize, mut batch: Batch, task: Task) {
        batch.episodes.clear();
        batch.final_lanes.clear();
        batch.final_observations.clear();
        batch.final_insight.clear();
        batch.happenings.clear();
        self.crew.give(slot, batch, task);
    }

    /// Takes a batch back, and what went wrong with it.
    fn take(&mut self, slot: usize) -> Result<(Batch, Result<(), EnvError>), EnvError> {
        let idle =
            || EnvError::Turn { why: format!("group {slot} is not under way; send it first") };
        let (mut batch, mut reports) = self.crew.take(slot).ok_or_else(idle)?;
        if let Some(message) = reports.panic.take() {
            self.failed = Some(message.clone());
            return Ok((batch, Err(EnvError::Panicked { message })));
        }
        reports.deliver(&mut batch);
        if slot < self.shape.options.groups {
            self.note_rest(&batch, &Chosen::Range(self.group_lanes(slot)));
        }
        Ok((batch, Ok(())))
    }

    /// Notes which of a batch's lanes rest now.
    fn note_rest(&mut self, batch: &Batch, lanes: &Chosen) {
        if self.shape.options.autoreset != Autoreset::SameStep {
            for index in 0..lanes.count() {
                self.resting[lanes.lane(index)] = batch.terminated[index] || batch.truncated[index];
            }
        }
    }
}
