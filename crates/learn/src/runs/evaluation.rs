//! What episodes of a policy say about its return and its budgets.

use hasard_envs::Episode;
use serde::{Deserialize, Serialize};

use crate::config::Constraint;
use crate::error::LearnError;
use crate::statistics::{Estimate, Tails, tails};

/// What the critics of the costs expected in an episode, and what came.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Trace {
    /// Discounted cost to come that each constraint's critic expected before each step; no critic
    /// where the policy has none, or where the unit of its values is not known.
    pub expected: Vec<Vec<f64>>,
    /// Cost of each step under each of these constraints.
    pub costs: Vec<Vec<f64>>,
}

/// Closing episodes of a policy: its frames, whether it is the selected one, the episodes with what
/// its critics expected.
pub struct Closing {
    /// Frames after which it was taken.
    pub frames: u64,
    /// It is the selected checkpoint; otherwise the last policy.
    pub selected: bool,
    /// The episodes.
    pub played: Vec<(Episode, Trace)>,
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

/// What the episodes of one of several tasks came to.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct TaskEvaluation {
    /// The task's id.
    pub task: String,
    /// Number of episodes.
    pub episodes: usize,
    /// Sum of rewards.
    pub episode_return: Estimate,
    /// Sum of costs.
    pub cost: Estimate,
    /// Steps.
    pub length: Estimate,
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
    /// Each constraint by its own term and budget, over the episodes of the tasks that have it.
    pub constraints: Vec<Judgement>,
    /// Each of several tasks by itself, in the order of their episodes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub tasks: Vec<TaskEvaluation>,
}

impl Evaluation {
    /// Judges episodes; those that do not report a constraint's term are an error.
    pub fn of(episodes: &[Episode], constraints: &[Constraint]) -> Result<Evaluation, LearnError> {
        let judge = |one: &Constraint| {
            let costs: Vec<f64> = episodes
                .iter()
                .filter_map(|episode| one.cost_of(episode).transpose())
                .collect::<Result<_, _>>()?;
            if costs.is_empty() && !episodes.is_empty() {
                let term = one.term.as_deref().unwrap_or("cost");
                return Err(LearnError::Config(format!(
                    "none of {} episodes is of a task with the cost term '{term}'; play more",
                    episodes.len()
                )));
            }
            let spread = tails(costs.iter().copied(), Some(one.budget));
            Ok(Judgement {
                term: one.term.clone(),
                budget: one.budget,
                cost: Estimate::of(costs),
                tails: spread,
            })
        };
        Ok(Evaluation {
            episodes: episodes.len(),
            episode_return: Estimate::of(episodes.iter().map(|episode| episode.episode_return)),
            cost: Estimate::of(episodes.iter().map(|episode| episode.cost)),
            tails: tails(episodes.iter().map(|episode| episode.cost), None),
            length: Estimate::of(episodes.iter().map(|episode| f64::from(episode.length))),
            constraints: constraints.iter().map(judge).collect::<Result<_, LearnError>>()?,
            tasks: by_task(episodes),
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

    /// How far mean costs are above their budgets, in parts of the budgets (of 1 where a budget
    /// is 0), added up.
    #[must_use]
    pub fn excess(&self) -> f64 {
        let unit = |budget: f64| if budget > 0.0 { budget } else { 1.0 };
        self.constraints
            .iter()
            .map(|one| (one.cost.mean - one.budget).max(0.0) / unit(one.budget))
            .sum()
    }
}

/// Each of several tasks by itself.
fn by_task(episodes: &[Episode]) -> Vec<TaskEvaluation> {
    let mut names: Vec<&str> = Vec::new();
    for task in episodes.iter().filter_map(|episode| episode.task) {
        if !names.contains(&task) {
            names.push(task);
        }
    }
    let of = |task: &str| {
        let own = || episodes.iter().filter(|episode| episode.task == Some(task));
        TaskEvaluation {
            task: task.to_string(),
            episodes: own().count(),
            episode_return: Estimate::of(own().map(|episode| episode.episode_return)),
            cost: Estimate::of(own().map(|episode| episode.cost)),
            length: Estimate::of(own().map(|episode| f64::from(episode.length))),
        }
    };
    names.into_iter().map(of).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use hasard_envs::{Scenario, episode_costs};

    /// An episode of Volcanic Venture.
    pub(in crate::runs) fn episode(cost: f64, jumps: f64) -> Episode {
        Episode {
            task: None,
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
        let constraints = [
            Constraint { term: None, budget: 50.0 },
            Constraint { term: Some("jumps".into()), budget: 4.0 },
        ];
        let judged =
            Evaluation::of(&[episode(20.0, 6.0), episode(40.0, 4.0)], &constraints).unwrap();
        assert_eq!(
            (judged.cost.mean, judged.constraints[0].cost.mean, judged.constraints[1].cost.mean),
            (30.0, 30.0, 5.0)
        );
        assert!(
            judged.constraints[0].within() && !judged.constraints[1].within() && !judged.within()
        );
        assert!((judged.excess() - 0.25).abs() < 1e-12);
        // Half of the episodes have more than 4 jumps; one costs 40.
        assert_eq!(
            (judged.constraints[1].tails.over_budget, judged.tails.worst),
            (Some(0.5), 40.0)
        );
        // Half the interval of 30 and 31: 12.706 * 0.5 = 6.35.
        let judged =
            Evaluation::of(&[episode(30.0, 1.0), episode(31.0, 1.0)], &constraints).unwrap();
        assert!(judged.within() && judged.surely_within());
        let wide = Evaluation::of(&[episode(44.0, 1.0), episode(46.0, 1.0)], &constraints).unwrap();
        assert!(wide.within() && !wide.surely_within());
    }
}
