//! A lane: one environment of a batch, with the seeds of its episodes.

use super::chosen::Restart;
use super::lane_state::LaneState;
use super::options::{Autoreset, FinalObservations, VecOptions};
use crate::{Batch, Environment, Episode, Happening, Insight, Step};
use hasard_engine::math::Rng;

/// One lane's parts of a batch's buffers, or those of several neighbouring lanes.
pub(super) struct LaneSlices<'a> {
    pub actions: &'a [u8],
    pub deltas: &'a [f32],
    pub observations: &'a mut [u8],
    pub rewards: &'a mut [f32],
    pub costs: &'a mut [f32],
    pub cost_terms: &'a mut [f32],
    pub statistics: &'a mut [f64],
    pub positions: &'a mut [[i32; 2]],
    pub insight: &'a mut [u8],
    pub terminated: &'a mut [bool],
    pub truncated: &'a mut [bool],
}

impl<'a> LaneSlices<'a> {
    /// All lanes of a batch, by the borrow checker's rules.
    pub fn of(batch: &'a mut Batch) -> LaneSlices<'a> {
        LaneSlices {
            actions: &batch.actions,
            deltas: &batch.deltas,
            observations: &mut batch.observations,
            rewards: &mut batch.rewards,
            costs: &mut batch.costs,
            cost_terms: &mut batch.cost_terms,
            statistics: &mut batch.statistics,
            positions: &mut batch.positions,
            insight: &mut batch.insight,
            terminated: &mut batch.terminated,
            truncated: &mut batch.truncated,
        }
    }

    /// Cuts the first of `count` lanes off.
    pub fn cut(&mut self, count: usize) -> LaneSlices<'a> {
        fn front<'a, T>(rest: &mut &'a mut [T], count: usize) -> &'a mut [T] {
            let each = rest.len() / count;
            let (front, back) = std::mem::take(rest).split_at_mut(each);
            *rest = back;
            front
        }
        let (actions, deltas) = (self.actions.len() / count, self.deltas.len() / count);
        let (own_actions, other_actions) = self.actions.split_at(actions);
        let (own_deltas, other_deltas) = self.deltas.split_at(deltas);
        (self.actions, self.deltas) = (other_actions, other_deltas);
        LaneSlices {
            actions: own_actions,
            deltas: own_deltas,
            observations: front(&mut self.observations, count),
            rewards: front(&mut self.rewards, count),
            costs: front(&mut self.costs, count),
            cost_terms: front(&mut self.cost_terms, count),
            statistics: front(&mut self.statistics, count),
            positions: front(&mut self.positions, count),
            insight: front(&mut self.insight, count),
            terminated: front(&mut self.terminated, count),
            truncated: front(&mut self.truncated, count),
        }
    }

    /// Writes what a step brought, but for the observation.
    fn note(
        &mut self,
        step: Step,
        env: &dyn Environment,
        moved: bool,
        scratch: &mut Vec<(&'static str, f64)>,
    ) {
        self.rewards[0] = step.reward as f32;
        self.costs[0] = step.cost as f32;
        self.cost_terms.fill(0.0);
        if moved {
            self.cost_terms
                .iter_mut()
                .zip(env.step_costs())
                .for_each(|(out, &term)| *out = term as f32);
        }
        if !self.statistics.is_empty() {
            scratch.clear();
            env.stats(scratch);
            self.statistics
                .iter_mut()
                .zip(scratch.iter())
                .for_each(|(out, &(_, value))| *out = value);
        }
        self.positions[0] = env.position();
        self.terminated[0] = step.terminated;
        self.truncated[0] = step.truncated;
    }
}

/// What lanes report beside their buffers.
#[derive(Default)]
pub(super) struct Outbox {
    /// (lane of the batch, observation, what is shown beside it).
    pub final_observations: Vec<(usize, Vec<u8>, Vec<u8>)>,
    pub episodes: Vec<Episode>,
    /// (lane of the batch, what happened there).
    pub happenings: Vec<(usize, Vec<Happening>)>,
    pub panic: Option<String>,
}

