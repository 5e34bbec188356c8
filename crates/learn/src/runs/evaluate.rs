//! Episodes of a trained policy, and what they say about return and budgets.

use std::sync::atomic::{AtomicBool, Ordering};

use hasard_envs::{Autoreset, Episode, LaneState, VecEnv, VecOptions};
use serde::{Deserialize, Serialize};

use crate::config::constraint::find_terms;
use crate::config::{Constraint, ReturnNormaliser};
use crate::error::LearnError;
use crate::learning::normaliser::Moments;
use crate::runs::agent::TrainedPolicy;
use crate::runs::session::MakeWorlds;
use crate::sampling::gather::panic_text;
use crate::statistics::{Estimate, Tails, tails};

pub use crate::runs::agent::{Action, Agent, Choice, Memory, Thought, Which, run_config};

/// Most worlds that one agent acts in side by side.
const MOST_LANES: usize = 32;

/// What the critics of the costs expected in an episode, and what came.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Trace {
    /// Discounted cost to come that each constraint's critic expected before each step; no critic where the policy has none, or where
    /// the unit of its values is not known.
    pub expected: Vec<Vec<f64>>,
    /// Cost of each step under each of these constraints.
    pub costs: Vec<Vec<f64>>,
}

/// Plays an episode of each seed, on `threads` threads, and gives them in the order of the seeds. What happens in an episode
/// follows from its seed alone.
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

