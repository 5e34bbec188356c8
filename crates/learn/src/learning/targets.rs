//! What is learned from a rollout: advantages and targets of every critic.

use crate::config::{ReturnNormaliser, TrainConfig};
use crate::learning::advantage::{Lane, generalised_advantages};
use crate::learning::normaliser::{CLIP, Moments};
use crate::networks::ModelShape;
use crate::sampling::rollout::Rollout;

/// A rollout with advantages and targets. Critic 0 is that of the reward, the others are those of
/// the costs; values of lane `l` at step `t` are at `l * steps + t`.
pub struct Prepared<'a> {
    /// The rollout.
    pub rollout: &'a Rollout,
    /// Advantages of each critic, in raw units.
    pub advantages: Vec<Vec<f32>>,
    /// Normalised returns of each critic.
    pub targets: Vec<Vec<f32>>,
    /// Normalised values of each critic when the actions were taken.
    pub old_values: Vec<Vec<f32>>,
    /// Share of the variance of each critic's returns that its values explain.
    explained: Vec<f64>,
    /// Mean cost of each constraint per step.
    pub mean_costs: Vec<f64>,
    /// What the values of each critic were normalised by when the actions were taken.
    pub acted_by: Vec<Moments>,
}

impl Prepared<'_> {
    /// Share of the variance of each critic's returns that its values explain: 1 is perfect, 0 no
    /// better than their mean.
    #[must_use]
    pub fn explained_variances(&self, config: &TrainConfig) -> Vec<(String, f64)> {
        let named = |(critic, &share): (usize, &f64)| {
            (critic_name("explained_variance", config, critic), share)
        };
        self.explained.iter().enumerate().map(named).collect()
    }
}

/// The share of the variance of returns that the values explain: what they leave is the advantages,
/// in the same unit.
fn explained(returns: &[f32], advantages: &[f32]) -> f64 {
    let variance = |values: &[f32]| {
        let count = values.len() as f64;
        let mean = values.iter().map(|&value| f64::from(value)).sum::<f64>() / count;
        values.iter().map(|&value| (f64::from(value) - mean).powi(2)).sum::<f64>() / count
    };
    1.0 - variance(advantages) / variance(returns)
}

/// What a number of a critic is called in reports: that of a cost says so, that of a named cost
/// says which.
pub(crate) fn critic_name(what: &str, config: &TrainConfig, critic: usize) -> String {
    match critic.checked_sub(1).map(|index| &config.constraints[index].term) {
        None => what.into(),
        Some(None) => format!("cost_{what}"),
        Some(Some(term)) => format!("cost_{what}/{term}"),
    }
}

/// Mean cost of each constraint over the steps of some trajectories.
pub(crate) fn mean_costs(
    rollout: &Rollout,
    trajectories: &[usize],
    constraints: usize,
) -> Vec<f64> {
    let mut sums = vec![0.0; constraints];
    let steps = rollout.trajectory_steps();
    for (lane, first) in trajectories.iter().map(|&number| rollout.trajectory(number)) {
        let (part, own) = rollout.find(lane);
        for step in first..first + steps {
            let row = (step * part.lanes + own) * constraints;
            for (sum, &cost) in sums.iter_mut().zip(&part.costs[row..row + constraints]) {
                *sum += f64::from(cost);
            }
        }
    }
    let count = (trajectories.len() * steps) as f64;
    sums.iter().map(|sum| sum / count).collect()
}

/// The statistics of a critic's returns before a rollout and after it.
pub(crate) type Shift = (usize, Moments, Moments);

/// Computes a rollout's advantages and targets, and takes its returns into the statistics of each
/// critic; those that moved, where the networks' outputs must be preserved.
pub(crate) fn prepare<'a>(
    rollout: &'a Rollout,
    shape: &ModelShape,
    config: &TrainConfig,
    moments_of: &mut [Moments],
) -> (Prepared<'a>, Vec<Shift>) {
    let (steps, lanes) = (rollout.steps(), rollout.lanes());
    let (width, first) = (shape.outputs(), shape.value_column());
    let constraints = config.constraints.len();
    let settings = &config.learning;
    let mut prepared = Prepared {
        rollout,
        advantages: Vec::new(),
        targets: Vec::new(),
        old_values: Vec::new(),
        explained: Vec::new(),
        mean_costs: vec![0.0; constraints],
        acted_by: Vec::new(),
    };
    let popart = settings.normaliser == ReturnNormaliser::PopArt;
    let shared = settings.cost_uses_reward_normaliser;
    let mut moved = Vec::new();
    for critic in 0..moments_of.len() {
        let moments = &mut moments_of[if shared { 0 } else { critic }];
        let value = |lane: usize, step: usize| {
            let (part, own) = rollout.find(lane);
            part.outputs[(step * part.lanes + own) * width + first + critic]
        };
        let before = *moments;
        let by = (&before, &before);
        let (advantages, returns) = estimates(rollout, shape, config, critic, by, value);
        prepared.acted_by.push(before);
        let mut old_values: Vec<f32> =
            (0..lanes).flat_map(|lane| (0..steps).map(move |step| value(lane, step))).collect();
        if popart {
            moments.update_forgetting(&returns, settings.normaliser_horizon);
            old_values
                .iter_mut()
                .for_each(|value| *value = moments.scale_down(before.scale_up(*value)));
            moved.push((critic, before, *moments));
        } else {
            moments.update(&returns);
        }
        prepared.targets.push(normalised(&returns, moments, config));
        prepared.explained.push(explained(&returns, &advantages));
        prepared.advantages.push(advantages);
        prepared.old_values.push(old_values);
    }
    let all: Vec<usize> = (0..rollout.trajectories()).collect();
    prepared.mean_costs = mean_costs(rollout, &all, constraints);
    (prepared, moved)
}

