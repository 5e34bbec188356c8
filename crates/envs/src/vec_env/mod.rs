//! The batch of worlds: many environments stepped side by side by worker threads and the caller that waits for them.

mod handover;
mod lane;
mod worker;

use crate::{ActionSpace, Batch, CostTerm, Env, EnvError, EnvOptions, Environment};
use handover::{Lanes, Slot};
use lane::{Lane, LaneSlices, Manner, Outbox};
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use worker::Shared;

/// What follows an episode's end.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Autoreset {
    /// The same step starts the next episode; the observation is its first.
    #[default]
    SameStep,
    /// The step after starts the next episode, whatever its action; its reward and cost are 0.
    NextStep,
    /// The lane rests, its flags raised, until the batch is reset.
    Disabled,
}

/// Which last observations [`Batch::final_observations`] keeps under [`Autoreset::SameStep`].
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum FinalObservations {
    /// Those of truncated episodes, whose value is still to be estimated.
    #[default]
    Truncated,
    /// Those of every episode.
    Every,
}

/// How a batch of worlds is made.
#[derive(Clone, Copy, Debug)]
pub struct VecOptions {
    /// Number of environments.
    pub lanes: usize,
    /// Worker threads; 0 steps in the caller's thread. A caller that waits for a batch helps with it, so that `n` cores are used up
    /// by `n - 1` threads if the caller has nothing else to do.
    pub threads: usize,
    /// Groups that the lanes are cut into, to be stepped independently: 2 lets a policy work on one half while the other steps.
    pub groups: usize,
    /// Seed of the batch: with the lane's number it decides everything that happens in a lane.
    pub seed: u64,
    /// Number of the first lane, so that a batch may continue where another ends.
    pub first_lane: u64,
    /// What follows an episode's end.
    pub autoreset: Autoreset,
    /// Which last observations are kept.
    pub final_observations: FinalObservations,
}

impl Default for VecOptions {
    fn default() -> VecOptions {
        VecOptions {
            lanes: 1,
            threads: 0,
            groups: 1,
            seed: 0,
            first_lane: 0,
            autoreset: Autoreset::default(),
            final_observations: FinalObservations::default(),
        }
    }
}

/// Where one lane is: enough to bring it back exactly, by repeating its episode.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct LaneState {
    /// State of the stream that the seeds of the episodes to come are drawn from.
    pub seeds: u64,
    /// Seed of the running episode.
    pub seed: u64,
    /// Categorical sub-actions of the episode so far.
    pub actions: Vec<u8>,
    /// Continuous sub-actions of the episode so far.
    pub deltas: Vec<f32>,
}

/// What is done with a batch's lanes.
#[derive(Clone)]
enum Job {
    Reset,
    Step,
    /// Starts the seeds of episodes anew from a seed, nothing more.
    Seed(u64),
    /// Writes each lane's state to its place.
    Save(Arc<Mutex<Vec<LaneState>>>),
    /// Brings each lane to the state at its place, and observes it.
    Restore(Arc<Vec<LaneState>>),
}

fn run_job(job: &Job, lanes: &mut [Lane], first: usize, manner: Manner, slices: LaneSlices, outbox: &mut Outbox) {
    if lanes.is_empty() {
        return;
    }
    match job {
        Job::Reset => lane::reset_lanes(lanes, slices),
        Job::Step => lane::step_lanes(lanes, first, manner, slices, outbox),
        Job::Seed(seed) => lanes.iter_mut().for_each(|lane| lane.reseed(*seed)),
        Job::Save(states) => {
            let mut states = states.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
            for lane in lanes.iter() {
                states[lane.index] = lane.state();
            }
        }
        Job::Restore(states) => {
            lanes.iter_mut().for_each(|lane| lane.restore(&states[lane.index]));
            lane::observe_lanes(lanes, slices);
        }
    }
}

