//! Which checkpoint a run hands out: the best evaluated one within its budgets.
//!
//! While it learns, a policy wanders in and out of its budgets, and the episodes that it learned from say little about a single
//! checkpoint. So the policy is evaluated now and then on episodes of their own; one that keeps its budgets and returns more
//! than the best so far must prove itself on further episodes. What they are worth in the end is said by a third set of
//! episodes, which had no part in the choice.

use std::sync::atomic::AtomicBool;

use serde::{Deserialize, Serialize};

use crate::config::{AlgorithmKind, TrainConfig};
use crate::error::LearnError;
use crate::learning::learner::Learner;
use crate::networks::device::ComputeDevice;
use crate::random::{Purpose, Stream};
use crate::runs::agent::{Choice, TrainedPolicy};
use crate::runs::checkpoint::Loaded;
use crate::runs::evaluate::{Evaluation, play_unless};
use crate::runs::session::{MakeWorlds, Session};

/// A checkpoint worth handing out, and the episodes that say so.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct HandOut {
    /// Frames after which it was taken.
    pub frames: u64,
    /// The episodes that it was chosen by.
    pub chosen_by: Evaluation,
    /// They are further episodes than those that made it a candidate.
    pub confirmed: bool,
    /// Episodes that had no part in the choice, played when the run was over.
    pub closing: Option<Evaluation>,
}

impl HandOut {
    /// The latest word on it.
    #[must_use]
    pub fn evaluation(&self) -> &Evaluation {
        self.closing.as_ref().unwrap_or(&self.chosen_by)
    }

    /// Whether it is to be preferred. Of algorithms that keep budgets, one that surely keeps them comes before one that
    /// seems to, and that before the others; then the return decides, or among those over a budget the excess.
    #[must_use]
    pub fn is_better_than(&self, other: &HandOut, algorithm: AlgorithmKind) -> bool {
        let (own, theirs) = (&self.chosen_by, &other.chosen_by);
        let returns_more = own.episode_return.mean > theirs.episode_return.mean;
        if !algorithm.keeps_budgets() {
            return returns_more;
        }
        match (self.safety(), other.safety()) {
            (0, 0) => own.excess() < theirs.excess(),
            (a, b) if a == b => returns_more,
            (a, b) => a > b,
        }
    }

    fn safety(&self) -> u8 {
        match (self.chosen_by.surely_within(), self.chosen_by.within()) {
            (true, _) if self.confirmed => 2,
            (_, true) => 1,
            _ => 0,
        }
    }
}

/// The sets of episodes: their seeds have nothing in common.
#[derive(Clone, Copy)]
enum Set {
    Candidates = 0,
    Confirmation = 1,
    Closing = 2,
}

/// Evaluates a session's policy, and remembers the best.
pub struct Examiner<'a> {
    make_worlds: &'a MakeWorlds<'a>,
    /// The best so far.
    pub best: Option<HandOut>,
}

