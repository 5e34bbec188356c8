//! Rollouts of several workers: every worker gets what the others' samplers brought, but for the
//! pixels.

use hasard_envs::{Episode, EpisodeCost, LaneState};
use serde::{Deserialize, Serialize};

use crate::error::LearnError;
use crate::networks::{ModelShape, Recording};
use crate::sampling::rollout::{Part, Rollout};
use crate::sampling::sampler::SamplerState;
use crate::team::Team;

/// An episode as it is sent: its names are looked up again among those of the receiver's worlds.
#[derive(Serialize, Deserialize)]
struct Sent {
    step: usize,
    lane: usize,
    task: Option<String>,
    seed: u64,
    episode_return: f64,
    cost: f64,
    costs: Vec<(String, bool, f64)>,
    length: u32,
    terminated: bool,
    truncated: bool,
    stats: Vec<(String, f64)>,
}

type Named = Vec<(&'static str, f64)>;

impl Sent {
    fn new((step, episode): &(usize, Episode)) -> Sent {
        let named = |values: &Named| {
            values.iter().map(|(name, value)| ((*name).to_string(), *value)).collect()
        };
        Sent {
            step: *step,
            lane: episode.lane,
            task: episode.task.map(str::to_string),
            seed: episode.seed,
            episode_return: episode.episode_return,
            cost: episode.cost,
            costs: episode
                .costs
                .iter()
                .map(|one| (one.name.to_string(), one.counted, one.cost))
                .collect(),
            length: episode.length,
            terminated: episode.terminated,
            truncated: episode.truncated,
            stats: named(&episode.stats),
        }
    }

    fn episode(self, names: &[&'static str]) -> Option<(usize, Episode)> {
        let known = |name: String| names.iter().find(|own| **own == name).copied();
        let named = |values: Vec<(String, f64)>| -> Option<Named> {
            values.into_iter().map(|(name, value)| Some((known(name)?, value))).collect()
        };
        let cost = |(name, counted, cost)| Some(EpisodeCost { name: known(name)?, counted, cost });
        let episode = Episode {
            task: self.task.map(|task| known(task).ok_or(())).transpose().ok()?,
            lane: self.lane,
            seed: self.seed,
            episode_return: self.episode_return,
            cost: self.cost,
            costs: self.costs.into_iter().map(cost).collect::<Option<_>>()?,
            length: self.length,
            terminated: self.terminated,
            truncated: self.truncated,
            stats: named(self.stats)?,
        };
        Some((self.step, episode))
    }
}

/// What a sampler is sent as.
type SentSampler = (Vec<u8>, Vec<Vec<f32>>, Vec<f64>, Vec<f64>, u64);

fn misfit() -> LearnError {
    LearnError::Team(
        "a worker plays other worlds; start all workers from one version of hasard".into(),
    )
}

/// The rollout of all workers, of which one has its own samplers' parts. `names` are those of cost
/// terms and statistics.
pub fn complete(
    team: &Team,
    shape: &ModelShape,
    names: &[&'static str],
    own: Rollout,
) -> Result<Rollout, LearnError> {
    if team.is_alone() {
        return Ok(own);
    }
    let episodes: Vec<Vec<Sent>> =
        own.parts.iter().map(|part| part.episodes.iter().map(Sent::new).collect()).collect();
    let bytes = postcard::to_allocvec(&(&own.parts, episodes)).map_err(|_| misfit())?;
    let (all, mut mine) = (team.gather(bytes)?, Some(own));
    let mut whole = Rollout { parts: Vec::new() };
    for (rank, bytes) in all.into_iter().enumerate() {
        if rank == team.rank() {
            whole.parts.extend(mine.take().into_iter().flat_map(|own| own.parts));
            continue;
        }
        let (parts, episodes): (Vec<Part>, Vec<Vec<Sent>>) =
            postcard::from_bytes(&bytes).map_err(|_| misfit())?;
        for (mut part, episodes) in parts.into_iter().zip(episodes) {
            let named = episodes.into_iter().map(|sent| sent.episode(names)).collect::<Option<_>>();
            part.episodes = named.ok_or_else(misfit)?;
            part.initial_state = shape.zero_state(part.lanes * part.trajectories());
            // As many as the parts here have, so that those of a lane are found by its number.
            part.recordings = vec![Recording::default(); shape.networks.len()];
            whole.parts.push(part);
        }
    }
    if whole.parts.iter().any(|part| part.steps != whole.parts[0].steps) {
        return Err(misfit());
    }
    Ok(whole)
}

/// Where the samplers of all workers are.
pub fn all_states(team: &Team, own: Vec<SamplerState>) -> Result<Vec<SamplerState>, LearnError> {
    if team.is_alone() {
        return Ok(own);
    }
    let pack = |one: SamplerState| -> SentSampler {
        (LaneState::to_bytes(&one.worlds), one.state, one.safety, one.spent, one.steps)
    };
    let sent: Vec<SentSampler> = own.into_iter().map(pack).collect();
    let bytes = postcard::to_allocvec(&sent).map_err(|_| misfit())?;
    let mut states = Vec::new();
    for bytes in team.gather(bytes)? {
        let sent: Vec<SentSampler> = postcard::from_bytes(&bytes).map_err(|_| misfit())?;
        for (worlds, state, safety, spent, steps) in sent {
            let worlds = LaneState::from_bytes(&worlds).map_err(|_| misfit())?;
            states.push(SamplerState { worlds, state, safety, spent, steps });
        }
    }
    Ok(states)
}
