//! Whether the critics of the costs expect what comes: their predictions against the discounted
//! cost that followed.

use hasard_envs::Episode;
use serde::{Deserialize, Serialize};

use crate::config::TrainConfig;
use crate::runs::evaluation::Trace;

/// Steps of which a time-out may cut off no more than this share of a cost to come that never ends.
const CUT: f64 = 0.05;
/// Bins of equal numbers of steps.
const BINS: usize = 10;

/// What a critic expected at a step, and what came.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Prediction {
    /// Number of the episode.
    pub episode: usize,
    /// Step of it, from 0.
    pub step: usize,
    /// Number of the constraint.
    pub constraint: usize,
    /// Discounted cost to come, as the critic expected it.
    pub predicted: f64,
    /// The same as it came, up to the episode's end.
    pub observed: f64,
    /// Weight of what lay beyond a time-out, and was never seen; 0 where the episode ended by
    /// itself.
    pub cut: f64,
}

/// Predictions of some steps that are alike, and what came of them.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
pub struct Bin {
    /// Number of steps.
    pub steps: usize,
    /// Mean prediction.
    pub predicted: f64,
    /// Mean cost to come.
    pub observed: f64,
}

/// How a critic's predictions and what came agree.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Calibration {
    /// Name of the constraint's cost term; `null` for the scalar cost.
    pub term: Option<String>,
    /// Discount of the cost to come.
    pub gamma: f64,
    /// Steps that were compared: those of which a time-out cut off no more than a twentieth of the
    /// weight.
    pub steps: usize,
    /// Mean of prediction minus what came.
    pub bias: f64,
    /// Root of their mean squared difference.
    pub error: f64,
    /// The steps by rising prediction, in ten bins of equal numbers.
    pub bins: Vec<Bin>,
}

/// All predictions of some episodes, of costs discounted by `gamma`
/// ([`TrainConfig::cost_gamma_after`]).
#[must_use]
pub fn predictions(
    played: &[(Episode, Trace)],
    config: &TrainConfig,
    gamma: f64,
) -> Vec<Prediction> {
    let mut all = Vec::new();
    for (number, (episode, trace)) in played.iter().enumerate() {
        for (constraint, (expected, costs)) in trace.expected.iter().zip(&trace.costs).enumerate() {
            let (first, mut to_come) = (all.len(), 0.0);
            let mut cut =
                if episode.truncated && config.learning.bootstraps(true) { 1.0 } else { 0.0 };
            for (step, (&predicted, &cost)) in expected.iter().zip(costs).enumerate().rev() {
                to_come = cost + gamma * to_come;
                cut *= gamma;
                all.push(Prediction {
                    episode: number,
                    step,
                    constraint,
                    predicted,
                    observed: to_come,
                    cut,
                });
            }
            all[first..].reverse();
        }
    }
    all
}

/// The agreement of each critic.
#[must_use]
pub fn calibrate(predictions: &[Prediction], config: &TrainConfig, gamma: f64) -> Vec<Calibration> {
    let one = |(index, constraint): (usize, &crate::config::Constraint)| {
        let own = |one: &&Prediction| {
            one.constraint == index && one.cut <= CUT && one.predicted.is_finite()
        };
        let mut known: Vec<&Prediction> = predictions.iter().filter(own).collect();
        known.sort_by(|a, b| a.predicted.total_cmp(&b.predicted));
        let mean = |some: &[&Prediction], of: fn(&Prediction) -> f64| {
            some.iter().map(|one| of(one)).sum::<f64>() / some.len().max(1) as f64
        };
        let count = known.len();
        let bins = (0..BINS)
            .map(|bin| &known[count * bin / BINS..count * (bin + 1) / BINS])
            .filter(|some| !some.is_empty());
        Calibration {
            term: constraint.term.clone(),
            gamma,
            steps: count,
            bias: mean(&known, |one| one.predicted - one.observed),
            error: mean(&known, |one| (one.predicted - one.observed).powi(2)).sqrt(),
            bins: bins
                .map(|some| Bin {
                    steps: some.len(),
                    predicted: mean(some, |one| one.predicted),
                    observed: mean(some, |one| one.observed),
                })
                .collect(),
        }
    };
    let critics = predictions.iter().map(|one| one.constraint + 1).max().unwrap_or(0);
    config.constraints.iter().enumerate().take(critics).map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{AlgorithmKind, Constraint, EnvConfig, Preset};

    fn played(costs: &[f64], predicted: &[f64], truncated: bool) -> (Episode, Trace) {
        let episode = Episode {
            task: None,
            lane: 0,
            seed: 0,
            episode_return: 0.0,
            cost: costs.iter().sum(),
            costs: vec![],
            length: costs.len() as u32,
            terminated: !truncated,
            truncated,
            stats: vec![],
        };
        (episode, Trace { expected: vec![predicted.to_vec()], costs: vec![costs.to_vec()] })
    }

    /// By hand at a discount of one half: the costs 1, 0, 4 make 1 + 0 + 1 = 2, then 0 + 2 = 2,
    /// then 4 to come; of an episode that the clock ends after them, an eighth, a quarter and a
    /// half of the weight was never seen.
    #[test]
    fn costs_to_come_are_those_worked_out_by_hand() {
        let mut config =
            TrainConfig::plain(AlgorithmKind::PpoLag, Preset::Paper, EnvConfig::new("test"));
        config.constraints = vec![Constraint { term: None, budget: 5.0 }];
        config.learning.bootstrap_cost_time_outs = Some(true);
        let all = predictions(&[played(&[1.0, 0.0, 4.0], &[3.0, 2.0, 3.0], false)], &config, 0.5);
        assert_eq!(all.iter().map(|one| one.observed).collect::<Vec<_>>(), [2.0, 2.0, 4.0]);
        assert_eq!(
            all.iter().map(|one| (one.step, one.cut)).collect::<Vec<_>>(),
            [(0, 0.0), (1, 0.0), (2, 0.0)]
        );
        let one = calibrate(&all, &config, 0.5).swap_remove(0);
        assert_eq!((one.steps, one.bias, one.bins.len(), one.gamma), (3, 0.0, 3, 0.5));
        assert!((one.error - (2.0f64 / 3.0).sqrt()).abs() < 1e-12);
        assert_eq!(one.bins[0], Bin { steps: 1, predicted: 2.0, observed: 2.0 });
        let cut = predictions(&[played(&[1.0, 0.0, 4.0], &[3.0, 2.0, 3.0], true)], &config, 0.5);
        assert_eq!(cut.iter().map(|one| one.cut).collect::<Vec<_>>(), [0.125, 0.25, 0.5]);
        assert_eq!(calibrate(&cut, &config, 0.5)[0].steps, 0, "too much of it was never seen");
        assert!(calibrate(&[], &config, 0.5).is_empty());
        // Where a time-out is an end of the task, nothing is cut off.
        config.learning.bootstrap_cost_time_outs = Some(false);
        let ends = predictions(&[played(&[1.0, 0.0, 4.0], &[3.0, 2.0, 3.0], true)], &config, 0.5);
        assert_eq!(calibrate(&ends, &config, 0.5)[0].steps, 3);
    }
}