/// Who steps the lanes.
enum Crew {
    /// The caller's thread; a group's batch is stepped when it is sent.
    Caller { lanes: Vec<Lane>, ready: Vec<Option<(Batch, Outbox)>> },
    /// Worker threads, and the caller's while it waits.
    Workers { shared: Arc<Shared>, threads: Vec<JoinHandle<()>>, busy: Vec<bool> },
}

/// A batch of worlds.
///
/// Either all lanes step together ([`reset`](VecEnv::reset), [`step`](VecEnv::step)), or each group by itself
/// ([`send`](VecEnv::send), [`recv`](VecEnv::recv)): then a policy works on one group while the others step. A lane's episodes
/// depend on the batch's seed and the lane's number alone; the number of threads, the batch's width and the way of stepping change nothing.
///
/// ```
/// use hasard_envs::{EnvOptions, VecEnv, VecOptions};
/// let options = VecOptions { lanes: 4, threads: 2, groups: 2, ..VecOptions::default() };
/// let mut worlds = VecEnv::new("VolcanicVentureLevel1-v0", &EnvOptions::default(), options)?;
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
    space: ActionSpace,
    observation_shape: [usize; 3],
    cost_terms: &'static [CostTerm],
    extent: Option<[i32; 4]>,
    options: VecOptions,
    crew: Crew,
    /// An environment panicked; nothing can be trusted any more.
    failed: Option<String>,
}

impl VecEnv {
    /// A batch of one environment of the benchmark; map, pictures and tables are shared by all lanes.
    pub fn new(id: &str, env_options: &EnvOptions, options: VecOptions) -> Result<VecEnv, EnvError> {
        let first = Env::new(id, env_options)?;
        VecEnv::from_fn(options, |_| Ok(Box::new(first.sibling())))
    }

    /// A batch of any environments; `make` is given the lane's index, and all must have the same shapes.
    pub fn from_fn(
        options: VecOptions,
        mut make: impl FnMut(usize) -> Result<Box<dyn Environment>, EnvError>,
    ) -> Result<VecEnv, EnvError> {
        let limit = |option, given: usize, most: usize| {
            let allowed = format!("1..={most}");
            if (1..=most).contains(&given) { Ok(()) } else { Err(EnvError::Option { option, given: given.to_string(), allowed }) }
        };
        limit("the number of environments", options.lanes, 65536)?;
        limit("the number of groups", options.groups, options.lanes)?;
        limit("the number of threads", options.threads.max(1), 1024)?;
        let mut lanes = Vec::with_capacity(options.lanes);
        for index in 0..options.lanes {
            let number = options.first_lane.wrapping_add(index as u64);
            lanes.push(Lane::new(index, number, options.seed, make(index)?));
        }
        let env = lanes[0].env();
        let (space, observation_shape, cost_terms) = (env.action_space().clone(), env.observation_shape(), env.cost_terms());
        let extent = env.extent();
        let manner = Manner { autoreset: options.autoreset, final_observations: options.final_observations };
        let crew = if options.threads == 0 {
            Crew::Caller { lanes, ready: (0..=options.groups).map(|_| None).collect() }
        } else {
            hire(lanes, options, manner)
        };
        Ok(VecEnv { space, observation_shape, cost_terms, extent, options, crew, failed: None })
    }

    /// The action space of every lane.
    #[must_use]
    pub const fn action_space(&self) -> &ActionSpace {
        &self.space
    }

    /// Shape of a lane's observation.
    #[must_use]
    pub const fn observation_shape(&self) -> [usize; 3] {
        self.observation_shape
    }

