//! What episodes cost lately: means for reports, signals for constraints.

use std::collections::VecDeque;

use hasard_envs::Episode;
use serde::{Deserialize, Serialize};

use crate::algorithms::Signal;
use crate::config::{Constraint, ConstraintStatistic, TrainConfig};
use crate::error::LearnError;

/// What is kept of an episode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finished {
    /// Sum of rewards.
    pub episode_return: f64,
    /// Sum of costs.
    pub cost: f64,
    /// Steps.
    pub length: f64,
    /// Sum of each constraint's cost.
    pub constrained: Vec<f64>,
    /// Cost terms and statistics, by name.
    pub details: Vec<(String, f64)>,
}

/// The latest episodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Watch {
    /// Latest episodes, oldest first.
    pub recent: VecDeque<Finished>,
    /// Episodes so far.
    pub episodes: u64,
    window: usize,
    /// Latest episodes that constraints look at: one a world, so that each counts about once and the mean follows the
    /// policy as fast as episodes end.
    constraint_window: usize,
}

impl Watch {
    /// A watch that has seen nothing.
    #[must_use]
    pub fn new(config: &TrainConfig) -> Watch {
        Watch {
            recent: VecDeque::new(),
            episodes: 0,
            window: config.reporting.window.max(config.sampling.lanes),
            constraint_window: config.sampling.lanes,
        }
    }

    /// A saved watch in a run of these settings.
    pub fn resumed(&self, config: &TrainConfig) -> Result<Watch, LearnError> {
        let constraints = config.constraints.len();
        if self.recent.iter().any(|one| one.constrained.len() != constraints) {
            let problem = "the checkpoint's episodes were held against other constraints; start a new run with --init-from";
            return Err(LearnError::Config(problem.into()));
        }
        Ok(Watch { recent: self.recent.clone(), episodes: self.episodes, ..Watch::new(config) })
    }

    /// Notes an episode; one that does not report a constraint's term is an error.
    pub fn add(&mut self, episode: &Episode, constraints: &[Constraint]) -> Result<(), LearnError> {
        let constrained = constraints.iter().map(|one| one.cost_of(episode)).collect::<Result<_, _>>()?;
        let costs = episode.costs.iter().map(|one| (format!("cost/{}", one.name), one.cost));
        let stats = episode.stats.iter().map(|(name, value)| (format!("stats/{name}"), *value));
        self.recent.push_back(Finished {
            episode_return: episode.episode_return,
            cost: episode.cost,
            length: f64::from(episode.length),
            constrained,
            details: costs.chain(stats).collect(),
        });
        self.episodes += 1;
        while self.recent.len() > self.window {
            self.recent.pop_front();
        }
        Ok(())
    }

    /// Mean over the latest episodes, if there are any.
    #[must_use]
    pub fn mean(&self, of: impl Fn(&Finished) -> f64) -> Option<f64> {
        let count = self.recent.len();
        (count > 0).then(|| self.recent.iter().map(of).sum::<f64>() / count as f64)
    }

    /// Mean of every cost term and statistic.
    #[must_use]
    pub fn details(&self) -> Vec<(String, f64)> {
        let Some(last) = self.recent.back() else { return Vec::new() };
        let mean = |(name, _): &(String, f64)| {
            let values = self.recent.iter().flat_map(|one| one.details.iter().filter(|(other, _)| other == name));
            let (count, sum) = values.fold((0u32, 0.0), |(count, sum), (_, value)| (count + 1, sum + value));
            (name.clone(), sum / f64::from(count.max(1)))
        };
        last.details.iter().map(mean).collect()
    }

    /// What each constraint costs at present, when so much of the training is over; nothing while that is not known yet.
    #[must_use]
    pub fn signals(&self, config: &TrainConfig, done: f64, minibatch_costs: &[f64]) -> Vec<Signal> {
        let episode_steps = f64::from(config.episode_steps);
        let signal = |index: usize, episode_cost: f64, mean_steps: f64| Signal {
            episode_cost,
            episode_budget: config.constraints[index].budget * config.budget_share,
            episode_steps,
            mean_steps,
            done,
        };
        match config.constraint_statistic {
            ConstraintStatistic::StepMean => minibatch_costs
                .iter()
                .enumerate()
                .map(|(index, cost)| signal(index, cost * episode_steps, episode_steps))
                .collect(),
            ConstraintStatistic::EpisodeMean => {
                let latest: Vec<_> = self.recent.iter().rev().take(self.constraint_window).collect();
                if latest.is_empty() {
                    return Vec::new();
                }
                let mean = |of: &dyn Fn(&Finished) -> f64| latest.iter().map(|one| of(one)).sum::<f64>() / latest.len() as f64;
                let steps = mean(&|one| one.length).max(1.0);
                (0..config.constraints.len()).map(|index| signal(index, mean(&|one| one.constrained[index]), steps)).collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{AlgorithmKind, EnvConfig, Preset};
    use hasard_envs::{Scenario, episode_costs};

    fn episode(cost: f64, jumps: f64) -> Episode {
        Episode {
            lane: 0,
            seed: 0,
            episode_return: 1.0,
            cost,
            costs: episode_costs(Scenario::VolcanicVenture.cost_terms(), &[cost, jumps]),
            length: 10,
            terminated: true,
            truncated: false,
            stats: vec![("deaths", 1.0)],
        }
    }

    #[test]
    fn signals_are_means_of_the_latest_episodes_or_of_the_steps() {
        let mut config = TrainConfig::plain(AlgorithmKind::PpoLag, Preset::Paper, EnvConfig::new("test"));
        config.sampling.lanes = 2;
        config.constraints =
            vec![Constraint { term: None, budget: 50.0 }, Constraint { term: Some("jumps".into()), budget: 3.0 }];
        let mut watch = Watch::new(&config);
        assert!(watch.signals(&config, 0.0, &[0.1, 0.2]).is_empty());
        for (cost, jumps) in [(1000.0, 50.0), (60.0, 4.0), (80.0, 8.0)] {
            watch.add(&episode(cost, jumps), &config.constraints).unwrap();
        }
        let signals = watch.signals(&config, 0.0, &[0.1, 0.2]);
        assert_eq!(signals[0].episode_excess(), 20.0);
        assert_eq!(signals[1].episode_excess(), 3.0);
        assert!((signals[0].step_excess() - 20.0 / 525.0).abs() < 1e-12);
        assert_eq!(watch.details()[2], ("stats/deaths".to_string(), 1.0));
        config.constraint_statistic = ConstraintStatistic::StepMean;
        let signals = watch.signals(&config, 0.0, &[0.3, 0.2]);
        assert!((signals[0].step_excess() - (0.3 - 50.0 / 2100.0 * 4.0)).abs() < 1e-12);
    }
}
