//! Who evaluates the policies of a run and keeps the candidates among them.

use std::sync::atomic::AtomicBool;

use hasard_envs::Episode;

use crate::config::TrainConfig;
use crate::error::LearnError;
use crate::learning::learner::Learner;
use crate::networks::device::ComputeDevice;
use crate::random::{Purpose, Stream};
use crate::runs::agent::{Choice, TrainedPolicy};
use crate::runs::checkpoint::{Loaded, Store};
use crate::runs::evaluate::play_traced;
use crate::runs::evaluation::{Closing, Evaluation, Trace};
use crate::runs::selection::{Candidate, Candidates, EpisodeSet, Selection, frames_of, select};
use crate::runs::session::{MakeWorlds, Session};

/// Evaluates a session's policies, and remembers the candidates.
pub struct Examiner<'a> {
    make_worlds: &'a MakeWorlds<'a>,
    /// The candidates so far.
    pub candidates: Candidates,
}

impl<'a> Examiner<'a> {
    /// An examiner who remembers the candidates of a run that goes on.
    #[must_use]
    pub fn new(make_worlds: &'a MakeWorlds<'a>, candidates: Candidates) -> Examiner<'a> {
        Examiner { make_worlds, candidates }
    }

    /// Evaluates the session's policy as it is, and says whether it is a candidate; `counts` is
    /// false where none can be, as in the lessons before the last. Nothing, and nothing remembered,
    /// if `stop` is raised meanwhile.
    pub fn examine(
        &mut self,
        session: &mut Session,
        counts: bool,
        stop: &AtomicBool,
    ) -> Result<Option<(Evaluation, bool)>, LearnError> {
        let policy = policy_of(session)?;
        let config = &session.config;
        let Some(played) =
            self.play(stop, &policy, EpisodeSet::Candidates, config.evaluation.episodes)?
        else {
            return Ok(None);
        };
        let episodes: Vec<Episode> = played.into_iter().map(|(episode, _)| episode).collect();
        self.candidates.frames += frames_of(&episodes, config);
        let evaluation = Evaluation::of(&episodes, &config.constraints)?;
        let candidate = Candidate::new(session.frames, evaluation.clone());
        let kept = counts
            && self.candidates.add(
                candidate,
                config.algorithm,
                config.evaluation.candidates.max(1),
            );
        Ok(Some((evaluation, kept)))
    }

    /// Selects a checkpoint when the run is over, with the closing episodes of it and of the last
    /// policy. Nothing without candidates, or if `stop` is raised meanwhile.
    pub fn close(
        &self,
        session: &mut Session,
        store: &Store,
        stop: &AtomicBool,
    ) -> Result<Option<(Selection, Vec<Closing>)>, LearnError> {
        let last = policy_of(session)?;
        let (config, frames) = (session.config.clone(), session.frames);
        let device = ComputeDevice::of(&config)?;
        let mut loaded: Option<(u64, TrainedPolicy)> = None;
        let mut closings: Vec<Closing> = Vec::new();
        let mut last_played = None;
        let mut play = |policy: Option<u64>, set: EpisodeSet, episodes: usize| {
            if let Some(frames) = policy
                && loaded.as_ref().is_none_or(|(known, _)| *known != frames)
            {
                let checkpoint = Loaded::read(&store.best_of(frames))?;
                let mut learner = Learner::new(&config, session.learner.shape(), &device);
                checkpoint.restore_weights(&mut learner)?;
                let returns = learner.returns.clone();
                let shape = session.learner.shape();
                let policy = TrainedPolicy::new(
                    &config,
                    shape,
                    learner.publish(),
                    device.clone(),
                    session.cost_terms,
                )?;
                loaded = Some((frames, policy.in_units_of(&returns)));
            }
            let acting =
                loaded.as_ref().filter(|_| policy.is_some()).map_or(&last, |(_, policy)| policy);
            let Some(played) = self.play(stop, acting, set, episodes)? else { return Ok(None) };
            let only: Vec<Episode> = played.iter().map(|(episode, _)| episode.clone()).collect();
            if set == EpisodeSet::Closing(0) && policy.is_some() {
                last_played = Some((frames, played.clone()));
            }
            if matches!(set, EpisodeSet::Closing(_)) {
                closings.push(Closing {
                    frames: policy.unwrap_or(frames),
                    selected: policy.is_some(),
                    played,
                });
            }
            Ok(Some(only))
        };
        let Some(selection) = select(&self.candidates, &config, frames, &mut play)? else {
            return Ok(None);
        };
        closings.retain(|one| !one.selected || one.frames == selection.selected.frames);
        // A closing of both is written down for both; one of a last policy that failed there is
        // that policy's alone.
        if closings.iter().all(|one| one.selected)
            && let Some((frames, played)) = last_played
        {
            closings.push(Closing { frames, selected: false, played });
        }
        Ok(Some((selection, closings)))
    }

    /// A set of episodes is the same for every policy of the run that plays it: what differs is the
    /// policy alone.
    fn play(
        &self,
        stop: &AtomicBool,
        policy: &TrainedPolicy,
        set: EpisodeSet,
        episodes: usize,
    ) -> Result<Option<Vec<(Episode, Trace)>>, LearnError> {
        let config: &TrainConfig = policy.config();
        let seeds = seeds_of(config.seed, set, episodes);
        play_traced(
            stop,
            policy,
            Choice::Sampled,
            self.make_worlds,
            &seeds,
            config.learning.threads,
        )
    }
}

/// Seeds of the episodes of a set, in the run of a seed.
fn seeds_of(run: u64, set: EpisodeSet, episodes: usize) -> Vec<u64> {
    (0..episodes as u64)
        .map(|episode| Stream::new(run, Purpose::EvaluatedWorlds, set.number(), episode).bits())
        .collect()
}

/// The session's policy as it is.
fn policy_of(session: &mut Session) -> Result<TrainedPolicy, LearnError> {
    let published = session.learner.publish();
    let device = ComputeDevice::of(&session.config)?;
    let policy = TrainedPolicy::new(
        &session.config,
        session.learner.shape(),
        published,
        device,
        session.cost_terms,
    )?;
    Ok(policy.in_units_of(&session.learner.returns))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hasard_engine::math::Rng;

    /// A policy picked for its luck in some episodes would be as lucky again in the same ones: those
    /// that pick candidates, those that confirm, those of each closing and those of training are
    /// all different.
    #[test]
    fn no_episode_is_of_two_sets() {
        let sets = [
            EpisodeSet::Candidates,
            EpisodeSet::Confirmation,
            EpisodeSet::Closing(0),
            EpisodeSet::Closing(1),
            EpisodeSet::Closing(4),
        ];
        let mut all: Vec<u64> = sets.iter().flat_map(|&set| seeds_of(7, set, 200)).collect();
        // As a batch of worlds deals them to its lanes.
        let training = Stream::new(7, Purpose::Worlds, 0, 0).bits();
        for lane in 0..32 {
            let mut seeds = Rng::for_lane(training, lane);
            all.extend((0..200).map(|_| seeds.next_u64()));
        }
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!((count, all.len()), (7400, 7400));
    }
}
