//! What critics learn from: trajectories of long rollouts, what only they see, and time-outs.

mod tiny;

use hasard_learn::config::{AlgorithmKind, CriticInput, ReturnNormaliser, TrainConfig};
use hasard_learn::runs::session::{Beginning, Session};
use hasard_learn::runs::trainer::Start;
use std::fs;

/// CPO on rollouts of 24 steps in trajectories of 8, with three steps of the critics on a quarter
/// of the trajectories each. Episodes have ten steps, so that trajectories begin in the middle of
/// them.
fn cut(algorithm: AlgorithmKind) -> TrainConfig {
    let mut config = tiny::config(algorithm);
    (config.sampling.rollout, config.learning.recurrence) = (24, Some(8));
    (config.learning.epochs, config.learning.minibatches) = (1, 1);
    (config.algorithm_settings.critic_steps, config.algorithm_settings.critic_batch) =
        (3, Some(192));
    config
}

fn seen_by_critics(mut config: TrainConfig) -> TrainConfig {
    config.learning.critic_inputs = CriticInput::ALL.to_vec();
    config
}

/// A5, A11: the learner, with the weights that acted, says of every step what the actor said of it:
/// the same policy and the same values. A trajectory that began in another state, or critics that
/// were shown another moment, would not.
#[test]
fn the_learner_sees_what_the_actors_saw() {
    for config in [
        cut(AlgorithmKind::Cpo),
        seen_by_critics(cut(AlgorithmKind::TrpoLag)),
        seen_by_critics(cut(AlgorithmKind::PpoLag)),
    ] {
        let name = config.algorithm;
        let mut session = Session::new(config, &Beginning::Nothing, &tiny::worlds).unwrap();
        // The second rollout: it begins in the middle of episodes too.
        let first = session.gatherer.next_rollout().unwrap();
        session.go_on(first);
        let rollout = session.gatherer.next_rollout().unwrap();
        assert_eq!((rollout.trajectories(), rollout.trajectory_steps()), (96, 8));
        let prepared = session.learner.prepare(&rollout);
        let all: Vec<usize> = (0..rollout.trajectories()).collect();
        let mut minibatch = session.learner.minibatch(&prepared, &all);
        let networks = 0..session.learner.shape().networks.len();
        let mut values = Vec::new();
        let seen = |heads: &hasard_learn::learning::loss::Heads,
                    batch: &hasard_learn::learning::learner::Minibatch<'_>,
                    _: &mut _| {
            let divergence = batch.old_policy.divergence(&heads.policy).mean();
            assert!(
                divergence.abs() < 1e-12,
                "{name}: the policy is {divergence} away from the one that acted"
            );
            values = heads.values.iter().map(|column| column.values.clone()).collect();
            heads.mean_of(&heads.values[0])
        };
        let _ = session
            .learner
            .gradient(
                networks,
                &mut minibatch,
                seen,
                &mut hasard_learn::learning::metrics::Means::default(),
            )
            .unwrap();
        assert_eq!(values.len(), 2);
        for (values, critic) in values.iter().zip(&minibatch.critics) {
            let apart = values
                .iter()
                .zip(&critic.old_values)
                .map(|(now, then)| (now - f64::from(*then)).abs());
            assert!(
                apart.fold(0.0, f64::max) < 1e-6,
                "{name}: the critics do not say what they said"
            );
            let spread = critic
                .old_values
                .iter()
                .fold(0.0f32, |most, value| most.max((value - critic.old_values[0]).abs()));
            assert!(spread > 1e-3, "{name}: values that do not differ show nothing");
        }
    }
}

