//! Constraints, and what they are held against.

use hasard_envs::CostTerm;
use serde::{Deserialize, Serialize};

use super::names::names;
use crate::error::LearnError;

names! {
    /// What a constraint's budget is held against.
    ConstraintStatistic ("constraint statistic") {
        /// Mean cost of the episodes that ended lately, against the budget of an episode.
        EpisodeMean = "episode-mean",
        /// Mean cost of the minibatch's steps, against the budget over the longest episode's steps.
        StepMean = "step-mean",
    }
}

/// A constraint: a cost and the budget of an episode.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Constraint {
    /// Name of a cost term; `null` for the scalar cost.
    pub term: Option<String>,
    /// Cost that an episode may have.
    pub budget: f64,
}

/// Where each constraint's cost is found among the terms; unknown names are refused.
pub(crate) fn find_terms(terms: &[CostTerm], constraints: &[Constraint]) -> Result<Vec<Option<usize>>, LearnError> {
    constraints
        .iter()
        .map(|constraint| match &constraint.term {
            None => Ok(None),
            Some(name) => terms.iter().position(|term| term.name == name).map(Some).ok_or_else(|| {
                let names: Vec<&str> = terms.iter().map(|term| term.name).collect();
                LearnError::Config(format!("this environment has no cost term '{name}'; it has {}", names.join(", ")))
            }),
        })
        .collect()
}
