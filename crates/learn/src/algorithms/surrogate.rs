//! Terms that the losses of several algorithms share.

use burn::tensor::Tensor;

use crate::config::{Exploration, LearningConfig};
use crate::learning::learner::{Heads, Loss, Minibatch};

/// Bounds of the probability ratio: a sample so far off the policy that acted says nothing.
const RATIO_BOUNDS: (f64, f64) = (0.05, 20.0);

/// Zero mean and unit (unbiased) deviation.
#[must_use]
pub fn standardised(mut values: Vec<f32>) -> Vec<f32> {
    let (mean, deviation) = mean_and_deviation(&values);
    for value in &mut values {
        *value = ((f64::from(*value) - mean) / deviation.max(1e-7)) as f32;
    }
    values
}

/// Zero mean.
#[must_use]
pub fn centred(mut values: Vec<f32>) -> Vec<f32> {
    let (mean, _) = mean_and_deviation(&values);
    for value in &mut values {
        *value -= mean as f32;
    }
    values
}

fn mean_and_deviation(values: &[f32]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().map(|&v| f64::from(v)).sum::<f64>() / count;
    let squares: f64 = values.iter().map(|&v| (f64::from(v) - mean).powi(2)).sum();
    (mean, (squares / (count - 1.0).max(1.0)).sqrt())
}

/// The reward's advantages minus those of the costs times their multipliers, in raw units.
#[must_use]
pub fn lagrangian_advantages(minibatch: &Minibatch<'_>, multipliers: &[f64]) -> Vec<f32> {
    let mut mixed = minibatch.advantages[0].clone();
    for (costs, &multiplier) in minibatch.advantages[1..].iter().zip(multipliers) {
        for (mixed, cost) in mixed.iter_mut().zip(costs) {
            *mixed -= multiplier as f32 * cost;
        }
    }
    mixed
}

/// Probability of the actions taken now over that when they were taken.
#[must_use]
pub fn ratio(heads: &Heads, minibatch: &Minibatch<'_>) -> Tensor<1> {
    (heads.policy.log_probability(&minibatch.taken) - minibatch.old_log_probability.clone()).exp()
}

/// PPO's policy loss for advantages.
#[must_use]
pub fn clipped_policy_loss(ratio: &Tensor<1>, advantages: &Tensor<1>, clip: f64) -> Tensor<1> {
    let ratio = ratio.clone().clamp(RATIO_BOUNDS.0, RATIO_BOUNDS.1);
    let free = ratio.clone() * advantages.clone();
    let clipped = clip_ratio(ratio, clip) * advantages.clone();
    -free.min_pair(clipped).mean()
}

/// A ratio within 1/(1+clip) and 1+clip.
#[must_use]
pub fn clip_ratio(ratio: Tensor<1>, clip: f64) -> Tensor<1> {
    ratio.clamp(1.0 / (1.0 + clip), 1.0 + clip)
}

/// Squared error of a critic, the larger of that with and without the change clipped.
#[must_use]
pub fn value_loss(heads: &Heads, minibatch: &Minibatch<'_>, critic: usize, settings: &LearningConfig) -> Tensor<1> {
    let (value, old) = (heads.values[critic].clone(), minibatch.old_values[critic].clone());
    let target = minibatch.targets[critic].clone();
    let change = (value.clone() - old.clone()).clamp(-settings.clip_value, settings.clip_value);
    let free = (value - target.clone()).powi_scalar(2);
    let clipped = (old + change - target).powi_scalar(2);
    free.max_pair(clipped).mean() * settings.value_coefficient
}

/// The loss that keeps the policy from settling too early.
#[must_use]
pub fn exploration_loss(heads: &Heads, settings: &LearningConfig) -> Tensor<1> {
    match settings.exploration {
        Exploration::SymmetricKl => {
            heads.policy.symmetric_divergence_from_uniform().mean().clamp_max(30.0) * settings.exploration_coefficient
        }
        Exploration::Entropy => -heads.policy.entropy().mean() * settings.exploration_coefficient,
    }
}

/// Policy loss, exploration and the losses of all critics as one loss, with what is worth reporting.
#[must_use]
pub fn total(policy_loss: Tensor<1>, heads: &Heads, minibatch: &Minibatch<'_>, settings: &LearningConfig) -> Loss {
    let exploration = exploration_loss(heads, settings);
    let mut total = policy_loss.clone() + exploration.clone();
    let mut parts = vec![("policy_loss", policy_loss), ("exploration_loss", exploration)];
    for critic in 0..heads.values.len() {
        let loss = value_loss(heads, minibatch, critic, settings);
        total = total + loss.clone();
        parts.push((if critic == 0 { "value_loss" } else { "cost_value_loss" }, loss));
    }
    parts.extend(policy_statistics(heads, minibatch));
    Loss { total, parts }
}

/// Entropy, divergence from the policy that acted, and how far the ratios are from 1; no gradients.
#[must_use]
pub fn policy_statistics(heads: &Heads, minibatch: &Minibatch<'_>) -> Vec<(&'static str, Tensor<1>)> {
    let ratio = ratio(heads, minibatch).detach();
    vec![
        ("entropy", heads.policy.entropy().mean().detach()),
        ("kl_divergence", minibatch.old_policy.divergence(&heads.policy).mean().detach()),
        ("ratio_deviation", (ratio - 1.0).abs().mean()),
        ("value", heads.values[0].clone().mean().detach()),
    ]
}
