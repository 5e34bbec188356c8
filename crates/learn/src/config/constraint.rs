//! Constraints, and what they are held against.

use std::fmt;
use std::str::FromStr;

use hasard_envs::{CostTerm, Episode};
use serde::{Deserialize, Serialize};

use crate::error::LearnError;

/// What a constraint's budget is held against. As text `episode-mean`, `step-mean` or, for the
/// worst tenth, `cvar:0.1`.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub enum ConstraintStatistic {
    /// Mean cost of the episodes that ended lately, against the budget of an episode.
    EpisodeMean,
    /// Mean cost of the minibatch's steps, against the budget over the longest episode's steps.
    StepMean,
    /// Mean cost of this share of the latest episodes, the worst of them, against the budget of an
    /// episode: the conditional value at risk.
    Cvar(f64),
}

impl fmt::Display for ConstraintStatistic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::EpisodeMean => f.write_str("episode-mean"),
            Self::StepMean => f.write_str("step-mean"),
            Self::Cvar(share) => write!(f, "cvar:{share}"),
        }
    }
}

impl FromStr for ConstraintStatistic {
    type Err = LearnError;

    fn from_str(text: &str) -> Result<ConstraintStatistic, LearnError> {
        let lower = text.to_ascii_lowercase();
        let share = |share: &str| {
            share.parse().ok().filter(|share| *share > 0.0 && *share <= 1.0).map(Self::Cvar)
        };
        match lower.as_str() {
            "episode-mean" => Some(Self::EpisodeMean),
            "step-mean" => Some(Self::StepMean),
            other => other.strip_prefix("cvar:").and_then(share),
        }
        .ok_or_else(|| {
            let known = "episode-mean, step-mean, or cvar:SHARE with a share above 0 and at most 1, such as cvar:0.1";
            LearnError::Config(format!("constraint statistic '{text}' is unknown; use {known}"))
        })
    }
}

impl From<ConstraintStatistic> for String {
    fn from(statistic: ConstraintStatistic) -> String {
        statistic.to_string()
    }
}

impl TryFrom<String> for ConstraintStatistic {
    type Error = LearnError;

    fn try_from(text: String) -> Result<ConstraintStatistic, LearnError> {
        text.parse()
    }
}

/// The mean of the largest `share` of some costs (Rockafellar and Uryasev 2000); where that is no
/// whole number of them, the last one counts in part. `None` if there are none.
#[must_use]
pub fn conditional_value_at_risk(costs: &[f64], share: f64) -> Option<f64> {
    let mut worst = costs.to_vec();
    worst.sort_by(|a, b| b.total_cmp(a));
    let count = (share * costs.len() as f64).max(f64::MIN_POSITIVE);
    let weights = (0..costs.len()).map(|index| (count - index as f64).clamp(0.0, 1.0));
    let sum: f64 = worst.iter().zip(weights).map(|(cost, weight)| cost * weight).sum();
    (!costs.is_empty()).then_some(sum / count)
}

/// A constraint: a cost and the budget of an episode.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Constraint {
    /// Name of a cost term; `null` for the scalar cost. Of several tasks, the id of one stands for
    /// the scalar cost of that one.
    pub term: Option<String>,
    /// Cost that an episode may have.
    pub budget: f64,
}

impl Constraint {
    /// What an episode cost under it; nothing for one of several tasks that does not have the term.
    /// Otherwise a term that the episode does not report is an error: taken for 0, it would be
    /// within any budget.
    pub fn cost_of(&self, episode: &Episode) -> Result<Option<f64>, LearnError> {
        let Some(name) = &self.term else { return Ok(Some(episode.cost)) };
        let found = episode.costs.iter().find(|one| one.name == name);
        if found.is_none() && episode.task.is_some() {
            return Ok(None);
        }
        found.map(|one| Some(one.cost)).ok_or_else(|| {
            let names: Vec<&str> = episode.costs.iter().map(|one| one.name).collect();
            LearnError::Config(format!(
                "an episode does not report the cost term '{name}'; it has {}",
                names.join(", ")
            ))
        })
    }
}

