//! Episodes of a trained policy.

use std::sync::atomic::{AtomicBool, Ordering};

use hasard_envs::{Autoreset, Episode, LaneState, VecEnv, VecOptions};

use crate::config::ReturnNormaliser;
use crate::config::constraint::find_terms;
use crate::error::LearnError;
use crate::learning::normaliser::Moments;
use crate::runs::agent::TrainedPolicy;
use crate::runs::session::MakeWorlds;
use crate::sampling::gather::panic_text;

pub use crate::runs::agent::{Action, Agent, Choice, Memory, Thought, Which, run_config};
pub use crate::runs::evaluation::{Evaluation, Judgement, TaskEvaluation, Trace};

/// Most worlds that one agent acts in side by side.
const MOST_LANES: usize = 32;

/// Plays an episode of each seed, on `threads` threads, and gives them in the order of the seeds.
/// What happens in an episode follows from its seed alone; of several tasks, the episodes have one
/// after the other, whatever the number of threads.
pub fn play(
    policy: &TrainedPolicy,
    choice: Choice,
    make_worlds: &MakeWorlds<'_>,
    seeds: &[u64],
    threads: usize,
) -> Result<Vec<Episode>, LearnError> {
    let played = play_traced(&AtomicBool::new(false), policy, choice, make_worlds, seeds, threads)?;
    Ok(played.unwrap_or_default().into_iter().map(|(episode, _)| episode).collect())
}

/// As [`play`], each episode with what the policy's critics expected; but it gives up when `stop`
/// is raised meanwhile: then there are no episodes at all.
pub fn play_traced(
    stop: &AtomicBool,
    policy: &TrainedPolicy,
    choice: Choice,
    make_worlds: &MakeWorlds<'_>,
    seeds: &[u64],
    threads: usize,
) -> Result<Option<Vec<(Episode, Trace)>>, LearnError> {
    if seeds.is_empty() {
        return Ok(Some(Vec::new()));
    }
    let mut parts = Vec::new();
    let tasks = policy.config().env.id.split(',').count();
    let chunk = seeds.len().div_ceil(threads.max(1)).next_multiple_of(tasks);
    for own in seeds.chunks(chunk) {
        // As many in each turn as divide the seeds evenly, and so that a lane's task is its
        // episode's.
        let lanes = own.len().div_ceil(own.len().div_ceil(MOST_LANES)).next_multiple_of(tasks);
        let options = VecOptions { lanes, autoreset: Autoreset::Disabled, ..VecOptions::default() };
        let worlds = make_worlds(&policy.config().env, options)
            .map_err(|error| LearnError::Worlds(error.to_string()))?;
        parts.push((worlds, policy.agent(choice, lanes), own));
    }
    let mut episodes = Vec::new();
    std::thread::scope(|scope| {
        let running: Vec<_> = parts
            .into_iter()
            .map(|(worlds, agent, own)| {
                let all = move || play_all(stop, policy, worlds, agent, own);
                std::thread::Builder::new().spawn_scoped(scope, all).map_err(LearnError::Thread)
            })
            .collect();
        for thread in running {
            let played = thread?
                .join()
                .map_err(|panic| LearnError::Panic(panic_text("an evaluation", &*panic)))?;
            episodes.push(played?);
        }
        Ok(episodes.into_iter().collect::<Option<Vec<_>>>().map(|parts| parts.concat()))
    })
}

fn play_all(
    stop: &AtomicBool,
    policy: &TrainedPolicy,
    mut worlds: VecEnv,
    mut agent: Agent,
    seeds: &[u64],
) -> Result<Option<Vec<(Episode, Trace)>>, LearnError> {
    let world_error = |error: hasard_envs::EnvError| LearnError::Worlds(error.to_string());
    let (lanes, terms) = (worlds.lanes(), worlds.cost_terms().len());
    let mut batch = worlds.whole_batch();
    let mut all = Vec::with_capacity(seeds.len());
    // One critic a constraint, after that of the reward; in a world that is none of the several
    // tasks, their constraints say nothing.
    let alone = policy.config().env.is_mixed() && worlds.tasks().is_empty();
    let critics = if alone { &[] } else { policy.cost_units() };
    let worth = |moments: &Moments, value: f32| match policy.config().learning.normaliser {
        ReturnNormaliser::Running => moments.denormalise(value),
        ReturnNormaliser::PopArt => moments.scale_up(value),
    };
    let constraints =
        &policy.config().constraints[..critics.len().min(policy.config().constraints.len())];
    let places = find_terms(worlds.cost_terms(), constraints)?;
    for turn in seeds.chunks(lanes) {
        // A turn that is not full plays its last seed several times, and counts it once.
        let seed_of = |lane: usize| turn[lane.min(turn.len() - 1)];
        let starts = (0..lanes)
            .map(|lane| LaneState { seed: seed_of(lane), ..LaneState::default() })
            .collect();
        worlds.restore(starts, &mut batch).map_err(world_error)?;
        (0..lanes).for_each(|lane| agent.reset(lane, seed_of(lane)));
        let mut ended: Vec<Option<Episode>> = vec![None; lanes];
        let blank = Trace {
            expected: vec![Vec::new(); places.len()],
            costs: vec![Vec::new(); places.len()],
        };
        let mut traces = vec![blank; lanes];
        while ended.iter().any(Option::is_none) {
            if stop.load(Ordering::Relaxed) {
                return Ok(None);
            }
            let (actions, deltas) = (&mut batch.actions[..], &mut batch.deltas[..]);
            let (count, continuous) = (actions.len() / lanes, deltas.len() / lanes);
            for (lane, action) in agent.act(&batch.observations).into_iter().enumerate() {
                actions[lane * count..(lane + 1) * count].copy_from_slice(&action.actions);
                deltas[lane * continuous..(lane + 1) * continuous].copy_from_slice(&action.deltas);
            }
            worlds.step(&mut batch).map_err(world_error)?;
            for lane in (0..lanes).filter(|&lane| ended[lane].is_none()) {
                for (index, (place, moments)) in places.iter().zip(critics).enumerate() {
                    let cost = place
                        .map_or(batch.costs[lane], |term| batch.cost_terms[lane * terms + term]);
                    let value = agent
                        .cost_values(lane)
                        .get(index)
                        .map_or(f32::NAN, |&value| worth(moments, value));
                    traces[lane].expected[index].push(value.into());
                    traces[lane].costs[index].push(cost.into());
                }
            }
            for lane in 0..lanes {
                let own: Vec<f64> = batch.cost_terms[lane * terms..(lane + 1) * terms]
                    .iter()
                    .map(|&cost| cost.into())
                    .collect();
                agent.observe_cost(lane, batch.costs[lane].into(), &own);
            }
            for episode in batch.episodes.drain(..) {
                let lane = episode.lane;
                // Which world of which agent it was in, says nothing about it.
                ended[lane] = Some(Episode { lane: 0, ..episode });
            }
        }
        all.extend(ended.into_iter().flatten().zip(traces).take(turn.len()));
    }
    Ok(Some(all))
}
