//! What episodes cost lately: means for reports, signals for constraints.

use std::collections::VecDeque;

use hasard_envs::Episode;
use serde::{Deserialize, Deserializer, Serialize};

use crate::algorithms::Signal;
use crate::config::constraint::conditional_value_at_risk;
use crate::config::{Constraint, ConstraintStatistic, MultiplierUpdate, TrainConfig};
use crate::error::LearnError;
use crate::runs::first_episodes::FirstEpisodes;

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
        config.aim_after(constraint, done, measured.unwrap_or_default())
    }

    /// What each constraint costs at present, when so much of the training is over; nothing while
    /// that is not known of all of them.
    #[must_use]
    pub fn signals(&self, config: &TrainConfig, done: f64, minibatch_costs: &[f64]) -> Vec<Signal> {
        let episode_steps = f64::from(config.episode_steps);
        let signal = |index: usize, episode_cost: f64| Signal {
            done,
            ..Signal::steady(episode_cost, self.aim(config, index, done), episode_steps)
        };
        if config.constraint_statistic == ConstraintStatistic::StepMean {
            return minibatch_costs
                .iter()
                .enumerate()
                .map(|(index, cost)| signal(index, cost * episode_steps))
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
mod tests {
    use super::*;
    use crate::config::{AlgorithmKind, EnvConfig, Preset};
    use crate::runs::evaluation::tests::episode as plain;

    fn episode(cost: f64, jumps: f64) -> Episode {
        Episode { stats: vec![("deaths", 1.0)], ..plain(cost, jumps) }
    }

    #[test]
    fn signals_are_means_of_the_latest_episodes_or_of_the_steps() {
        let mut config =
            TrainConfig::plain(AlgorithmKind::PpoLag, Preset::Paper, EnvConfig::new("test"));
        config.sampling.lanes = 2;
        config.constraints = vec![
            Constraint { term: None, budget: 50.0 },
            Constraint { term: Some("jumps".into()), budget: 3.0 },
        ];
        let mut watch = Watch::new(&config);
        assert!(watch.signals(&config, 0.0, &[0.1, 0.2]).is_empty());
        for (cost, jumps) in [(1000.0, 50.0), (60.0, 4.0), (80.0, 8.0)] {
            watch.add(&episode(cost, jumps), &config.constraints).unwrap();
        }
        // All three count, in the window or not: 950 + 10 + 30 over the budget of 50, 47 + 1 + 5
        // jumps over that of 3.
        assert_eq!(watch.totals, Some(Totals { cost: 1140.0, violations: vec![990.0, 53.0] }));
        let signals = watch.signals(&config, 0.0, &[0.1, 0.2]);
        assert_eq!(signals[0].episode_excess(), 20.0);
        assert_eq!(signals[1].episode_excess(), 3.0);
        assert!((signals[0].step_excess() - 20.0 / 525.0).abs() < 1e-12);
        assert_eq!(watch.details()[2], ("stats/deaths".to_string(), 1.0));
        config.constraint_statistic = ConstraintStatistic::StepMean;
        let signals = watch.signals(&config, 0.0, &[0.3, 0.2]);
        assert!((signals[0].step_excess() - (0.3 - 50.0 / 2100.0 * 4.0)).abs() < 1e-12);
    }

    /// A10: one aim for every algorithm, so that budgets of 50 with a share of 0.9 are 45 to all of
    /// them, PPOSaute among them: its safety state is used up, of 1, by the cost that the budget is
    /// (Sootla et al. 2022, equation 6, undiscounted).
    #[test]
    fn all_algorithms_aim_at_the_same_share_of_the_budget() {
        for &algorithm in AlgorithmKind::ALL {
            for &preset in Preset::ALL {
                let mut config = TrainConfig::plain(algorithm, preset, EnvConfig::new("test"));
                (config.constraints[0].budget, config.budget_share) = (50.0, 0.9);
                config.algorithm_settings.saute_gamma = 1.0;
                let mut watch = Watch::new(&config);
                watch.add(&episode(60.0, 0.0), &config.constraints).unwrap();
                assert_eq!(
                    watch.signals(&config, 0.0, &[0.0])[0].episode_budget,
                    45.0,
                    "{algorithm} {preset}"
                );
                if algorithm == AlgorithmKind::PpoSaute {
                    let shaping = crate::algorithms::shaping(&config);
                    let within = shaping.step(1.0, 1.0, 44.9);
                    assert!(within.0 == 1.0 && (within.1 - 0.1 / 45.0).abs() < 1e-6, "{within:?}");
                    assert!(shaping.step(1.0, 1.0, 45.1).0 < 0.0);
                }
            }
        }
    }

<<<<<<< HEAD
    /// By hand: two worlds, so the first two episodes are what annealed budgets start at: costs of
    /// 150 and 50, jumps of 1 and 2. Half way to a share of 0.5, the first aim is half way from
    /// 100 to 40, the budget of 50 with a share of 0.8; the second begins below its aim of 2.4.
    /// What the later episodes cost, or how often the watch is saved, changes nothing.
    #[test]
    fn annealed_aims_start_at_the_first_episodes() {
        let mut config =
            TrainConfig::plain(AlgorithmKind::PpoPid, Preset::Paper, EnvConfig::new("test"));
        config.sampling.lanes = 2;
        config.budget_share = 0.8;
        config.learning.budget_annealing = Some(0.5);
        config.constraints = vec![
            Constraint { term: None, budget: 50.0 },
            Constraint { term: Some("jumps".into()), budget: 3.0 },
        ];
        let mut watch = Watch::new(&config);
        for (cost, jumps) in [(150.0, 1.0), (50.0, 2.0), (900.0, 90.0)] {
            let saved = serde_json::to_value(&watch).unwrap();
            watch = serde_json::from_value::<Watch>(saved).unwrap().resumed(&config).unwrap();
            watch.add(&episode(cost, jumps), &config.constraints).unwrap();
        }
        for (done, first) in [(0.0, 100.0), (0.25, 70.0), (0.5, 40.0), (1.0, 40.0)] {
            let signals = watch.signals(&config, done, &[0.0; 2]);
            assert!((signals[0].episode_budget - first).abs() < 1e-9, "{done}: {signals:?}");
            assert!((signals[1].episode_budget - 2.4).abs() < 1e-9, "{done}: {signals:?}");
        }
        config.learning.budget_annealing = None;
        let written = serde_json::to_string(&Watch::new(&config)).unwrap();
        assert!(!written.contains("first"), "{written}");
=======
    /// Two tasks with a budget each: what the one costs is no news of the other, neither in the
    /// means nor in what is new.
    #[test]
    fn each_task_is_held_against_its_own_budget() {
        let ids = ["RemedyRushLevel1-v0", "VolcanicVentureLevel1-v0"];
        let env = EnvConfig::new(&ids.join(","));
        let mut config = TrainConfig::new(AlgorithmKind::PpoPid, Preset::Paper, env).unwrap();
        assert_eq!(
            config.constraints,
            [(ids[0], 5.0), (ids[1], 50.0)]
                .map(|(id, budget)| Constraint { term: Some(id.into()), budget })
        );
        config.sampling.lanes = 3;
        assert_eq!(config.lanes_under_constraints(), [2, 1]);
        let of = |task: usize, cost: f64, length: u32| {
            let whole = hasard_envs::EpisodeCost { name: ids[task], counted: false, cost };
            Episode { task: Some(ids[task]), costs: vec![whole], length, ..plain(cost, 0.0) }
        };
        let mut watch = Watch::new(&config);
        watch.add(&of(0, 8.0, 525), &config.constraints).unwrap();
        assert!(watch.signals(&config, 0.0, &[]).is_empty(), "the other is not known yet");
        watch.add(&of(1, 90.0, 100), &config.constraints).unwrap();
        watch.add(&of(1, 70.0, 300), &config.constraints).unwrap();
        watch.add(&of(0, 4.0, 525), &config.constraints).unwrap();
        let signals = |watch: &Watch| watch.signals(&config, 0.0, &[]);
        let costs = |watch: &Watch| -> Vec<(f64, f64, f64, f64)> {
            let facts =
                |one: &Signal| (one.episode_cost, one.fresh_cost, one.fresh_weight, one.mean_steps);
            signals(watch).iter().map(facts).collect()
        };
        // Two worlds play the first, one the second: so many of the latest count. All four are new.
        assert_eq!(costs(&watch), [(6.0, 6.0, 1.0, 525.0), (70.0, 80.0, 1.0, 300.0)]);
        assert_eq!(signals(&watch)[1].episode_budget, 50.0);
        // 3 over the budget of 5; 40 and 20 over that of 50.
        assert_eq!(watch.totals.as_ref().unwrap().violations, [3.0, 60.0]);
        watch.learned();
        watch.learned();
        watch.add(&of(0, 1.0, 525), &config.constraints).unwrap();
        // Of the second there is no news.
        assert_eq!(costs(&watch), [(2.5, 1.0, 2.0, 525.0), (70.0, 70.0, 0.0, 300.0)]);
        watch.learned();
        watch.add(&of(1, 10.0, 525), &config.constraints).unwrap();
        // Two rollouts had none of it, and this one counts for all three.
        assert_eq!(costs(&watch)[1], (10.0, 10.0, 3.0, 525.0));
        let details: std::collections::BTreeMap<String, f64> =
            watch.details().into_iter().collect();
        assert_eq!(details[&format!("task/{}/cost", ids[0])], 13.0 / 3.0);
        assert_eq!(details[&format!("task/{}/length", ids[1])], 925.0 / 3.0);
        assert!(!details.contains_key(&format!("cost/{}", ids[0])), "{details:?}");
    }

    /// What older versions wrote of rollouts without new episodes holds for each constraint.
    #[test]
    fn older_checkpoints_go_on() {
        let mut config =
            TrainConfig::plain(AlgorithmKind::PpoPid, Preset::Paper, EnvConfig::new("test"));
        config.sampling.lanes = 1;
        let old = r#"{"recent":[{"episode_return":1.0,"cost":2.0,"length":3.0,"constrained":[2.0],
            "details":[]}],"episodes":9,"fresh":0,"waited":3,"window":100,"constraint_window":1}"#;
        let watch: Watch = serde_json::from_str(old).unwrap();
        let mut watch = watch.resumed(&config).unwrap();
        watch.add(&episode(6.0, 0.0), &config.constraints).unwrap();
        let signal = watch.signals(&config, 0.0, &[])[0];
        assert_eq!((signal.fresh_cost, signal.fresh_weight), (6.0, 4.0));
    }

    /// A15: each episode counts as new once, in the rollout that it finished in; rollouts without
    /// any are made up for by the next.
    #[test]
    fn episodes_are_new_once() {
        let mut config =
            TrainConfig::plain(AlgorithmKind::PpoPid, Preset::Paper, EnvConfig::new("test"));
        config.sampling.lanes = 4;
        config.constraints[0].budget = 10.0;
        let mut watch = Watch::new(&config);
        let fresh = |watch: &Watch| {
            let signal = watch.signals(&config, 0.0, &[0.0])[0];
            (signal.episode_cost, signal.fresh_cost, signal.fresh_weight)
        };
        for cost in [10.0, 20.0] {
            watch.add(&episode(cost, 0.0), &config.constraints).unwrap();
        }
        assert_eq!(fresh(&watch), (15.0, 15.0, 1.0));
        watch.learned();
        assert_eq!(fresh(&watch), (15.0, 15.0, 0.0));
        watch.learned();
        let again = serde_json::from_value::<Watch>(serde_json::to_value(&watch).unwrap()).unwrap();
        let mut watch = again.resumed(&config).unwrap();
        watch.add(&episode(60.0, 0.0), &config.constraints).unwrap();
        assert_eq!(fresh(&watch), (30.0, 60.0, 2.0));
        watch.learned();
        watch.add(&episode(2.0, 0.0), &config.constraints).unwrap();
        assert_eq!(fresh(&watch), (23.0, 2.0, 1.0));
        // The released code's moments know no new ones.
        let each = TrainConfig {
            algorithm_settings: crate::config::AlgorithmConfig {
                multiplier_update: MultiplierUpdate::Minibatch,
                ..config.algorithm_settings.clone()
            },
            ..config.clone()
        };
        let signal = watch.signals(&each, 0.0, &[0.0])[0];
        assert_eq!((signal.fresh_cost, signal.fresh_weight), (23.0, 1.0));
    }

    /// By hand: of 20 episodes the worst tenth are 90 and 70, whatever the others are.
    #[test]
    fn a_constraint_may_be_on_the_tail() {
        let mut config =
            TrainConfig::plain(AlgorithmKind::PpoLag, Preset::Paper, EnvConfig::new("test"));
        config.sampling.lanes = 2;
        config.constraints[0].budget = 50.0;
        config.constraint_statistic = ConstraintStatistic::Cvar(0.1);
        config.check().unwrap();
        let mut watch = Watch::new(&config);
        for cost in [90.0, 70.0].into_iter().chain((0..18).map(f64::from)) {
            watch.add(&episode(cost, 0.0), &config.constraints).unwrap();
        }
        let signal = watch.signals(&config, 0.0, &[0.0])[0];
        assert_eq!(
            (signal.episode_excess(), signal.fresh_cost, signal.fresh_weight),
            (30.0, 80.0, 1.0)
        );
        for algorithm in
            [AlgorithmKind::P3o, AlgorithmKind::Cpo, AlgorithmKind::PpoSaute, AlgorithmKind::Ipo]
        {
            let mut other = TrainConfig::plain(algorithm, Preset::Paper, EnvConfig::new("test"));
            other.constraints[0].budget = 50.0;
            other.constraint_statistic = config.constraint_statistic;
            let message = other.check().unwrap_err().to_string();
            assert!(
                message.contains("cvar:0.1") && message.contains(algorithm.name()),
                "{message}"
            );
        }
    }
}