/// Refuses two budgets for one cost: the smaller would hold, and both would be paid for.
///
/// # Errors
/// Names the cost.
pub fn check_once_each(constraints: &[Constraint]) -> Result<(), LearnError> {
    let twice = (1..constraints.len())
        .find(|&index| constraints[..index].iter().any(|one| one.term == constraints[index].term));
    let Some(index) = twice else { return Ok(()) };
    let cost = match &constraints[index].term {
        None => "the cost".to_string(),
        Some(term) => format!("'{term}'"),
    };
    Err(LearnError::Config(format!("{cost} has two budgets; give it one --safety-budget")))
}

/// Refuses budgets of some of a run's tasks: the others would have none, and cost what they like.
///
/// # Errors
/// Names a task without a budget.
pub fn check_every_task(tasks: &[String], constraints: &[Constraint]) -> Result<(), LearnError> {
    let is_named = |task: &&String| constraints.iter().any(|one| one.term.as_ref() == Some(*task));
    match tasks.iter().find(|task| !is_named(task)) {
        Some(task) if tasks.iter().any(|task| is_named(&task)) => Err(LearnError::Config(format!(
            "--safety-budget: {task} has none where another task has; add --safety-budget {task}=COST"
        ))),
        _ => Ok(()),
    }
}

/// Where each constraint's cost is found among the terms; unknown names are refused.
pub(crate) fn find_terms(
    terms: &[CostTerm],
    constraints: &[Constraint],
) -> Result<Vec<Option<usize>>, LearnError> {
    constraints
        .iter()
        .map(|constraint| match &constraint.term {
            None => Ok(None),
            Some(name) => {
                terms.iter().position(|term| term.name == name).map(Some).ok_or_else(|| {
                    let names: Vec<&str> = terms.iter().map(|term| term.name).collect();
                    LearnError::Config(format!(
                        "--safety-budget '{name}': the environment has no such cost term; it has {}",
                        names.join(", ")
                    ))
                })
            }
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
            task: None,
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
        assert_eq!(on(None).cost_of(&venture).unwrap(), Some(7.0));
        assert_eq!(on(Some("lava")).cost_of(&venture).unwrap(), Some(7.0));
        assert_eq!(on(Some("jumps")).cost_of(&venture).unwrap(), Some(81.0));
        let rush = costs(Scenario::RemedyRush, &[7.0]);
        let error = on(Some("jumps")).cost_of(&rush).unwrap_err().to_string();
        assert!(error.contains("'jumps'") && error.contains("harmful_items"), "{error}");
    }

    #[test]
    fn statistics_are_read_as_they_are_written() {
        for text in ["episode-mean", "step-mean", "cvar:0.1", "cvar:1"] {
            assert_eq!(text.parse::<ConstraintStatistic>().unwrap().to_string(), text);
            let json =
                serde_json::to_string(&text.parse::<ConstraintStatistic>().unwrap()).unwrap();
            assert_eq!(json, format!("\"{text}\""));
        }
        for wrong in ["cvar", "cvar:0", "cvar:1.5", "cvar:nan", "mean", "cvar:-0.1"] {
            let message = wrong.parse::<ConstraintStatistic>().unwrap_err().to_string();
            assert!(
                message.contains(wrong) && message.contains("cvar:0.1") && !message.contains('\n'),
                "{message}"
            );
        }
    }

    /// Worked out by hand from the definition (Rockafellar and Uryasev 2000, equation 4 with
    /// atoms): the mean of the worst share.
    #[test]
    fn the_cvar_is_the_mean_of_the_worst_share() {
        let costs = [3.0, 50.0, 1.0, 20.0, 7.0, 0.0, 2.0, 30.0, 5.0, 4.0];
        for (share, expected) in [
            (0.1, 50.0),
            (0.2, 40.0),
            // Two and a half of ten: 50, 30 and half of 20, over 2.5.
            (0.25, 36.0),
            // Half of the worst alone is as bad as the worst.
            (0.05, 50.0),
            (1.0, 12.2),
        ] {
            let found = conditional_value_at_risk(&costs, share).unwrap();
            assert!((found - expected).abs() < 1e-12, "{share}: {found}");
        }
        assert_eq!(conditional_value_at_risk(&[], 0.1), None);
    }
}
