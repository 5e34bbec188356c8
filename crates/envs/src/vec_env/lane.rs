//! A lane: one environment of a batch, with the seeds of its episodes.

use super::{Autoreset, FinalObservations, LaneState};
use crate::{Environment, Episode, Step};
use hasard_engine::math::Rng;

/// One lane's parts of a batch's buffers, for one or several neighbouring lanes.
pub(super) struct LaneSlices<'a> {
    pub actions: &'a [u8],
    pub deltas: &'a [f32],
    pub observations: &'a mut [u8],
    pub rewards: &'a mut [f32],
    pub costs: &'a mut [f32],
    pub cost_terms: &'a mut [f32],
    pub positions: &'a mut [[i32; 2]],
    pub terminated: &'a mut [bool],
    pub truncated: &'a mut [bool],
}

/// What lanes report beside their buffers.
#[derive(Default)]
pub(super) struct Outbox {
    /// (lane of the batch, observation).
    pub final_observations: Vec<(usize, Vec<u8>)>,
    pub episodes: Vec<Episode>,
    pub panic: Option<String>,
}

impl Outbox {
    /// Whether there is nothing to report.
    pub fn is_empty(&self) -> bool {
        self.final_observations.is_empty() && self.episodes.is_empty() && self.panic.is_none()
    }

    /// Takes over what another has to report.
    pub fn append(&mut self, other: &mut Outbox) {
        self.final_observations.append(&mut other.final_observations);
        self.episodes.append(&mut other.episodes);
        self.panic = self.panic.take().or(other.panic.take());
    }
}

/// One environment of the batch. Its episodes follow from the batch's seed and its own number alone, whatever the batch's width,
/// the number of threads and the way of stepping.
pub(super) struct Lane {
    /// Place in the whole batch.
    pub index: usize,
    /// Number that decides its seeds.
    number: u64,
    env: Box<dyn Environment>,
    /// Seeds of the episodes to come.
    seeds: Rng,
    /// The running episode: seed and actions so far, enough to repeat it.
    seed: u64,
    actions: Vec<u8>,
    deltas: Vec<f32>,
    /// How the running episode ended, where the next one does not follow at once.
    ended: Option<Step>,
}

impl Lane {
    pub fn new(index: usize, number: u64, seed: u64, env: Box<dyn Environment>) -> Lane {
        // Room for an episode at frame skip 1, so that stepping never allocates.
        let (groups, deltas) = (env.action_space().groups.len(), env.action_space().deltas.len());
        let (actions, deltas) = (Vec::with_capacity(2104 * groups), Vec::with_capacity(2104 * deltas));
        Lane { index, number, env, seeds: Rng::for_lane(seed, number), seed: 0, actions, deltas, ended: None }
    }

    /// The environment.
    pub fn env(&self) -> &dyn Environment {
        &*self.env
    }

    /// Starts the lane's next episode.
    fn next_episode(&mut self) {
        let seed = self.seeds.next_u64();
        self.start(seed);
    }

    fn start(&mut self, seed: u64) {
        self.seed = seed;
        self.actions.clear();
        self.deltas.clear();
        self.ended = None;
        self.env.reset(seed);
    }

    fn advance(&mut self, actions: &[u8], deltas: &[f32]) -> Step {
        self.actions.extend_from_slice(actions);
        self.deltas.extend_from_slice(deltas);
        self.env.step(actions, deltas)
    }

    /// Starts the seeds of the episodes to come anew.
    pub fn reseed(&mut self, seed: u64) {
        self.seeds = Rng::for_lane(seed, self.number);
    }

    /// Where the lane is.
    pub fn state(&self) -> LaneState {
        let (actions, deltas) = (self.actions.clone(), self.deltas.clone());
        LaneState { seeds: self.seeds.state(), seed: self.seed, actions, deltas }
    }

