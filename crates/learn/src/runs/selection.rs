//! Which checkpoint a run selects: of those that keep the budgets, the one that returns most.
//!
//! While it learns, a policy wanders in and out of its budgets, and the episodes that it learned
//! from say little about a single checkpoint. So it is evaluated now and then on episodes of their
//! own, always the same ones, so that candidates are compared on equal terms. When the run is over,
//! the candidates that kept their budgets are confirmed on further episodes, the one of the highest
//! return first, and the first that keeps them there too is closed on a third set. A candidate that
//! fails there gives way to the next one, with new episodes: so a closing within the budget is, of
//! policies at the very budget, slightly too good. (Of five candidates whose true cost is 51 of 50,
//! with a deviation of 20 and 100 episodes, one comes out within in 44 % of runs, the first alone in
//! 31 %.) What the last policy shows, and *surely within*, have no such part in a choice.
//! The last policy is closed as well: it is what a run is without any choice. Where it is the
//! selected one, its closing is that of both.
//!
//! A checkpoint is *surely* within its budgets if the upper end of its confirmed cost is, at a
//! level shared out over all confirmations that a run may make (Bonferroni), so that it does not get
//! easier to earn the more candidates are tried. An interval knows the costs that its episodes had:
//! of a cost so rare that none of them met it, no bound of a mean says anything. With 100 episodes of
//! which 3 % cost 200, 5 % of samples hold none of them.

use hasard_envs::Episode;
use serde::{Deserialize, Serialize};

use crate::config::{AlgorithmKind, Constraint, EvaluationConfig, TrainConfig};
use crate::error::LearnError;
use crate::runs::evaluation::Evaluation;
use crate::statistics::upper_bound;

/// Probability that some checkpoint of a run is called surely within its budgets and is not.
const ERROR: f64 = 0.025;

/// A checkpoint and the episodes that speak for it.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Candidate {
    /// Frames after which it was taken.
    pub frames: u64,
    /// The episodes that it was chosen by: those of all candidates, or those that confirmed it.
    pub chosen_by: Evaluation,
    /// They are further episodes than those that made it a candidate.
    pub confirmed: bool,
    /// It keeps its budgets by its confirmation at the level shared out.
    #[serde(default)]
    pub surely_within: bool,
    /// Episodes played when the run was over. A candidate that is over its budgets there gives way.
    pub closing: Option<Evaluation>,
}

impl Candidate {
    /// A checkpoint and its first evaluation.
    #[must_use]
    pub fn new(frames: u64, chosen_by: Evaluation) -> Candidate {
        Candidate { frames, chosen_by, confirmed: false, surely_within: false, closing: None }
    }

    /// The latest word on it.
    #[must_use]
    pub fn evaluation(&self) -> &Evaluation {
        self.closing.as_ref().unwrap_or(&self.chosen_by)
    }

    /// Whether it is to be preferred. Of algorithms that keep budgets, one within all of them comes
    /// before the others; among those the return decides, among those over a budget the excess.
    #[must_use]
    pub fn is_better_than(&self, other: &Candidate, algorithm: AlgorithmKind) -> bool {
        let (own, theirs) = (self.evaluation(), other.evaluation());
        let returns_more = own.episode_return.mean > theirs.episode_return.mean;
        match (algorithm.keeps_budgets(), own.within(), theirs.within()) {
            (false, ..) | (true, true, true) => returns_more,
            (true, false, false) => own.excess() < theirs.excess(),
            (true, own, _) => own,
        }
    }
}

/// The candidates of a run, the best first, and what it took to find them.
#[derive(Clone, PartialEq, Debug, Default, Serialize, Deserialize)]
pub struct Candidates {
    /// Those whose checkpoints are kept.
    pub ranked: Vec<Candidate>,
    /// Frames of all episodes that were played to choose.
    pub frames: u64,
}

impl Candidates {
    /// Takes a candidate in; whether it is among those that are kept.
    pub fn add(&mut self, candidate: Candidate, algorithm: AlgorithmKind, kept: usize) -> bool {
        let at = self.ranked.iter().position(|other| candidate.is_better_than(other, algorithm));
        let at = at.unwrap_or(self.ranked.len());
        self.ranked.insert(at, candidate);
        self.ranked.truncate(kept);
        at < kept
    }
}

/// What the policy at the end of a run is worth.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct LastPolicy {
    /// Frames of the run.
    pub frames: u64,
    /// Closing episodes.
    #[serde(flatten)]
    pub closing: Evaluation,
}

/// The checkpoint that a run selects, and how it came to it.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Selection {
    /// The selected checkpoint.
    #[serde(flatten)]
    pub selected: Candidate,
    /// Candidates that came before it and did not keep their budgets in further episodes.
    #[serde(default)]
    pub failed: Vec<Candidate>,
    /// The policy at the end of the run, which nothing was chosen by.
    #[serde(default)]
    pub last: Option<LastPolicy>,
    /// Share of the error that each confirmation has: it may not be surely within with a larger
    /// probability of being over.
    #[serde(default)]
    pub level: Option<f64>,
    /// Frames of all episodes that were played to choose, confirm and close.
    #[serde(default)]
    pub selection_frames: u64,
}

impl Selection {
    /// Whether it is of a run that ended after so many frames.
    #[must_use]
    pub fn closes(&self, frames: u64) -> bool {
        self.last.as_ref().is_some_and(|last| last.frames == frames)
    }

    /// Whether it is of a run that ended after more frames than these.
    pub(crate) fn is_made_after(&self, frames: u64) -> bool {
        self.last.as_ref().is_some_and(|last| last.frames > frames)
    }
}

