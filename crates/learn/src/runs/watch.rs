//! What episodes cost lately: means for reports, signals for constraints.

use std::collections::VecDeque;

use hasard_envs::Episode;
use serde::{Deserialize, Deserializer, Serialize};

use crate::algorithms::Signal;
use crate::config::constraint::conditional_value_at_risk;
use crate::config::{Constraint, ConstraintStatistic, MultiplierUpdate, TrainConfig};
use crate::error::LearnError;
use crate::runs::first_episodes::FirstEpisodes;
use crate::statistics::deviation;

/// What is kept of an episode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finished {
    /// Sum of rewards.
    pub episode_return: f64,
    /// Sum of costs.
    pub cost: f64,
    /// Steps.
    pub length: f64,
    /// Sum of each constraint's cost; nothing under one that its task does not have.
    pub constrained: Vec<Option<f64>>,
    /// Cost terms and statistics, by name.
    pub details: Vec<(String, f64)>,
}

/// Sums over all episodes of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Totals {
    /// Cost.
    pub cost: f64,
    /// What episodes cost beyond each constraint's budget.
    pub violations: Vec<f64>,
}

/// The latest episodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Watch {
    /// Latest episodes, oldest first.
    pub recent: VecDeque<Finished>,
    /// Episodes so far.
    pub episodes: u64,
    /// Of the latest, those that finished since a rollout was last learned from with any, and
    /// rollouts that passed without, constraint by constraint.
    #[serde(default)]
    fresh: usize,
    #[serde(default, deserialize_with = "each_or_one")]
    waited: Vec<u64>,
    /// Sums over them; nothing in a run whose earlier part did not count them.
    #[serde(default)]
    pub totals: Option<Totals>,
    /// The first episodes, where budgets come down from what they cost.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub first: Option<FirstEpisodes>,
    window: usize,
    /// Latest episodes that each constraint looks at: one a world whose task has it, so that each
    /// counts about once and the mean follows the policy as fast as episodes end.
    #[serde(skip)]
    constraint_windows: Vec<usize>,
}

/// What older versions wrote is one number for all constraints.
fn each_or_one<'de, D: Deserializer<'de>>(waited: D) -> Result<Vec<u64>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Waited {
        Each(Vec<u64>),
        All(u64),
    }
    Ok(match Waited::deserialize(waited)? {
        Waited::Each(each) => each,
        Waited::All(all) => vec![all],
    })
}

impl Watch {
    /// A watch that has seen nothing.
    #[must_use]
    pub fn new(config: &TrainConfig) -> Watch {
        Watch {
            recent: VecDeque::new(),
            episodes: 0,
            fresh: 0,
            waited: vec![0; config.constraints.len()],
            totals: Some(Totals { cost: 0.0, violations: vec![0.0; config.constraints.len()] }),
            first: config.learning.budget_annealing.map(|_| FirstEpisodes::default()),
            window: config.reporting.window.max(config.sampling.lanes),
            constraint_windows: config.lanes_under_constraints(),
        }
    }

    /// A saved watch in a run of these settings.
    pub fn resumed(&self, config: &TrainConfig) -> Result<Watch, LearnError> {
        let constraints = config.constraints.len();
        if self.recent.iter().any(|one| one.constrained.len() != constraints) {
            let problem = "the checkpoint's episodes were held against other constraints; start a new run with --init-from";
            return Err(LearnError::Config(problem.into()));
        }
        let (fresh, totals, first) = (self.fresh, self.totals.clone(), self.first.clone());
        // What an older version wrote holds for each.
        let all = self.waited.first().copied().unwrap_or(0);
        let waited =
            (0..constraints).map(|index| self.waited.get(index).copied().unwrap_or(all)).collect();
        Ok(Watch {
            recent: self.recent.clone(),
            episodes: self.episodes,
            fresh,
            waited,
            totals,
            first,
            ..Watch::new(config)
        })
    }

    /// Notes an episode; one that does not report a constraint's term is an error.
    pub fn add(&mut self, episode: &Episode, constraints: &[Constraint]) -> Result<(), LearnError> {
        let constrained: Vec<Option<f64>> =
            constraints.iter().map(|one| one.cost_of(episode)).collect::<Result<_, _>>()?;
        if let Some(totals) = &mut self.totals {
            totals.cost += episode.cost;
            for ((sum, cost), constraint) in
                totals.violations.iter_mut().zip(&constrained).zip(constraints)
            {
                *sum += cost.map_or(0.0, |cost| (cost - constraint.budget).max(0.0));
            }
        }
        if let Some(first) = &mut self.first {
            first.add(&constrained, &self.constraint_windows);
        }
        let costs = episode.costs.iter().map(|one| (format!("cost/{}", one.name), one.cost));
        let stats = episode.stats.iter().map(|(name, value)| (format!("stats/{name}"), *value));
        let whole = [
            ("return", episode.episode_return),
            ("cost", episode.cost),
            ("length", f64::from(episode.length)),
        ];
        let of_task = episode.task.into_iter().flat_map(|task| {
            whole.map(|(name, value)| (format!("task/{task}/{name}"), value)).into_iter()
        });
        let costs = costs.filter(|(name, _)| name.strip_prefix("cost/") != episode.task);
        self.recent.push_back(Finished {
            episode_return: episode.episode_return,
            cost: episode.cost,
            length: f64::from(episode.length),
            constrained,
            details: costs.chain(stats).chain(of_task).collect(),
        });
        self.episodes += 1;
        self.fresh += 1;
        while self.recent.len() > self.window {
            self.recent.pop_front();
        }
        Ok(())
    }