    /// The cost terms, in the order of [`Batch::cost_terms`].
    #[must_use]
    pub const fn cost_terms(&self) -> &'static [CostTerm] {
        self.cost_terms
    }

    /// The map's extent: x from, y from, x to, y to in map units; `None` for environments without places.
    #[must_use]
    pub const fn extent(&self) -> Option<[i32; 4]> {
        self.extent
    }

    /// Number of lanes.
    #[must_use]
    pub const fn lanes(&self) -> usize {
        self.options.lanes
    }

    /// Number of groups.
    #[must_use]
    pub const fn groups(&self) -> usize {
        self.options.groups
    }

    /// The lanes of a group; the group after the last stands for all lanes together.
    #[must_use]
    pub fn group_lanes(&self, group: usize) -> Range<usize> {
        group_lanes(&self.options, group)
    }

    /// A batch with buffers of the right lengths for a group.
    #[must_use]
    pub fn batch(&self, group: usize) -> Batch {
        let lanes = self.group_lanes(group).len();
        Batch {
            actions: vec![0; lanes * self.space.groups.len()],
            deltas: vec![0.0; lanes * self.space.deltas.len()],
            observations: vec![0; lanes * self.observation_shape.iter().product::<usize>()],
            rewards: vec![0.0; lanes],
            costs: vec![0.0; lanes],
            cost_terms: vec![0.0; lanes * self.cost_terms.len()],
            positions: vec![[0, 0]; lanes],
            terminated: vec![false; lanes],
            truncated: vec![false; lanes],
            final_observations: Vec::new(),
            episodes: Vec::new(),
        }
    }

    /// A batch for all lanes together.
    #[must_use]
    pub fn whole_batch(&self) -> Batch {
        self.batch(self.options.groups)
    }

    /// Starts the next episode in every lane. The batch's outputs are then those of a step that brought nothing.
    pub fn reset(&mut self, batch: &mut Batch) -> Result<(), EnvError> {
        self.exchange(batch, Job::Reset)
    }

    /// Steps every lane by the batch's actions and fills its outputs.
    pub fn step(&mut self, batch: &mut Batch) -> Result<(), EnvError> {
        self.check_actions(batch)?;
        self.exchange(batch, Job::Step)
    }

    /// Hands a group's batch over for the start of the next episode in each of its lanes.
    pub fn send_reset(&mut self, group: usize, batch: Batch) -> Result<(), EnvError> {
        self.check_group(group)?;
        self.give(group, batch, Job::Reset)
    }

    /// Hands a group's batch over to be stepped by its actions. On an error the batch is dropped; [`VecEnv::check`] tells beforehand.
    pub fn send(&mut self, group: usize, batch: Batch) -> Result<(), EnvError> {
        self.check_group(group)?;
        self.check_actions(&batch)?;
        self.give(group, batch, Job::Step)
    }

    /// Waits until a group has been stepped, and takes its batch back.
    pub fn recv(&mut self, group: usize) -> Result<Batch, EnvError> {
        self.check_group(group)?;
        self.take(group)
    }

    /// Starts the lanes' streams of episode seeds anew, as if the batch had been made with this seed. Running episodes go on.
    pub fn seed(&mut self, seed: u64) -> Result<(), EnvError> {
        let mut batch = self.whole_batch();
        self.exchange(&mut batch, Job::Seed(seed))
    }

    /// Where every lane is. No group may be under way.
    pub fn save(&mut self) -> Result<Vec<LaneState>, EnvError> {
        let states = Arc::new(Mutex::new(vec![LaneState::default(); self.options.lanes]));
        let mut batch = self.whole_batch();
        self.exchange(&mut batch, Job::Save(Arc::clone(&states)))?;
        let mut states = states.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        Ok(std::mem::take(&mut *states))
    }

    /// Brings every lane to a saved state, by repeating its episode so far, and writes the observations.
    pub fn restore(&mut self, states: Vec<LaneState>, batch: &mut Batch) -> Result<(), EnvError> {
        if states.len() != self.options.lanes {
            let allowed = format!("{}, one of each lane", self.options.lanes);
            return Err(EnvError::Option { option: "the number of saved lanes", given: states.len().to_string(), allowed });
        }
        let (groups, continuous) = (self.space.groups.len(), self.space.deltas.len());
        for (lane, state) in states.iter().enumerate() {
            let steps = state.actions.len().checked_div(groups).unwrap_or(0);
            if state.actions.len() != steps * groups || state.deltas.len() != steps * continuous {
                return Err(EnvError::Action { lane, why: "a saved episode does not fit the action space".to_string() });
            }
            for i in 0..steps {
                let (actions, deltas) =
                    (&state.actions[i * groups..(i + 1) * groups], &state.deltas[i * continuous..(i + 1) * continuous]);
                self.space.check(lane, actions, deltas)?;
            }
        }
        self.exchange(batch, Job::Restore(Arc::new(states)))
    }

    /// What is wrong with a group's batch (`group` = [`VecEnv::groups`] for all lanes), if anything.
    pub fn check(&self, group: usize, batch: &Batch) -> Result<(), EnvError> {
        let lanes = self.group_lanes(group).len();
        let pixels: usize = self.observation_shape.iter().product();
        for (field, given, needed) in [
            ("actions", batch.actions.len(), lanes * self.space.groups.len()),
            ("deltas", batch.deltas.len(), lanes * self.space.deltas.len()),
            ("observations", batch.observations.len(), lanes * pixels),
            ("rewards", batch.rewards.len(), lanes),
            ("costs", batch.costs.len(), lanes),
            ("cost_terms", batch.cost_terms.len(), lanes * self.cost_terms.len()),
            ("positions", batch.positions.len(), lanes),
            ("terminated", batch.terminated.len(), lanes),
            ("truncated", batch.truncated.len(), lanes),
        ] {
            if given != needed {
                return Err(EnvError::BatchSize { field, given, needed });
            }
        }
        Ok(())
    }

    fn check_actions(&self, batch: &Batch) -> Result<(), EnvError> {
        let (groups, continuous) = (self.space.groups.len(), self.space.deltas.len());
        for lane in 0..batch.rewards.len() {
            let actions = batch.actions.get(lane * groups..(lane + 1) * groups).unwrap_or_default();
            let deltas = batch.deltas.get(lane * continuous..(lane + 1) * continuous).unwrap_or_default();
            self.space.check(lane, actions, deltas)?;
        }
        Ok(())
    }

    fn check_group(&self, group: usize) -> Result<(), EnvError> {
        if group < self.options.groups {
            return Ok(());
        }
        let allowed = format!("less than {}, the number of groups", self.options.groups);
        Err(EnvError::Option { option: "the group", given: group.to_string(), allowed })
    }

    /// Gives all lanes a job and waits for it.
    fn exchange(&mut self, batch: &mut Batch, job: Job) -> Result<(), EnvError> {
        let whole = self.options.groups;
        self.check(whole, batch)?;
        self.check_turn(whole)?;
        self.give(whole, std::mem::take(batch), job)?;
        *batch = self.take(whole)?;
        Ok(())
    }

    fn check_turn(&self, slot: usize) -> Result<(), EnvError> {
        if let Some(message) = &self.failed {
            return Err(EnvError::Panicked { message: message.clone() });
        }
        let under_way = |i: usize| match &self.crew {
            Crew::Caller { ready, .. } => ready[i].is_some(),
            Crew::Workers { busy, .. } => busy[i],
        };
        let whole = self.options.groups;
        // All lanes together are busy while any group is.
        if under_way(slot) || (slot == whole && (0..whole).any(under_way)) {
            return Err(EnvError::Turn { why: "a group of lanes is under way; receive it first".to_string() });
        }
        Ok(())
    }

    fn give(&mut self, slot: usize, mut batch: Batch, job: Job) -> Result<(), EnvError> {
        self.check(slot, &batch)?;
        self.check_turn(slot)?;
        batch.episodes.clear();
        batch.final_observations.clear();
        let range = self.group_lanes(slot);
        match &mut self.crew {
            Crew::Caller { lanes, ready } => {
                let manner = Manner { autoreset: self.options.autoreset, final_observations: self.options.final_observations };
                let mut outbox = Outbox::default();
                let own = &mut lanes[range];
                let run = || run_job(&job, own, 0, manner, slices(&mut batch), &mut outbox);
                if let Err(panic) = catch_unwind(AssertUnwindSafe(run)) {
                    outbox.panic = Some(worker::panic_text(&*panic));
                }
                ready[slot] = Some((batch, outbox));
            }
            Crew::Workers { shared, threads, busy } => {
                shared.slots[slot].give(batch, job);
                busy[slot] = true;
                shared.given.fetch_add(1, Ordering::Release);
                threads.iter().for_each(|thread| thread.thread().unpark());
            }
        }
        Ok(())
    }

    fn take(&mut self, slot: usize) -> Result<Batch, EnvError> {
        let idle = || EnvError::Turn { why: format!("group {slot} is not under way; send it first") };
        let mut reports = Outbox::default();
        let mut batch = match &mut self.crew {
            Crew::Caller { ready, .. } => {
                let (batch, outbox) = ready[slot].take().ok_or_else(idle)?;
                reports = outbox;
                batch
            }
            Crew::Workers { shared, busy, .. } => {
                if !std::mem::take(&mut busy[slot]) {
                    return Err(idle());
                }
                shared.help(self.options.threads, slot);
                let batch = shared.slots[slot].take();
                for outboxes in &shared.outboxes {
                    reports.append(&mut outboxes[slot].lock().unwrap_or_else(|poisoned| poisoned.into_inner()));
                }
                batch
            }
        };
        if let Some(message) = reports.panic {
            self.failed = Some(message.clone());
            return Err(EnvError::Panicked { message });
        }
        (batch.final_observations, batch.episodes) = (reports.final_observations, reports.episodes);
        // Lanes are stepped in any order.
        batch.final_observations.sort_by_key(|&(lane, _)| lane);
        batch.episodes.sort_by_key(|episode| episode.lane);
        Ok(batch)
    }
}