/// The sets of episodes: their seeds have nothing in common.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum EpisodeSet {
    /// Those that all candidates of a run play.
    Candidates,
    /// Those that confirm a candidate, the same for each.
    Confirmation,
    /// Those of the closing with this number; the last policy's is number 0.
    Closing(u64),
}

impl EpisodeSet {
    /// Its number among all sets of a run.
    #[must_use]
    pub fn number(self) -> u64 {
        match self {
            EpisodeSet::Candidates => 0,
            EpisodeSet::Confirmation => 1,
            EpisodeSet::Closing(attempt) => 2 + attempt,
        }
    }
}

/// Plays so many episodes of a set with a checkpoint (by its frames; `None` is the policy at the
/// end of the run); nothing where it was stopped meanwhile.
pub type PlaySet<'a> =
    dyn FnMut(Option<u64>, EpisodeSet, usize) -> Result<Option<Vec<Episode>>, LearnError> + 'a;

/// Whether episodes cost surely no more than every budget, at a level.
fn surely_within(
    episodes: &[Episode],
    constraints: &[Constraint],
    level: f64,
) -> Result<bool, LearnError> {
    for constraint in constraints {
        let costs: Vec<f64> = episodes
            .iter()
            .filter_map(|episode| constraint.cost_of(episode).transpose())
            .collect::<Result<_, _>>()?;
        if upper_bound(&costs, level) > constraint.budget {
            return Ok(false);
        }
    }
    Ok(true)
}

/// The share of the error that each of the confirmations that a run may make has.
#[must_use]
pub fn shared_level(settings: &EvaluationConfig) -> f64 {
    ERROR / settings.candidates.max(1) as f64
}

/// Selects among the candidates of a run that is over; `None` if it has none, or playing was
/// stopped.
pub fn select(
    candidates: &Candidates,
    config: &TrainConfig,
    frames: u64,
    play: &mut PlaySet<'_>,
) -> Result<Option<Selection>, LearnError> {
    let Some(first) = candidates.ranked.first() else { return Ok(None) };
    let (settings, algorithm) = (&config.evaluation, config.algorithm);
    let level = shared_level(settings);
    let episodes = config.confirming_episodes();
    let mut spent = candidates.frames;
    let mut go = |policy: Option<u64>,
                  set: EpisodeSet|
     -> Result<Option<(Vec<Episode>, Evaluation)>, LearnError> {
        let Some(played) = play(policy, set, episodes)? else { return Ok(None) };
        spent += frames_of(&played, config);
        let evaluation = Evaluation::of(&played, &config.constraints)?;
        Ok(Some((played, evaluation)))
    };
    let kept = |evaluation: &Evaluation, surely: bool| {
        !algorithm.keeps_budgets() || (evaluation.within() && (surely || !settings.surely))
    };
    let (mut failed, mut selected): (Vec<Candidate>, Option<Candidate>) = (Vec::new(), None);
    let mut attempts = 0;
    let mut last_closing = None;
    for candidate in candidates.ranked.iter().take(settings.candidates) {
        // One over its budgets is not worth confirming; it is the least evil at best.
        if algorithm.keeps_budgets() && !candidate.chosen_by.within() {
            break;
        }
        let Some((played, chosen_by)) = go(Some(candidate.frames), EpisodeSet::Confirmation)?
        else {
            return Ok(None);
        };
        let surely_within = surely_within(&played, &config.constraints, level)?;
        let mut confirmed =
            Candidate { chosen_by, confirmed: true, surely_within, ..candidate.clone() };
        if kept(&confirmed.chosen_by, surely_within) {
            // The policy at the end of the run is closed in any case, by episodes that nothing was
            // chosen by: once is enough.
            let is_last = candidate.frames == frames;
            attempts += u64::from(!is_last);
            let set = EpisodeSet::Closing(if is_last { 0 } else { attempts });
            let Some((_, closing)) = go(Some(candidate.frames), set)? else { return Ok(None) };
            last_closing = is_last.then(|| closing.clone()).or(last_closing);
            let fine = !algorithm.keeps_budgets() || closing.within();
            confirmed.closing = Some(closing);
            if fine {
                selected = Some(confirmed);
                break;
            }
        }
        failed.push(confirmed);
    }
    let selected = match selected {
        Some(selected) => selected,
        None => {
            // None kept its budgets all the way: the best by what is known of each, closed if it is
            // not yet.
            let best = failed.iter().fold(None, |best: Option<&Candidate>, one| match best {
                Some(best) if !one.is_better_than(best, algorithm) => Some(best),
                _ => Some(one),
            });
            let mut best = best.unwrap_or(first).clone();
            failed.retain(|one| one.frames != best.frames);
            if best.closing.is_none() {
                let is_last = best.frames == frames;
                let set = EpisodeSet::Closing(if is_last { 0 } else { attempts + 1 });
                let Some((_, closing)) = go(Some(best.frames), set)? else { return Ok(None) };
                last_closing = is_last.then(|| closing.clone()).or(last_closing);
                best.closing = Some(closing);
            }
            best
        }
    };
    let closing = match last_closing {
        Some(closing) => closing,
        None => match go(None, EpisodeSet::Closing(0))? {
            Some((_, closing)) => closing,
            None => return Ok(None),
        },
    };
    let last = LastPolicy { frames, closing };
    Ok(Some(Selection {
        selected,
        failed,
        last: Some(last),
        level: Some(level),
        selection_frames: spent,
    }))
}

/// Frames of some episodes.
#[must_use]
pub fn frames_of(episodes: &[Episode], config: &TrainConfig) -> u64 {
    episodes
        .iter()
        .map(|episode| u64::from(episode.length) * u64::from(config.env.frame_skip))
        .sum()
}

#[cfg(test)]
mod tests;