/// As [`play`], each episode with what the policy's critics expected; but it gives up when `stop` is raised meanwhile: then there are no
/// episodes at all.
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
    for own in seeds.chunks(seeds.len().div_ceil(threads.max(1))) {
        // As many in each turn as divide the seeds evenly.
        let lanes = own.len().div_ceil(own.len().div_ceil(MOST_LANES));
        let options = VecOptions { lanes, autoreset: Autoreset::Disabled, ..VecOptions::default() };
        let worlds = make_worlds(&policy.config().env, options).map_err(|error| LearnError::Worlds(error.to_string()))?;
        parts.push((worlds, policy.agent(choice, lanes), own));
    }
    let mut episodes = Vec::new();
    std::thread::scope(|scope| {
        let running: Vec<_> = parts
            .into_iter()
            .map(|(worlds, agent, own)| scope.spawn(move || play_all(stop, policy, worlds, agent, own)))
            .collect();
        for thread in running {
            let played = thread.join().map_err(|panic| LearnError::Panic(panic_text("an evaluation", &*panic)))?;
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
    // One critic a constraint, after that of the reward.
    let critics = policy.cost_units();
    let worth = |moments: &Moments, value: f32| match policy.config().learning.normaliser {
        ReturnNormaliser::Running => moments.denormalise(value),
        ReturnNormaliser::PopArt => moments.scale_up(value),
    };
    let constraints = &policy.config().constraints[..critics.len().min(policy.config().constraints.len())];
    let places = find_terms(worlds.cost_terms(), constraints)?;
    for turn in seeds.chunks(lanes) {
        // A turn that is not full plays its last seed several times, and counts it once.
        let seed_of = |lane: usize| turn[lane.min(turn.len() - 1)];
        let starts = (0..lanes).map(|lane| LaneState { seed: seed_of(lane), ..LaneState::default() }).collect();
        worlds.restore(starts, &mut batch).map_err(world_error)?;
        (0..lanes).for_each(|lane| agent.reset(lane, seed_of(lane)));
        let mut ended: Vec<Option<Episode>> = vec![None; lanes];
        let blank = Trace { expected: vec![Vec::new(); places.len()], costs: vec![Vec::new(); places.len()] };
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
                    let cost = place.map_or(batch.costs[lane], |term| batch.cost_terms[lane * terms + term]);
                    let value = agent.cost_values(lane).get(index).map_or(f32::NAN, |&value| worth(moments, value));
                    traces[lane].expected[index].push(value.into());
                    traces[lane].costs[index].push(cost.into());
                }
            }
            for lane in 0..lanes {
                let own: Vec<f64> = batch.cost_terms[lane * terms..(lane + 1) * terms].iter().map(|&cost| cost.into()).collect();
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

/// A constraint and what episodes cost under it.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Judgement {
    /// Name of the cost term; `null` for the scalar cost.
    pub term: Option<String>,
    /// Cost that an episode may have.
    pub budget: f64,
    /// What it had.
    pub cost: Estimate,
    /// How it spread over the episodes.
    #[serde(default)]
    pub tails: Tails,
}

impl Judgement {
    /// Whether the mean is within the budget.
    #[must_use]
    pub fn within(&self) -> bool {
        self.cost.mean <= self.budget
    }
}

/// What some episodes of a policy came to.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Evaluation {
    /// Number of episodes.
    pub episodes: usize,
    /// Sum of rewards.
    pub episode_return: Estimate,
    /// Sum of costs.
    pub cost: Estimate,
    /// How the scalar cost spread over the episodes.
    #[serde(default)]
    pub tails: Tails,
    /// Steps.
    pub length: Estimate,
    /// Each constraint by its own term and budget.
    pub constraints: Vec<Judgement>,
}

impl Evaluation {
    /// Judges episodes; those that do not report a constraint's term are an error.
    pub fn of(episodes: &[Episode], constraints: &[Constraint]) -> Result<Evaluation, LearnError> {
        let judge = |one: &Constraint| {
            let costs: Vec<f64> = episodes.iter().map(|episode| one.cost_of(episode)).collect::<Result<_, _>>()?;
            let spread = tails(costs.iter().copied(), Some(one.budget));
            Ok(Judgement { term: one.term.clone(), budget: one.budget, cost: Estimate::of(costs), tails: spread })
        };
        Ok(Evaluation {
            episodes: episodes.len(),
            episode_return: Estimate::of(episodes.iter().map(|episode| episode.episode_return)),
            cost: Estimate::of(episodes.iter().map(|episode| episode.cost)),
            tails: tails(episodes.iter().map(|episode| episode.cost), None),
            length: Estimate::of(episodes.iter().map(|episode| f64::from(episode.length))),
            constraints: constraints.iter().map(judge).collect::<Result<_, LearnError>>()?,
        })
    }

    /// Whether every mean cost is within its budget.
    #[must_use]
    pub fn within(&self) -> bool {
        self.constraints.iter().all(Judgement::within)
    }

    /// Whether every cost is within its budget up to the upper end of its interval.
    #[must_use]
    pub fn surely_within(&self) -> bool {
        self.constraints.iter().all(|one| one.cost.high() <= one.budget)
    }

    /// How far mean costs are above their budgets, in parts of the budgets (of 1 where a budget is 0), added up.
    #[must_use]
    pub fn excess(&self) -> f64 {
        let unit = |budget: f64| if budget > 0.0 { budget } else { 1.0 };
        self.constraints.iter().map(|one| (one.cost.mean - one.budget).max(0.0) / unit(one.budget)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hasard_envs::{Scenario, episode_costs};

    fn episode(cost: f64, jumps: f64) -> Episode {
        Episode {
            lane: 0,
            seed: 0,
            episode_return: 1.0,
            cost,
            costs: episode_costs(Scenario::VolcanicVenture.cost_terms(), &[cost, jumps]),
            length: 10,
            terminated: true,
            truncated: false,
            stats: vec![],
        }
    }

    #[test]
    fn each_constraint_is_judged_by_its_own_term_and_budget() {
        let constraints = [Constraint { term: None, budget: 50.0 }, Constraint { term: Some("jumps".into()), budget: 4.0 }];
        let judged = Evaluation::of(&[episode(20.0, 6.0), episode(40.0, 4.0)], &constraints).unwrap();
        assert_eq!((judged.cost.mean, judged.constraints[0].cost.mean, judged.constraints[1].cost.mean), (30.0, 30.0, 5.0));
        assert!(judged.constraints[0].within() && !judged.constraints[1].within() && !judged.within());
        assert!((judged.excess() - 0.25).abs() < 1e-12);
        // Half of the episodes have more than 4 jumps; one costs 40.
        assert_eq!((judged.constraints[1].tails.over_budget, judged.tails.worst), (Some(0.5), 40.0));
        // Half the interval of 30 and 31: 12.706 * 0.5 = 6.35.
        let judged = Evaluation::of(&[episode(30.0, 1.0), episode(31.0, 1.0)], &constraints).unwrap();
        assert!(judged.within() && judged.surely_within());
        let wide = Evaluation::of(&[episode(44.0, 1.0), episode(46.0, 1.0)], &constraints).unwrap();
        assert!(wide.within() && !wide.surely_within());
    }
}
