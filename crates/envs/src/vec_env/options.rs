//! How a batch of worlds is made.

use crate::{EnvError, Insight};

/// What follows an episode's end.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Autoreset {
    /// The same step starts the next episode; the observation is its first.
    #[default]
    SameStep,
    /// The step after starts the next episode, whatever its action; its reward and cost are 0.
    NextStep,
    /// The lane rests, its flags raised, until it is reset; [`crate::VecEnv::resting`] says which
    /// do.
    Disabled,
}

/// Which last observations [`crate::Batch::final_observations`] keeps under
/// [`Autoreset::SameStep`].
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
    /// Worker threads; 0 steps in the caller's thread. A caller that waits for a batch helps with
    /// it, so that `n` cores are used up by `n - 1` threads if the caller has nothing else to do.
    pub threads: usize,
    /// Groups that the lanes are cut into, to be stepped independently: 2 lets a policy work on one
    /// half while the other steps.
    pub groups: usize,
    /// Seed of the batch: with the lane's number it decides everything that happens in a lane.
    pub seed: u64,
    /// Number of the first lane, so that a batch may continue where another ends.
    pub first_lane: u64,
    /// What follows an episode's end.
    pub autoreset: Autoreset,
    /// Which last observations are kept.
    pub final_observations: FinalObservations,
    /// Every step reports the scenario's statistics, not only an episode's end.
    pub statistics: bool,
    /// What is shown beside observations, to learners.
    pub insight: Insight,
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
            statistics: false,
            insight: Insight::default(),
        }
    }
}

impl VecOptions {
    /// What is wrong with the options, if anything.
    pub fn check(&self) -> Result<(), EnvError> {
        let limit = |option, given: usize, least: usize, most: usize| {
            let allowed = format!("{least}..={most}");
            let fits = (least..=most).contains(&given);
            if fits {
                Ok(())
            } else {
                Err(EnvError::Option { option, given: given.to_string(), allowed })
            }
        };
        limit("the number of environments", self.lanes, 1, 65536)?;
        limit("the number of groups", self.groups, 1, self.lanes)?;
        limit("the number of threads", self.threads, 0, 1024)
    }

    /// The lanes of a group: equal shares of the whole; the group after the last is the whole.
    pub(super) fn group_lanes(&self, group: usize) -> std::ops::Range<usize> {
        let at = |i: usize| self.lanes * i / self.groups;
        if group >= self.groups { 0..self.lanes } else { at(group)..at(group + 1) }
    }
}
