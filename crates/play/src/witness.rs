//! Witnesses: episodes of positive return at cost 0, found by search. The paper says that costs can
//! always be avoided; a witness shows it.
//!
//! The search goes through an episode in chunks of steps. From a saved moment it tries many random
//! ways, keeps those that cost nothing, and goes on with the one that earns most; where every way
//! costs, it goes back to an earlier moment. All of it follows from the seed.

use crate::{PlayError, Recorder};
use hasard_engine::math::Rng;
use hasard_envs::{Env, Move, Policy, PolicyRun, Scenario, Snapshot};
use hasard_media::episode::EpisodeFile;

/// Lane number of the search's random stream.
const SEARCH_STREAM: u64 = 0x7769_746e;
/// Steps of a chunk: longer than what is done now takes to show its cost (a rocket flies 9 steps, a
/// barrel bursts after 4).
const CHUNK: usize = 14;
/// A carrier's episode is a single way, so that many more are tried.
const CARRIER_SEEDS: u64 = 25;
/// Longest hold of a drawn action, steps.
const LONGEST_HOLD: u32 = 8;

/// How hard a search tries.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Ways tried from each moment.
    pub ways: u32,
    /// Episodes tried, from the first seed on.
    pub seeds: u32,
    /// Chunks tried in an episode, those after going back included.
    pub chunks: u32,
}

impl Default for Effort {
    fn default() -> Effort {
        Effort { ways: 40, seeds: 40, chunks: 200 }
    }
}

type Action = (Vec<u8>, Vec<f32>);

/// Looks for an episode of positive return at cost 0, from `first_seed` on, and records the first
/// that is found.
///
/// # Errors
/// When the episode cannot be recorded.
pub fn search(
    env: &mut Env,
    first_seed: u64,
    effort: Effort,
) -> Result<Option<EpisodeFile>, PlayError> {
    let by_carrier = env.id().scenario == Scenario::ArmamentBurden;
    let seeds = u64::from(effort.seeds) * if by_carrier { CARRIER_SEEDS } else { 1 };
    for seed in (0..seeds).map(|i| first_seed.wrapping_add(i)) {
        let way = if by_carrier { carried(env, seed) } else { walked(env, seed, effort) };
        let Some(actions) = way else { continue };
        let mut recorder = Recorder::begin(env, seed, "witness")?;
        for (groups, deltas) in &actions {
            recorder.push(groups, deltas)?;
            env.step(groups, deltas).map_err(PlayError::from)?;
        }
        let episode = env.episode();
        if episode.cost == 0.0
            && episode.episode_return > 0.0
            && (episode.terminated || episode.truncated)
        {
            return Ok(Some(recorder.finish(env)));
        }
    }
    Ok(None)
}

/// The scripted carrier's episode, where it costs nothing: chance seldom lifts a weapon and brings
/// it home as well.
fn carried(env: &mut Env, seed: u64) -> Option<Vec<Action>> {
    env.reset(seed);
    let mut run = PolicyRun::new(Policy::Carrier, env, seed).ok()?;
    let mut actions = Vec::new();
    loop {
        let action = match run.next_move(env) {
            Move::Buttons(command) => env.action_space().action_of(command)?,
            Move::Action(groups, deltas) => (groups.to_vec(), deltas.to_vec()),
        };
        let step = env.step(&action.0, &action.1).ok()?;
        actions.push(action);
        if step.cost != 0.0 {
            return None;
        }
        if step.ended() {
            return Some(actions);
        }
    }
}

fn on_the_ground(env: &Env) -> bool {
    let world = env.world();
    world.get(world.players[0].actor).is_some_and(|body| body.z <= body.floor_z)
}

/// A moment of the way, and how many actions led there.
struct Moment {
    snapshot: Snapshot,
    actions: usize,
}

/// A way through the episode of a seed that never costs, chunk by chunk.
fn walked(env: &mut Env, seed: u64, effort: Effort) -> Option<Vec<Action>> {
    env.reset(seed);
    let mut rng = Rng::for_lane(seed, SEARCH_STREAM);
    let sizes = env.action_space().sizes();
    let continuous = env.action_space().deltas.len();
    let mut way: Vec<Action> = Vec::new();
    let mut moments = vec![Moment { snapshot: env.snapshot(), actions: 0 }];
    let (mut chunks, mut failures) = (0, 0);
    while chunks < effort.chunks {
        chunks += 1;
        let moment = moments.last()?;
        let mut best: Option<(f64, Vec<Action>, Snapshot)> = None;
        for _ in 0..effort.ways {
            env.restore(&moment.snapshot).ok()?;
            let before = env.episode().episode_return;
            let hold = 1 + rng.below(LONGEST_HOLD);
            let mut chunk: Vec<Action> = Vec::new();
            let mut free = true;
            for step in 0..CHUNK as u32 {
                let action = match chunk.last() {
                    Some(last) if !step.is_multiple_of(hold) => last.clone(),
                    _ => (
                        sizes.iter().map(|&size| rng.below(size as u32) as u8).collect(),
                        vec![0.0; continuous],
                    ),
                };
                let outcome = env.step(&action.0, &action.1).ok()?;
                chunk.push(action);
                free = outcome.cost == 0.0;
                if !free || outcome.ended() {
                    break;
                }
            }
            let gain = env.episode().episode_return - before;
            // The cost of a fall comes with its landing.
            let settled = env.id().scenario != Scenario::PrecipicePlunge || on_the_ground(env);
            if free && settled && best.as_ref().is_none_or(|(most, ..)| gain > *most) {
                best = Some((gain, chunk, env.snapshot()));
            }
        }
        if let Some((_, chunk, snapshot)) = best {
            way.extend(chunk);
            env.restore(&snapshot).ok()?;
            let episode = env.episode();
            if episode.terminated || episode.truncated {
                return (episode.episode_return > 0.0).then_some(way);
            }
            moments.push(Moment { snapshot, actions: way.len() });
            failures = 0;
        } else {
            // Back by one chunk, then two, then four: what costs now may have been done long
            // before.
            failures += 1;
            for _ in 0..1usize << usize::min(failures - 1, 4) {
                if moments.len() > 1 {
                    moments.pop();
                }
            }
            way.truncate(moments.last()?.actions);
        }
    }
    None
}