    /// Brings the lane to a saved state by repeating its episode.
    pub fn restore(&mut self, state: &LaneState) {
        self.seeds = Rng::from_state(state.seeds);
        self.start(state.seed);
        let (groups, continuous) = (self.env.action_space().groups.len(), self.env.action_space().deltas.len());
        for (i, actions) in state.actions.chunks_exact(groups.max(1)).enumerate() {
            let step = self.advance(actions, &state.deltas[i * continuous..(i + 1) * continuous]);
            self.ended = step.ended().then_some(step);
        }
    }
}

/// How the lanes of a batch go on after an episode's end.
#[derive(Clone, Copy)]
pub(super) struct Manner {
    pub autoreset: Autoreset,
    pub final_observations: FinalObservations,
}

/// Starts the next episode in each lane and writes its first observation; everything else of the batch is set to nothing.
pub(super) fn reset_lanes(lanes: &mut [Lane], slices: LaneSlices) {
    let count = lanes.len();
    slices.rewards.fill(0.0);
    slices.costs.fill(0.0);
    slices.cost_terms.fill(0.0);
    slices.terminated.fill(false);
    slices.truncated.fill(false);
    for (lane, observation) in lanes.iter_mut().zip(parts(slices.observations, count)) {
        lane.next_episode();
        lane.env.observe(observation);
    }
    for (lane, position) in lanes.iter().zip(slices.positions) {
        *position = lane.env.position();
    }
}

/// Writes the present observation of each lane, without stepping.
pub(super) fn observe_lanes(lanes: &mut [Lane], slices: LaneSlices) {
    let count = lanes.len();
    for (lane, observation) in lanes.iter_mut().zip(parts(slices.observations, count)) {
        lane.env.observe(observation);
    }
}

/// Steps each lane by its action. `first` is the number of the first lane within the batch.
pub(super) fn step_lanes(lanes: &mut [Lane], first: usize, manner: Manner, slices: LaneSlices, outbox: &mut Outbox) {
    let count = lanes.len();
    let (groups, continuous) = (slices.actions.len() / count, slices.deltas.len() / count);
    let terms = slices.cost_terms.len() / count;
    for (i, (lane, observation)) in lanes.iter_mut().zip(parts(slices.observations, count)).enumerate() {
        let actions = &slices.actions[i * groups..(i + 1) * groups];
        let deltas = &slices.deltas[i * continuous..(i + 1) * continuous];
        let (step, moved) = match (lane.ended, manner.autoreset) {
            (Some(_), Autoreset::NextStep) => {
                lane.next_episode();
                (Step::default(), false)
            }
            (Some(last), _) => (Step { reward: 0.0, cost: 0.0, ..last }, false),
            (None, _) => {
                let step = lane.advance(actions, deltas);
                if step.ended() {
                    lane.ended = Some(step);
                    outbox.episodes.push(Episode { lane: lane.index, ..lane.env.episode() });
                }
                (step, true)
            }
        };
        slices.rewards[i] = step.reward as f32;
        slices.costs[i] = step.cost as f32;
        let terms_out = &mut slices.cost_terms[i * terms..(i + 1) * terms];
        for (out, &term) in terms_out.iter_mut().zip(lane.env.step_costs()) {
            *out = if moved { term as f32 } else { 0.0 };
        }
        slices.positions[i] = lane.env.position();
        slices.terminated[i] = step.terminated;
        slices.truncated[i] = step.truncated;
        if step.ended() && manner.autoreset == Autoreset::SameStep {
            let keep = manner.final_observations == FinalObservations::Every || (step.truncated && !step.terminated);
            if keep {
                let mut last = vec![0; observation.len()];
                lane.env.observe(&mut last);
                outbox.final_observations.push((first + i, last));
            }
            lane.next_episode();
        }
        lane.env.observe(observation);
    }
}

/// A buffer cut into `count` equal parts.
fn parts<T>(buffer: &mut [T], count: usize) -> std::slice::ChunksExactMut<'_, T> {
    let size = (buffer.len() / count).max(1);
    buffer.chunks_exact_mut(size)
}