impl Outbox {
    /// Whether there is nothing to report.
    pub fn is_empty(&self) -> bool {
        self.final_observations.is_empty()
            && self.episodes.is_empty()
            && self.happenings.is_empty()
            && self.panic.is_none()
    }

    /// Takes over what another has to report.
    pub fn append(&mut self, other: &mut Outbox) {
        self.final_observations.append(&mut other.final_observations);
        self.episodes.append(&mut other.episodes);
        self.happenings.append(&mut other.happenings);
        self.panic = self.panic.take().or(other.panic.take());
    }

    /// Lays the reports into a batch, in the order of lanes: they were stepped in any order.
    pub fn deliver(mut self, batch: &mut Batch) {
        self.final_observations.sort_by_key(|&(lane, ..)| lane);
        for (lane, observation, insight) in self.final_observations {
            batch.final_lanes.push(lane);
            batch.final_observations.extend_from_slice(&observation);
            batch.final_insight.extend_from_slice(&insight);
        }
        self.happenings.sort_by_key(|&(lane, _)| lane);
        // First how many each lane has, then where they end.
        batch.happening_offsets.clear();
        batch.happening_offsets.resize(batch.lanes() + 1, 0);
        for (lane, happenings) in self.happenings {
            batch.happening_offsets[lane + 1] = happenings.len();
            batch.happenings.extend(happenings);
        }
        let mut end = 0;
        for offset in &mut batch.happening_offsets {
            end += *offset;
            *offset = end;
        }
        self.episodes.sort_by_key(|episode| episode.lane);
        batch.episodes = self.episodes;
    }
}

/// What is wrong with the costs of an episode, if they are not those of all terms of its
/// environment: who holds a term against a budget relies on it, and a term left out would pass for
/// one that cost nothing. One of several tasks reports its own terms and its whole cost.
fn unreported(env: &dyn Environment, episode: &Episode) -> Option<String> {
    let reported = episode.costs.iter().map(|one| (one.name, one.counted));
    let terms = env.cost_terms().iter().map(|term| (term.name, term.counted));
    let complete = match episode.task {
        None => reported.eq(terms),
        Some(task) => {
            episode.costs.iter().any(|one| one.name == task)
                && reported.into_iter().all(|one| terms.clone().any(|term| term == one))
        }
    };
    (!complete).then(|| "its episode does not report every cost term".to_string())
}

/// How the lanes of a batch go on after an episode's end.
#[derive(Clone, Copy)]
pub(super) struct Manner {
    pub autoreset: Autoreset,
    pub final_observations: FinalObservations,
    /// Tasks that the lanes take in turn.
    pub tasks: usize,
}

/// One environment of the batch. Its episodes follow from the batch's seed and its own number
/// alone, whatever the batch's width, the number of threads and the way of stepping.
pub(super) struct Lane {
    /// Place in the whole batch.
    pub index: usize,
    /// Number that decides its seeds.
    number: u64,
    env: Box<dyn Environment>,
    /// Its [`Environment::fingerprint`], which takes a while to compute.
    pub fingerprint: u64,
    /// What is shown beside observations.
    insight: Insight,
    /// Seeds of the episodes to come.
    seeds: Rng,
    /// The running episode: seed and actions so far, enough to repeat it.
    seed: u64,
    actions: Vec<u8>,
    deltas: Vec<f32>,
    /// Whether an episode of the lane has begun.
    begun: bool,
    /// How the running episode ended, where the next one does not follow at once.
    ended: Option<Step>,
    /// Room for statistics on their way.
    scratch: Vec<(&'static str, f64)>,
}

impl Lane {
    pub fn new(index: usize, number: u64, options: VecOptions, env: Box<dyn Environment>) -> Lane {
        // Room for an episode at frame skip 1, so that stepping never allocates.
        let (groups, deltas) = (env.action_space().groups.len(), env.action_space().deltas.len());
        let (actions, deltas) =
            (Vec::with_capacity(2104 * groups), Vec::with_capacity(2104 * deltas));
        let seeds = Rng::for_lane(options.seed, number);
        Lane {
            index,
            number,
            fingerprint: env.fingerprint(),
            env,
            insight: options.insight,
            seeds,
            seed: 0,
            begun: false,
            actions,
            deltas,
            ended: None,
            scratch: Vec::new(),
        }
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
        self.begun = true;
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
        LaneState {
            seeds: self.seeds.state(),
            seed: self.seed,
            env: self.fingerprint,
            actions,
            deltas,
        }
    }