/// The same rollout with the advantages and targets that follow from other normalised values of a
/// critic at each lane and step, the one after the last too. What came after a time-out keeps the
/// worth that the actors gave it.
pub(crate) fn prepare_anew<'a>(
    prepared: &Prepared<'a>,
    shape: &ModelShape,
    config: &TrainConfig,
    moments_of: &[Moments],
    value: impl Fn(usize, usize, usize) -> f32,
) -> Prepared<'a> {
    let shared = config.learning.cost_uses_reward_normaliser;
    let (mut advantages, mut targets) = (Vec::new(), Vec::new());
    for critic in 0..moments_of.len() {
        let moments = &moments_of[if shared { 0 } else { critic }];
        let value = |lane: usize, step: usize| value(critic, lane, step);
        let by = (moments, &prepared.acted_by[critic]);
        let (own, returns) = estimates(prepared.rollout, shape, config, critic, by, value);
        targets.push(normalised(&returns, moments, config));
        advantages.push(own);
    }
    Prepared {
        rollout: prepared.rollout,
        advantages,
        targets,
        old_values: prepared.old_values.clone(),
        explained: prepared.explained.clone(),
        mean_costs: prepared.mean_costs.clone(),
        acted_by: prepared.acted_by.clone(),
    }
}

/// Returns as a critic is to predict them.
fn normalised(returns: &[f32], moments: &Moments, config: &TrainConfig) -> Vec<f32> {
    match config.learning.normaliser {
        ReturnNormaliser::PopArt => {
            returns.iter().map(|&value| moments.scale_down(value)).collect()
        }
        ReturnNormaliser::Running => {
            returns.iter().map(|&value| moments.normalise(value)).collect()
        }
    }
}

/// Advantages and returns of a critic, in raw units, from its normalised value of each lane and
/// step. `moments` are what these are normalised by, and what those after a time-out are, which the
/// actors gave.
fn estimates(
    rollout: &Rollout,
    shape: &ModelShape,
    config: &TrainConfig,
    critic: usize,
    (moments, acted_by): (&Moments, &Moments),
    value: impl Fn(usize, usize) -> f32,
) -> (Vec<f32>, Vec<f32>) {
    let (steps, lanes) = (rollout.steps(), rollout.lanes());
    let (constraints, settings) = (config.constraints.len(), &config.learning);
    let column = shape.value_column() + critic;
    let raw = |value: f32, moments: &Moments| match settings.normaliser {
        _ if settings.cost_uses_reward_normaliser && critic > 0 => value.clamp(-CLIP, CLIP),
        ReturnNormaliser::PopArt => moments.scale_up(value),
        ReturnNormaliser::Running => moments.denormalise(value),
    };
    let gamma =
        if critic == 0 { settings.gamma } else { settings.cost_gamma.unwrap_or(settings.gamma) };
    let mut advantages = vec![0.0; steps * lanes];
    let mut returns = vec![0.0; steps * lanes];
    for lane in 0..lanes {
        let (part, own) = rollout.find(lane);
        let row = |step: usize| step * part.lanes + own;
        let values: Vec<f32> = (0..=steps).map(|step| raw(value(lane, step), moments)).collect();
        let rewards: Vec<f32> = (0..steps)
            .map(|step| match critic {
                0 => part.rewards[row(step)],
                cost => part.costs[row(step) * constraints + cost - 1],
            })
            .collect();
        let done: Vec<bool> = (0..steps).map(|step| part.done[row(step)]).collect();
        let mut cut_off_values = vec![0.0; steps];
        if settings.bootstraps(critic > 0) {
            for (cut, outputs) in part.cut_off.iter().filter(|(cut, _)| cut % part.lanes == own) {
                cut_off_values[cut / part.lanes] = raw(outputs[column], acted_by);
            }
        }
        let out = &mut advantages[lane * steps..(lane + 1) * steps];
        let lane_values = Lane {
            rewards: &rewards,
            done: &done,
            cut_off_values: &cut_off_values,
            values: &values,
        };
        generalised_advantages(lane_values, gamma as f32, settings.gae_lambda as f32, out);
        for step in 0..steps {
            returns[lane * steps + step] = out[step] + values[step];
        }
    }
    (advantages, returns)
}

#[cfg(test)]
mod tests {
    use super::explained;

    /// By hand: returns of variance 1/4; values that are all 1/10 off explain them wholly, those
    /// that leave a variance of 1/16 three quarters, their mean nothing.
    #[test]
    fn what_values_leave_is_not_explained() {
        let returns = [0.0, 1.0, 0.0, 1.0];
        for (advantages, share) in
            [([0.1; 4], 1.0), ([0.25, -0.25, 0.25, -0.25], 0.75), ([-0.5, 0.5, -0.5, 0.5], 0.0)]
        {
            assert!((explained(&returns, &advantages) - share).abs() < 1e-6, "{share}");
        }
    }
}
