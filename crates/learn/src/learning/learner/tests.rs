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