impl Drop for VecEnv {
    fn drop(&mut self) {
        if let Crew::Workers { shared, threads, .. } = &mut self.crew {
            shared.stop.store(true, Ordering::Release);
            for thread in threads.drain(..) {
                thread.thread().unpark();
                // A worker catches panics of environments; there is nothing left to report.
                let _ = thread.join();
            }
        }
    }
}

/// The lanes of a group: equal shares of the whole; the group after the last is the whole.
fn group_lanes(options: &VecOptions, group: usize) -> Range<usize> {
    if group >= options.groups { 0..options.lanes } else { cut(0..options.lanes, group, options.groups) }
}

/// The `i`-th of `count` nearly equal parts.
fn cut(range: Range<usize>, i: usize, count: usize) -> Range<usize> {
    let at = |i: usize| range.start + range.len() * i / count;
    at(i)..at(i + 1)
}

/// Starts the worker threads.
fn hire(lanes: Vec<Lane>, options: VecOptions, manner: Manner) -> Crew {
    let slots = || 0..=options.groups;
    let shared = Arc::new(Shared {
        lanes: Lanes::new(lanes),
        slots: slots().map(|slot| Slot::new(group_lanes(&options, slot))).collect(),
        outboxes: (0..=options.threads).map(|_| slots().map(|_| Mutex::default()).collect()).collect(),
        given: AtomicU64::new(0),
        stop: AtomicBool::new(false),
        manner,
    });
    let hire = |worker| {
        let shared = Arc::clone(&shared);
        let thread = std::thread::Builder::new().name(format!("worlds {worker}")).spawn(move || worker::work(worker, shared));
        thread.expect("the system refuses another thread")
    };
    let threads = (0..options.threads).map(hire).collect();
    Crew::Workers { shared, threads, busy: slots().map(|_| false).collect() }
}

/// All lanes of a batch, by the borrow checker's rules.
fn slices(batch: &mut Batch) -> LaneSlices<'_> {
    LaneSlices {
        actions: &batch.actions,
        deltas: &batch.deltas,
        observations: &mut batch.observations,
        rewards: &mut batch.rewards,
        costs: &mut batch.costs,
        cost_terms: &mut batch.cost_terms,
        positions: &mut batch.positions,
        terminated: &mut batch.terminated,
        truncated: &mut batch.truncated,
    }
}