impl<'a> Examiner<'a> {
    /// An examiner who remembers the best of a run that goes on.
    #[must_use]
    pub fn new(make_worlds: &'a MakeWorlds<'a>, best: Option<HandOut>) -> Examiner<'a> {
        Examiner { make_worlds, best }
    }

    /// Evaluates the session's policy as it is, and says whether it is the best so far; `counts` is false where none can be,
    /// as in the lessons before the last. Nothing, and nothing remembered, if `stop` is raised meanwhile.
    pub fn examine(
        &mut self,
        session: &mut Session,
        counts: bool,
        stop: &AtomicBool,
    ) -> Result<Option<(Evaluation, bool)>, LearnError> {
        let published = session.learner.publish();
        let device = ComputeDevice::of(&session.config)?;
        let policy = TrainedPolicy::new(&session.config, session.learner.shape(), published, device, session.cost_terms)?;
        let settings = session.config.evaluation.clone();
        let Some(evaluation) = self.play(stop, &policy, session.frames, Set::Candidates, settings.episodes)? else {
            return Ok(None);
        };
        let candidate = HandOut { frames: session.frames, chosen_by: evaluation.clone(), confirmed: false, closing: None };
        if !counts || !self.is_worth_confirming(&candidate, session.config.algorithm) {
            return Ok(Some((evaluation, false)));
        }
        let confirmed = if evaluation.within() || !session.config.algorithm.keeps_budgets() {
            let episodes = settings.confirming_episodes;
            let Some(chosen_by) = self.play(stop, &policy, session.frames, Set::Confirmation, episodes)? else {
                return Ok(None);
            };
            HandOut { chosen_by, confirmed: true, ..candidate }
        } else {
            // Nothing to be sure of: it is the least evil so far.
            candidate
        };
        let best = self.best.as_ref().is_none_or(|best| confirmed.is_better_than(best, session.config.algorithm));
        if best {
            self.best = Some(confirmed);
        }
        Ok(Some((evaluation, best)))
    }

    /// Whether further episodes could make a candidate the best.
    fn is_worth_confirming(&self, candidate: &HandOut, algorithm: AlgorithmKind) -> bool {
        let Some(best) = &self.best else { return true };
        let returns_more = candidate.chosen_by.episode_return.mean > best.chosen_by.episode_return.mean;
        match (algorithm.keeps_budgets(), candidate.chosen_by.within()) {
            (false, _) => returns_more,
            (true, true) => returns_more || best.safety() < 2,
            (true, false) => candidate.is_better_than(best, algorithm),
        }
    }

    /// Plays the closing episodes of the checkpoint that the run hands out. False if `stop` is raised meanwhile.
    pub fn close(&mut self, session: &Session, checkpoint: &Loaded, stop: &AtomicBool) -> Result<bool, LearnError> {
        let Some(best) = &self.best else { return Ok(true) };
        let device = ComputeDevice::of(&session.config)?;
        let mut learner = Learner::new(&session.config, session.learner.shape(), &device);
        checkpoint.restore_weights(&mut learner)?;
        let shape = session.learner.shape();
        let policy = TrainedPolicy::new(&session.config, shape, learner.publish(), device, session.cost_terms)?;
        let episodes = session.config.evaluation.confirming_episodes;
        let Some(closing) = self.play(stop, &policy, best.frames, Set::Closing, episodes)? else { return Ok(false) };
        self.best = self.best.take().map(|best| HandOut { closing: Some(closing), ..best });
        Ok(true)
    }

    fn play(
        &self,
        stop: &AtomicBool,
        policy: &TrainedPolicy,
        frames: u64,
        set: Set,
        episodes: usize,
    ) -> Result<Option<Evaluation>, LearnError> {
        let config: &TrainConfig = policy.config();
        let seed = |episode: usize| {
            let number = (set as u64) << 32 | episode as u64;
            Stream::new(config.seed, Purpose::EvaluatedWorlds, frames, number).bits()
        };
        let seeds: Vec<u64> = (0..episodes).map(seed).collect();
        let played = play_unless(stop, policy, Choice::Sampled, self.make_worlds, &seeds, config.learning.threads)?;
        played.map(|played| Evaluation::of(&played, &config.constraints)).transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::runs::evaluate::{Estimate, Judgement};

    fn hand_out(episode_return: f64, cost: f64, half_width: f64, confirmed: bool) -> HandOut {
        let cost = Estimate { mean: cost, half_width };
        let chosen_by = Evaluation {
            episodes: 100,
            episode_return: Estimate { mean: episode_return, half_width: 1.0 },
            cost,
            length: Estimate::default(),
            constraints: vec![Judgement { term: None, budget: 50.0, cost }],
        };
        HandOut { frames: 1, chosen_by, confirmed, closing: None }
    }

    #[test]
    fn safety_comes_before_return() {
        let order = [
            hand_out(20.0, 45.0, 2.0, true),
            hand_out(15.0, 45.0, 2.0, true),
            // Within the budget, but not up to the interval's end; or not confirmed.
            hand_out(30.0, 49.0, 2.0, true),
            hand_out(25.0, 40.0, 2.0, false),
            hand_out(10.0, 51.0, 2.0, true),
            hand_out(40.0, 60.0, 2.0, true),
        ];
        for (index, better) in order.iter().enumerate() {
            for worse in &order[index + 1..] {
                assert!(better.is_better_than(worse, AlgorithmKind::PpoLag), "{better:?} {worse:?}");
                assert!(!worse.is_better_than(better, AlgorithmKind::PpoLag), "{better:?} {worse:?}");
            }
        }
        // An algorithm without budgets is after the return.
        assert!(order[5].is_better_than(&order[0], AlgorithmKind::Ppo));
    }
}