    /// Resets the lane in the given way and shows where it is then.
    pub fn reset(&mut self, how: Restart, slices: LaneSlices) {
        match how {
            Restart::Stay => {}
            Restart::Next => self.next_episode(),
            Restart::Seed(seed) => {
                self.seeds = Rng::for_lane(seed, 0);
                self.next_episode();
            }
        }
        self.show(slices);
    }

    /// Brings the lane to a saved state by repeating its episode, and shows it.
    pub fn restore(&mut self, state: &LaneState, slices: LaneSlices) {
        self.seeds = Rng::from_state(state.seeds);
        self.start(state.seed);
        let space = self.env.action_space().clone();
        for i in 0..state.steps(&space) {
            let (actions, deltas) = state.action(i, &space);
            let step = self.advance(actions, deltas);
            self.ended = step.ended().then_some(step);
        }
        self.show(slices);
    }

    /// Writes the present, as of a step that brought nothing.
    fn show(&mut self, mut slices: LaneSlices) {
        let step = Step { reward: 0.0, cost: 0.0, ..self.ended.unwrap_or_default() };
        slices.note(step, &*self.env, false, &mut self.scratch);
        self.observe(slices.observations, slices.insight);
    }

    /// Writes what is seen, and what is shown beside it, if anything is asked for.
    fn observe(&mut self, observation: &mut [u8], insight: &mut [u8]) {
        if insight.is_empty() {
            self.env.observe(observation);
        } else {
            self.env.observe_with(observation, self.insight, insight);
        }
    }

    /// Steps the lane by its action, in its first episode if none has begun. `index` is its number within the batch.
    pub fn step(
        &mut self,
        index: usize,
        manner: Manner,
        mut slices: LaneSlices,
        outbox: &mut Outbox,
    ) {
        if !self.begun {
            self.next_episode();
        }
        let (step, moved) = match (self.ended, manner.autoreset) {
            (Some(_), Autoreset::NextStep) => {
                self.next_episode();
                (Step::default(), false)
            }
            (Some(last), _) => (Step { reward: 0.0, cost: 0.0, ..last }, false),
            (None, _) => {
                let step = self.advance(slices.actions, slices.deltas);
                if !self.env.happenings().is_empty() {
                    outbox.happenings.push((index, self.env.happenings().to_vec()));
                }
                if step.ended() {
                    self.ended = Some(step);
                    let episode = Episode { lane: self.index, ..self.env.episode() };
                    // One box may serve many lanes: the first that says so counts.
                    outbox.panic = outbox.panic.take().or_else(|| unreported(&*self.env, &episode));
                    outbox.episodes.push(episode);
                }
                (step, true)
            }
        };
        slices.note(step, &*self.env, moved, &mut self.scratch);
        if step.ended() && manner.autoreset == Autoreset::SameStep {
            let keep = manner.final_observations == FinalObservations::Every
                || (step.truncated && !step.terminated);
            if keep {
                let mut last = vec![0; slices.observations.len()];
                let mut insight = vec![0; slices.insight.len()];
                self.observe(&mut last, &mut insight);
                outbox.final_observations.push((index, last, insight));
            }
            self.next_episode();
        }
        self.observe(slices.observations, slices.insight);
    }
}
