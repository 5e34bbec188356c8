use super::*;
use crate::algorithms::small;
use crate::config::AlgorithmKind;

/// As the code of PPOLag's tables had it: values of costs as the network says them, within +-5;
/// their returns normalised by the moments of the reward's returns, which have taken both in;
/// moments of their own never moved. Returns by the recursion of GAE (Schulman et al. 2016),
/// here with gamma and lambda 1, where they are plain sums up to the value after the last step.
#[test]
fn costs_may_use_the_rewards_normaliser() {
    let mut config = small::config(AlgorithmKind::PpoLag);
    (config.learning.gamma, config.learning.gae_lambda) = (1.0, 1.0);
    let make = |shared: bool| {
        let mut config = config.clone();
        config.learning.cost_uses_reward_normaliser = shared;
        let (mut learner, rollout) = small::learner(&config);
        learner.returns[0] = Moments { count: 50.0, mean: 2.0, variance: 9.0 };
        let prepared = learner.prepare(&rollout);
        let (targets, moments) = (prepared.targets.clone(), learner.returns.clone());
        let part = &rollout.parts[0];
        let width = part.outputs.len() / ((small::STEPS + 1) * small::LANES);
        let mut sums = Vec::new();
        for lane in 0..small::LANES {
            for step in 0..small::STEPS {
                let costs: f32 =
                    (step..small::STEPS).map(|later| part.costs[later * small::LANES + lane]).sum();
                let last = part.outputs[(small::STEPS * small::LANES + lane) * width + width - 1];
                sums.push(costs + last.clamp(-5.0, 5.0));
            }
        }
        (targets, moments, sums)
    };
    let (targets, moments, sums) = make(true);
    let (_, plain, _) = make(false);
    let mut both = plain[0];
    both.update(&sums);
    assert!(
        (moments[0].mean - both.mean).abs() < 1e-5
            && (moments[0].variance - both.variance).abs() < 1e-5
    );
    assert_eq!((moments[0].count, moments[1]), (both.count, Moments::default()));
    assert_ne!(plain[1], Moments::default());
    for (target, sum) in targets[1].iter().zip(&sums) {
        assert!(
            (target - both.normalise(*sum)).abs() < 1e-5,
            "{target} against {}",
            both.normalise(*sum)
        );
    }
}

/// What is predicted of pictures moves the parameters beside everything else: the gradient of the
/// whole loss, along directions through all of them, is that of central differences.
#[test]
fn predictions_have_their_part_in_the_gradient() {
    let mut config = small::config(AlgorithmKind::PpoLag);
    (config.learning.auxiliary_depth, config.learning.auxiliary_labels) = (0.7, 0.4);
    let (mut learner, rollout) = small::learner(&config);
    let prepared = learner.prepare(&rollout);
    let mut minibatch = learner.minibatch(&prepared, &[2, 0, 3]);
    let mut at = |parameters: &[f32]| {
        learner.parameters.copy_from_slice(parameters);
        learner.replaced();
        let mut means = Means::default();
        let loss = |heads: &Heads, _: &Minibatch<'_>, _: &mut Means| {
            heads.mean_of(&heads.values[1]) + heads.mean_of(&heads.log_probability)
        };
        let gradient = learner.gradient(0..1, &mut minibatch, loss, &mut means).unwrap();
        learner.gradient = gradient.clone();
        let parts = ["auxiliary_depth_loss", "auxiliary_labels_loss", "loss"];
        (parts.map(|name| means.get(name).unwrap()), gradient)
    };
    let before = learner_parameters(&config);
    let ([depth, labels, _], gradient) = at(&before);
    // About those of guesses: logarithms of 8 and 11.
    assert!((depth - 2.08).abs() < 0.5 && (labels - 2.40).abs() < 0.6, "{depth} {labels}");
    for turn in 1..5u8 {
        let direction: Vec<f32> =
            (0..before.len()).map(|index| (index as f32 * f32::from(turn)).sin()).collect();
        let moved = |by: f32| -> Vec<f32> {
            before.iter().zip(&direction).map(|(value, step)| value + by * step).collect()
        };
        let (ahead, behind) = (at(&moved(1e-3)).0[2], at(&moved(-1e-3)).0[2]);
        let expected = (ahead - behind) / 2e-3;
        let found: f64 =
            gradient.iter().zip(&direction).map(|(&a, &b)| f64::from(a) * f64::from(b)).sum();
        assert!(
            (found - expected).abs() < 0.02 * expected.abs().max(0.3),
            "direction {turn}: {found} against {expected}"
        );
    }
}

fn learner_parameters(config: &TrainConfig) -> Vec<f32> {
    small::learner(config).0.parameters
}

