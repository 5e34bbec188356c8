//! Constraints, and what they are held against.

use hasard_envs::{CostTerm, Episode};
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

impl Constraint {
    /// What an episode cost under it. A term that the episode does not report is an error: taken for 0, it would be within any
    /// budget.
    pub fn cost_of(&self, episode: &Episode) -> Result<f64, LearnError> {
        let Some(name) = &self.term else { return Ok(episode.cost) };
        let found = episode.costs.iter().find(|one| one.name == name);
        found.map(|one| one.cost).ok_or_else(|| {
            let names: Vec<&str> = episode.costs.iter().map(|one| one.name).collect();
            LearnError::Config(format!("an episode does not report the cost term '{name}'; it has {}", names.join(", ")))
        })
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use hasard_envs::{Scenario, episode_costs};

    /// A1: a budget on a term that an episode does not report must not be kept by silence.
    #[test]
    fn a_term_that_is_not_reported_is_an_error() {
        let costs = |scenario: Scenario, sums: &[f64]| Episode {
            lane: 0,
            seed: 0,
            episode_return: 1.0,
            cost: 7.0,
            costs: episode_costs(scenario.cost_terms(), sums),
            length: 10,
            terminated: true,
            truncated: false,
            stats: vec![("jumps", 81.0)],
        };
        let on = |term: Option<&str>| Constraint { term: term.map(str::to_string), budget: 2.0 };
        let venture = costs(Scenario::VolcanicVenture, &[7.0, 81.0]);
        assert_eq!(on(None).cost_of(&venture).unwrap(), 7.0);
        assert_eq!(on(Some("lava")).cost_of(&venture).unwrap(), 7.0);
        assert_eq!(on(Some("jumps")).cost_of(&venture).unwrap(), 81.0);
        let rush = costs(Scenario::RemedyRush, &[7.0]);
        let error = on(Some("jumps")).cost_of(&rush).unwrap_err().to_string();
        assert!(error.contains("'jumps'") && error.contains("harmful_items"), "{error}");
    }
}