    /// Ends what is new: call it when a rollout was learned from.
    pub fn learned(&mut self) {
        for index in 0..self.waited.len() {
            let none = self.fresh_under(index) == 0;
            self.waited[index] = if none { self.waited[index] + 1 } else { 0 };
        }
        self.fresh = 0;
    }

    /// Notes that a rollout was thrown away: the next one that is learned from counts for it too.
    pub fn thrown_away(&mut self) {
        self.waited.iter_mut().for_each(|waited| *waited += 1);
    }

    /// New episodes that have a constraint.
    fn fresh_under(&self, index: usize) -> usize {
        let new = self.recent.iter().rev().take(self.fresh);
        new.filter(|one| one.constrained[index].is_some()).count()
    }

    /// Mean over the latest episodes, if there are any.
    #[must_use]
    pub fn mean(&self, of: impl Fn(&Finished) -> f64) -> Option<f64> {
        let count = self.recent.len();
        (count > 0).then(|| self.recent.iter().map(of).sum::<f64>() / count as f64)
    }

    /// Mean of every cost term and statistic over the episodes that have it, and of each of several
    /// tasks.
    #[must_use]
    pub fn details(&self) -> Vec<(String, f64)> {
        let mut sums: Vec<(&str, u32, f64)> = Vec::new();
        for (name, _) in self.recent.iter().rev().flat_map(|one| &one.details) {
            if !sums.iter().any(|(known, ..)| known == name) {
                sums.push((name, 0, 0.0));
            }
        }
        for (name, value) in self.recent.iter().flat_map(|one| &one.details) {
            if let Some((_, count, sum)) = sums.iter_mut().find(|(known, ..)| known == name) {
                (*count, *sum) = (*count + 1, *sum + value);
            }
        }
        let mean =
            |(name, count, sum): (&str, u32, f64)| (name.to_string(), sum / f64::from(count));
        sums.into_iter().map(mean).collect()
    }

    /// Cost of an episode that learning aims at when so much of the training is over. Where budgets
    /// are annealed and no episode has ended yet, that is what it will be in the end.
    #[must_use]
    pub fn aim(&self, config: &TrainConfig, constraint: usize, done: f64) -> f64 {
        let measured = self.first.as_ref().and_then(|first| first.mean(constraint));
        let costs: Vec<f64> =
            self.recent.iter().filter_map(|one| one.constrained[constraint]).collect();
        config.aim_after(constraint, done, measured.unwrap_or_default(), deviation(&costs))
    }

    /// What each constraint costs at present, when so much of the training is over; nothing while
    /// that is not known of all of them.
    #[must_use]
    pub fn signals(&self, config: &TrainConfig, done: f64, minibatch_costs: &[f64]) -> Vec<Signal> {
        let episode_steps = f64::from(config.episode_steps);
        let share = |index: usize| {
            self.constraint_windows[index].max(1) as f64 / config.sampling.lanes.max(1) as f64
        };
        let signal = |index: usize, episode_cost: f64| Signal {
            done,
            share: share(index),
            ..Signal::steady(episode_cost, self.aim(config, index, done), episode_steps)
        };
        if config.constraint_statistic == ConstraintStatistic::StepMean {
            return minibatch_costs
                .iter()
                .enumerate()
                // The mean is over all worlds, also those that do not have the constraint.
                .map(|(index, cost)| signal(index, cost * episode_steps / share(index)))
                .collect();
        }
        let once = config.algorithm_settings.multiplier_update == MultiplierUpdate::Rollout;
        let one = |index: usize| {
            // The latest that have the constraint, the newest first.
            let latest = || {
                self.recent
                    .iter()
                    .rev()
                    .filter_map(move |one| one.constrained[index].map(|cost| (cost, one.length)))
            };
            let count = self.constraint_windows[index].min(latest().count());
            if count == 0 {
                return None;
            }
            let mean = |count: usize| {
                latest().take(count).map(|(cost, _)| cost).sum::<f64>() / count as f64
            };
            let fresh = self.fresh_under(index);
            let weight = if fresh == 0 { 0.0 } else { (self.waited[index] + 1) as f64 };
            let mean_steps =
                latest().take(count).map(|(_, length)| length).sum::<f64>() / count as f64;
            let signal = match config.constraint_statistic {
                // The worst of a few new episodes would say nothing: all that are remembered count,
                // whenever some are new.
                ConstraintStatistic::Cvar(share) => {
                    let costs: Vec<f64> = latest().map(|(cost, _)| cost).collect();
                    signal(index, conditional_value_at_risk(&costs, share).unwrap_or(0.0))
                }
                _ => {
                    let fresh_cost = mean(if once && fresh > 0 { fresh } else { count });
                    Signal { fresh_cost, ..signal(index, mean(count)) }
                }
            };
            Some(Signal {
                mean_steps: mean_steps.max(1.0),
                fresh_weight: if once { weight } else { 1.0 },
                ..signal
            })
        };
        (0..config.constraints.len()).map(one).collect::<Option<_>>().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests;