/// Some trajectories of a minibatch are what a minibatch of those trajectories is, in every field:
/// critics of second-order algorithms learn in such parts.
#[test]
fn a_part_of_a_minibatch_equals_one_of_its_trajectories() {
    let mut config = small::config(AlgorithmKind::PpoLag);
    (config.learning.auxiliary_depth, config.learning.auxiliary_labels) = (0.7, 0.4);
    let (mut learner, rollout) = small::learner(&config);
    let prepared = learner.prepare(&rollout);
    let all: Vec<usize> = (0..small::LANES).collect();
    let whole = learner.minibatch(&prepared, &all);
    learner.refresh();
    for lanes in [&[2, 0][..], &[3], &[1, 2, 3]] {
        let (mut part, mut plain) =
            (whole.of_lanes(learner.shape(), lanes), learner.minibatch(&prepared, lanes));
        assert_eq!(part.taken.actions, plain.taken.actions);
        assert_eq!(part.taken.deltas, plain.taken.deltas);
        assert_eq!(part.old_log_probability, plain.old_log_probability);
        assert_eq!(part.shown, plain.shown);
        assert_eq!(part.old_policy.divergence(&plain.old_policy).mean(), 0.0);
        assert_eq!(part.critics.len(), 2);
        for (part, plain) in part.critics.iter().zip(&plain.critics) {
            assert_eq!(part.advantages, plain.advantages);
            assert_eq!(part.old_values, plain.old_values);
            assert_eq!(part.targets, plain.targets);
        }
        // What the network reads: it says the same of both.
        let networks = 0..learner.shape().networks.len();
        let said = learner.networks.forward(networks.clone(), &mut part.batch);
        assert_eq!(said, learner.networks.forward(networks, &mut plain.batch));
    }
}

/// The loss of the mean of each critic's values and of the log-probabilities.
fn some_loss(heads: &Heads, _: &Minibatch<'_>, _: &mut Means) -> Loss {
    heads.mean_of(&heads.values[1]) + heads.mean_of(&heads.log_probability)
}

/// Pascanu et al. 2013, algorithm 1: a gradient longer than the largest norm allowed is scaled
/// down to it, g <- g * largest / |g|. Adam's first moment after its first step is (1 - beta1) g.
#[test]
fn a_long_gradient_is_cut_down() {
    let moment_at = |share: f64| {
        let config = small::config(AlgorithmKind::PpoLag);
        let (mut learner, rollout) = small::learner(&config);
        let prepared = learner.prepare(&rollout);
        let mut minibatch = learner.minibatch(&prepared, &[0, 1, 2, 3]);
        let gradient =
            learner.gradient(0..1, &mut minibatch, some_loss, &mut Means::default()).unwrap();
        let norm = gradient.iter().map(|&value| f64::from(value).powi(2)).sum::<f64>().sqrt();
        learner.gradient = gradient.clone();
        learner.config.learning.max_gradient_norm = norm * share;
        learner.descend(&mut minibatch, some_loss, &mut Means::default()).unwrap();
        (learner.optimisers[0].first.clone(), gradient)
    };
    for (share, scale) in [(0.25, 0.25), (4.0, 1.0), (0.0, 1.0)] {
        let (first, gradient) = moment_at(share);
        let beta = small::config(AlgorithmKind::PpoLag).learning.adam_betas.0;
        let largest = gradient.iter().fold(0.0f64, |most, &one| most.max(f64::from(one).abs()));
        for (found, one) in first.iter().zip(&gradient) {
            let expected = (1.0 - beta) * f64::from(*one) * scale;
            assert!(
                (f64::from(*found) - expected).abs() < 1e-6 * largest,
                "share {share}: {found}, not {expected}"
            );
        }
    }
}

/// Critics of their own may have a rate of their own: with a tenth of it they move a tenth as far,
/// and the policy as far as before.
#[test]
fn critics_have_a_rate_of_their_own() {
    let moved = |critic_rate: Option<f64>| {
        let mut config = small::config(AlgorithmKind::TrpoLag);
        config.learning.critic_rate = critic_rate;
        let (mut learner, rollout) = small::learner(&config);
        let prepared = learner.prepare(&rollout);
        let mut minibatch = learner.minibatch(&prepared, &[0, 1, 2, 3]);
        let before = learner.parameters.clone();
        learner.descend(&mut minibatch, some_loss, &mut Means::default()).unwrap();
        let policy = learner.shape().parameter_range(0).end;
        let apart: Vec<f32> =
            learner.parameters.iter().zip(&before).map(|(now, then)| now - then).collect();
        (apart[..policy].to_vec(), apart[policy..].to_vec())
    };
    let rate = small::config(AlgorithmKind::TrpoLag).learning.rate;
    let ((policy, critics), (same, slower)) = (moved(None), moved(Some(rate / 10.0)));
    assert_eq!(policy, same);
    let most = critics.iter().fold(0.0f32, |most, step| most.max(step.abs()));
    assert!(most > 1e-6);
    for (slow, step) in slower.iter().zip(&critics) {
        assert!((slow - step / 10.0).abs() < 0.01 * most, "{slow} beside {step}");
    }
}
