//! Terms that the losses of several algorithms share.

use crate::config::{Exploration, LearningConfig};
use crate::learning::dual_number::DualNumber;
use crate::learning::learner::{Critic, Minibatch};
use crate::learning::loss::{Heads, Loss};
use crate::learning::metrics::Means;
use crate::learning::policy::Column;

/// Bounds of the probability ratio: a sample so far off the policy that acted says nothing.
const RATIO_BOUNDS: (f64, f64) = (0.05, 20.0);

/// Zero mean and unit (unbiased) deviation, or less: advantages that are all next to nothing are the
/// critics' noise, which is not blown up beyond what `advantage_floor` says.
#[must_use]
pub fn standardised(values: &[f32], settings: &LearningConfig) -> Vec<f64> {
    standardised_by(values, settings.advantage_floor).0
}

/// Zero mean and unit (unbiased) deviation, and the deviation that they were divided by: at least
/// `floor`.
#[must_use]
pub fn standardised_by(values: &[f32], floor: f64) -> (Vec<f64>, f64) {
    let centred = centred(values);
    let squares: f64 = centred.iter().map(|value| value * value).sum();
    let deviation = (squares / (values.len() as f64 - 1.0).max(1.0)).sqrt().max(floor.max(1e-7));
    (centred.iter().map(|value| value / deviation).collect(), deviation)
}

/// Zero mean.
#[must_use]
pub fn centred(values: &[f32]) -> Vec<f64> {
    let mean = values.iter().map(|&value| f64::from(value)).sum::<f64>() / values.len() as f64;
    values.iter().map(|&value| f64::from(value) - mean).collect()
}

/// The reward's advantages minus those of the costs times their multipliers, in raw units.
#[must_use]
pub fn lagrangian_advantages(minibatch: &Minibatch<'_>, multipliers: &[f64]) -> Vec<f32> {
    let mut mixed = minibatch.advantages().to_vec();
    for (cost, &multiplier) in minibatch.costs().iter().zip(multipliers) {
        for (mixed, advantage) in mixed.iter_mut().zip(&cost.advantages) {
            *mixed -= multiplier as f32 * advantage;
        }
    }
    mixed
}

/// PPO's policy loss for advantages.
#[must_use]
pub fn clipped_policy_loss(heads: &Heads, advantages: &[f64], clip: f64) -> Loss {
    heads.mean([&heads.ratio], |row, [ratio]| {
        let ratio = ratio.clamp(RATIO_BOUNDS.0, RATIO_BOUNDS.1);
        -(ratio * advantages[row]).min(clip_ratio(ratio, clip) * advantages[row])
    })
}

/// A ratio within 1/(1+clip) and 1+clip.
#[must_use]
pub fn clip_ratio(ratio: DualNumber<1>, clip: f64) -> DualNumber<1> {
    ratio.clamp(1.0 / (1.0 + clip), 1.0 + clip)
}

/// Squared error of a critic, the larger of that with and without the change clipped.
#[must_use]
pub fn value_loss(
    heads: &Heads,
    value: &Column,
    critic: &Critic,
    settings: &LearningConfig,
) -> Loss {
    let loss = heads.mean([value], |row, [value]| {
        let (old, target) = (f64::from(critic.old_values[row]), f64::from(critic.targets[row]));
        let clipped = (value - old).clamp(-settings.clip_value, settings.clip_value) + old;
        (value - target).square().max((clipped - target).square())
    });
    loss * settings.value_coefficient
}

/// The loss that keeps the policy from settling too early.
#[must_use]
pub fn exploration_loss(heads: &Heads, kind: Exploration, coefficient: f64) -> Loss {
    let loss = match kind {
        Exploration::SymmetricKl => {
            heads.mean_of(&heads.policy.symmetric_divergence_from_uniform()).at_most(30.0)
        }
        Exploration::Entropy => heads.mean_of(&heads.policy.entropy()) * -1.0,
    };
    loss * coefficient
}

/// Policy loss, exploration and the losses of all critics as one loss; notes what is worth
/// reporting.
#[must_use]
pub fn total(
    policy_loss: Loss,
    heads: &Heads,
    minibatch: &Minibatch<'_>,
    settings: &LearningConfig,
    means: &mut Means,
) -> Loss {
    means.add("policy_loss", policy_loss.value);
    let exploration =
        exploration_loss(heads, settings.exploration, minibatch.exploration_coefficient);
    means.add("exploration_loss", exploration.value);
    let total = policy_loss + exploration + critics_loss(heads, minibatch, settings, means);
    means.add("value", heads.values[0].mean());
    note_policy(heads, minibatch, settings.clip_ratio, means);
    total
}

/// The losses of all critics.
#[must_use]
pub fn critics_loss(
    heads: &Heads,
    minibatch: &Minibatch<'_>,
    settings: &LearningConfig,
    means: &mut Means,
) -> Loss {
    let losses = heads.values.iter().zip(&minibatch.critics).map(|(value, critic)| {
        let loss = value_loss(heads, value, critic, settings);
        means.add(critic.loss_name.clone(), loss.value);
        loss
    });
    losses.reduce(|sum, loss| sum + loss).expect("the reward has a critic")
}

/// Notes the policy's entropy, and how far it has moved from the one that acted: its divergence,
/// the estimate of it from the ratios (Schulman's k3, whose samples are never negative), their mean
/// distance from 1, and the share beyond the clip.
pub fn note_policy(heads: &Heads, minibatch: &Minibatch<'_>, clip: f64, means: &mut Means) {
    let ratios = &heads.ratio.values;
    let mean = |of: &dyn Fn(f64) -> f64| {
        ratios.iter().map(|&ratio| of(ratio)).sum::<f64>() / ratios.len() as f64
    };
    means.add("entropy", heads.policy.entropy().mean());
    means.add("kl_divergence", minibatch.old_policy.divergence(&heads.policy).mean());
    means.add("approx_kl", mean(&|ratio| ratio - 1.0 - libm::log(ratio)));
    means.add("ratio_deviation", mean(&|ratio| (ratio - 1.0).abs()));
    means.add(
        "clip_fraction",
        mean(&|ratio| f64::from(u8::from(!(1.0 / (1.0 + clip)..=1.0 + clip).contains(&ratio)))),
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Noise of a thousandth stays small under a floor of a hundredth, real advantages are divided
    /// by their own deviation, and all that are alike give zeros.
    #[test]
    fn a_floor_keeps_noise_small() {
        let deviation = |values: &[f64]| {
            let squares: f64 = values.iter().map(|value| value * value).sum();
            (squares / (values.len() as f64 - 1.0)).sqrt()
        };
        let noise = [0.001_f32, -0.001, 0.001, -0.001];
        let real = noise.map(|value| 100.0 * value);
        for (floor, small, large) in
            [(0.0, 1.0, 1.0), (0.01, 0.11547, 1.0), (1.0, 0.0011547, 0.11547)]
        {
            for (values, expected) in [(noise, small), (real, large)] {
                let found = deviation(&standardised_by(&values, floor).0);
                assert!((found - expected).abs() < 1e-4 * expected, "{found} for {floor}");
            }
        }
        assert_eq!(standardised_by(&[3.0; 4], 0.0).0, [0.0; 4]);
    }
}