/// A11: with the limit as part of the task nothing comes after it. One-step advantages (lambda 0)
/// at a time-out are then cost - V, where a cut-off episode has the value of what would have come
/// as well; rewards have it as before.
#[test]
fn costs_end_at_the_time_out_where_critics_see_it_coming() {
    let plain = tiny::config(AlgorithmKind::PpoLag);
    let mut forced = plain.clone();
    forced.learning.bootstrap_cost_time_outs = Some(false);
    for (mut config, cost_goes_on) in
        [(plain.clone(), true), (forced, false), (seen_by_critics(plain), false)]
    {
        config.learning.gae_lambda = 0.0;
        let mut session = Session::new(config, &Beginning::Nothing, &tiny::worlds).unwrap();
        let rollout = session.gatherer.next_rollout().unwrap();
        let moments = session.learner.returns.clone();
        let prepared = session.learner.prepare(&rollout);
        let steps = rollout.steps();
        let mut ends = 0;
        for lane in 0..rollout.lanes() {
            let (part, own) = rollout.find(lane);
            for step in (0..steps).filter(|step| part.done[step * part.lanes + own]) {
                let row = step * part.lanes + own;
                let at = lane * steps + step;
                let value =
                    |critic: usize| moments[critic].denormalise(prepared.old_values[critic][at]);
                let after = [part.rewards[row] - value(0), part.costs[row] - value(1)];
                let goes_on =
                    |critic: usize| (prepared.advantages[critic][at] - after[critic]).abs() > 1e-6;
                assert!(goes_on(0), "the reward's value of what would have come");
                assert_eq!(goes_on(1), cost_goes_on, "that of the cost");
                ends += 1;
            }
        }
        assert!(ends > 20, "{ends} time-outs");
    }
}

/// Andrychowicz et al. 2020 (arXiv 2006.05990) estimate advantages anew before a pass, by the
/// values of that moment: A_t = sum over k of (gamma lambda)^k (c + gamma V' - V) up to an
/// episode's end (Schulman et al. 2016, equation 16). The cost critic says 0.7 more of everything
/// here than when it acted, in every trajectory of the rollout and after its last step; what came
/// after a time-out is left out, since critics see it coming.
#[test]
fn advantages_are_estimated_anew_from_what_critics_say_now() {
    let mut config = seen_by_critics(cut(AlgorithmKind::PpoLag));
    config.learning.recompute_advantages = true;
    let mut session = Session::new(config.clone(), &Beginning::Nothing, &tiny::worlds).unwrap();
    let first = session.gatherer.next_rollout().unwrap();
    session.go_on(first);
    let rollout = session.gatherer.next_rollout().unwrap();
    let prepared = session.learner.prepare(&rollout);
    // The bias of the value's first output, before those of its slopes.
    let inputs = session.learner.shape().critic_inputs;
    let bias = session.learner.parameters.len() - 1 - inputs;
    session.learner.parameters[bias] += 0.7;
    session.learner.replaced();
    let anew = session.learner.prepare_anew(&prepared);
    assert_eq!(anew.old_values, prepared.old_values);
    let (moments, steps) = (session.learner.returns[1], rollout.steps());
    let outputs = session.learner.shape().outputs();
    let (gamma, lambda) = (config.learning.gamma, config.learning.gae_lambda);
    let mut ends = 0;
    for lane in 0..rollout.lanes() {
        let (part, own) = rollout.find(lane);
        let row = |step: usize| step * part.lanes + own;
        let value = |step: usize| {
            let said = part.outputs[row(step) * outputs + outputs - 1];
            f64::from(moments.denormalise(said + 0.7))
        };
        let surprise = |step: usize| {
            let after = if part.done[row(step)] { 0.0 } else { gamma * value(step + 1) };
            f64::from(part.costs[row(step)]) + after - value(step)
        };
        for step in 0..steps {
            let last = (step..steps - 1).find(|&later| part.done[row(later)]).unwrap_or(steps - 1);
            ends += usize::from(last < steps - 1);
            let expected: f64 = (step..=last)
                .map(|later| (gamma * lambda).powi((later - step) as i32) * surprise(later))
                .sum();
            let found = f64::from(anew.advantages[1][lane * steps + step]);
            assert!((found - expected).abs() < 1e-4, "{lane}, {step}: {found}, not {expected}");
            let target = moments.normalise((expected + value(step)) as f32);
            assert!((anew.targets[1][lane * steps + step] - target).abs() < 1e-4);
        }
    }
    assert!(ends > 100, "{ends}");
    // The reward's critic says what it said.
    let apart = |a: &[f32], b: &[f32]| a.iter().zip(b).any(|(a, b)| (a - b).abs() > 1e-3);
    assert!(apart(&anew.advantages[1], &prepared.advantages[1]));
}

/// A5: a rollout brings the critics as many steps as are asked for, and the policy one.
#[test]
fn critics_make_their_steps() {
    let mut session =
        Session::new(cut(AlgorithmKind::Cpo), &Beginning::Nothing, &tiny::worlds).unwrap();
    session.turn(&mut |warning| panic!("{warning}")).unwrap();
    let steps: Vec<u64> = session.learner.optimisers.iter().map(|adam| adam.steps).collect();
    assert_eq!(steps, [0, 3, 3]);
}

/// Cut rollouts, dealt critics' steps, privileged inputs and moments that forget: a run that
/// stopped and went on, with other samplers at that, equals the one that went straight through.
#[test]
fn runs_resume_exactly_with_each_of_it() {
    let popart = |mut config: TrainConfig| {
        config.learning.normaliser = ReturnNormaliser::PopArt;
        config.learning.normaliser_horizon = 2000.0;
        config
    };
    let anew = |mut config: TrainConfig| {
        (config.learning.recompute_advantages, config.network.policy_scale) = (true, 0.01);
        config.learning.epochs = 3;
        config.learning.value_phase = Some(2);
        config
    };
    for (name, mut config) in [
        ("cut", cut(AlgorithmKind::Cpo)),
        ("seen", seen_by_critics(cut(AlgorithmKind::TrpoPid))),
        ("popart", popart(seen_by_critics(tiny::config(AlgorithmKind::PpoPid)))),
        ("anew", anew(tiny::config(AlgorithmKind::Cup))),
    ] {
        config.frames = 4 * config.frames_per_rollout();
        let (straight, broken) = (
            tiny::directory(&format!("critics-straight-{name}")),
            tiny::directory(&format!("critics-broken-{name}")),
        );
        tiny::run(Start::Fresh(config.clone()), &straight).0.unwrap();
        tiny::run(
            Start::Fresh(TrainConfig { frames: config.frames / 2, ..config.clone() }),
            &broken,
        )
        .0
        .unwrap();
        let settings = vec![format!("frames={}", config.frames), "sampling.samplers=3".into()];
        tiny::run(Start::Resume { settings }, &broken).0.unwrap();
        assert!(tiny::weights(&straight) == tiny::weights(&broken), "{name}: weights differ");
        fs::remove_dir_all(straight).unwrap();
        fs::remove_dir_all(broken).unwrap();
    }
}

/// PopArt and critics that see more still learn the small constrained problem.
#[test]
fn algorithms_end_near_the_optimum_with_each_of_it() {
    for normaliser in [ReturnNormaliser::Running, ReturnNormaliser::PopArt] {
        let mut config = seen_by_critics(tiny::config(AlgorithmKind::PpoPid));
        config.learning.normaliser = normaliser;
        config.frames = 512 * 200;
        config.reporting.window = 64;
        config.algorithm_settings.pid_gains = (0.5, 0.1, 0.1);
        let path = tiny::directory(&format!("critics-optimum-{normaliser}"));
        let (result, reports, _) = tiny::run(Start::Fresh(config), &path);
        result.unwrap();
        fs::remove_dir_all(path).unwrap();
        let late = &reports[reports.len() / 2..];
        let mean = |of: fn((f64, f64, f64)) -> f64| {
            late.iter().map(|one| of(one.means.unwrap())).sum::<f64>() / late.len() as f64
        };
        let (episode_return, cost) = (mean(|means| means.0), mean(|means| means.1));
        assert!(
            cost < 4.6 && episode_return > 3.3,
            "{normaliser}: return {episode_return}, cost {cost}"
        );
    }
}
