//! The ends of episodes on their way to the learner and in evaluations: what comes after a death,
//! what comes after a time-out, and the safety state, each worked out again from the worlds.

mod tiny;

use hasard_envs::{Environment, VecEnv, VecOptions};
use hasard_learn::config::{AlgorithmKind, EnvConfig, TrainConfig};
use hasard_learn::networks::Actor;
use hasard_learn::networks::device::ComputeDevice;
use hasard_learn::runs::agent::{Choice, TrainedPolicy};
use hasard_learn::runs::evaluate::play;
use hasard_learn::runs::session::{Beginning, Session};
use hasard_learn::sampling::rollout::Part;
use tiny::{Risk, STEPS};

/// Worlds whose episodes end by themselves, as with a death.
fn deadly(_: &EnvConfig, options: VecOptions) -> Result<VecEnv, hasard_envs::EnvError> {
    VecEnv::from_fn(options, |_| Ok(Box::new(Risk::new(false))))
}

/// Saute with a budget of 4 over episodes of 10 steps, and a discount that shows.
fn saute() -> TrainConfig {
    let mut config = tiny::config(AlgorithmKind::PpoSaute);
    (config.budget_share, config.budget_margin) = (1.0, 0.0);
    config.algorithm_settings.saute_gamma = 0.9;
    config.algorithm_settings.saute_horizon = f64::from(STEPS);
    config
}

/// Sootla et al. 2022, equation 5: z' = (z - c / d) / gamma, where d is the budget of a step such
/// that d (1 + gamma + ... + gamma^9) = 4 (1 + gamma + ... + gamma^9) / 10 over ten steps.
fn next_safety(safety: f64, cost: f64) -> f64 {
    let discounted: f64 = (0..STEPS as i32).map(|step| 0.9f64.powi(step)).sum();
    (safety - cost / (4.0 * discounted / f64::from(STEPS))) / 0.9
}

/// Rows of a part at which an episode ended.
fn ends(part: &Part) -> Vec<usize> {
    (0..part.steps * part.lanes).filter(|&row| part.done[row]).collect()
}

/// Schulman et al. 2016, equation 16, with lambda 0: A = r + gamma V(s') - V(s), and nothing comes
/// after an absorbing state.
#[test]
fn nothing_comes_after_a_death() {
    let mut config = tiny::config(AlgorithmKind::PpoLag);
    config.learning.gae_lambda = 0.0;
    let mut session = Session::new(config, &Beginning::Nothing, &deadly).unwrap();
    let rollout = session.gatherer.next_rollout().unwrap();
    let moments = session.learner.returns.clone();
    let prepared = session.learner.prepare(&rollout);
    let (steps, mut seen) = (rollout.steps(), 0);
    for lane in 0..rollout.lanes() {
        let (part, own) = rollout.find(lane);
        assert!(part.cut_off.is_empty(), "no clock cut these episodes off");
        for row in ends(part).into_iter().filter(|row| row % part.lanes == own) {
            let at = lane * steps + row / part.lanes;
            for (critic, brought) in [part.rewards[row], part.costs[row]].into_iter().enumerate() {
                let value = moments[critic].denormalise(prepared.old_values[critic][at]);
                let found = prepared.advantages[critic][at];
                assert!((found - (brought - value)).abs() < 1e-6, "critic {critic}: {found}");
                seen += 1;
            }
        }
    }
    assert!(seen > 40, "{seen}");
}

/// The same equation where the clock cut an episode off: V(s') is what each critic says of the
/// last picture, with the memory of that episode alone. The episode is played again beside, and a
/// network that remembers it from its first step on is asked.
#[test]
fn after_a_time_out_comes_what_critics_say_of_the_last_picture() {
    for mut config in [tiny::config(AlgorithmKind::PpoLag), saute()] {
        config.learning.gae_lambda = 0.0;
        let (name, gamma) = (config.algorithm, config.learning.gamma as f32);
        let mut session = Session::new(config, &Beginning::Nothing, &tiny::worlds).unwrap();
        let shape = session.learner.shape().clone();
        // Weights so large that what was remembered shows.
        session.learner.parameters.iter_mut().for_each(|value| *value *= 2.0);
        session.learner.version += 1;
        session.learner.replaced();
        let first = session.gatherer.next_rollout().unwrap();
        session.go_on(first);
        let rollout = session.gatherer.next_rollout().unwrap();
        let mut actor = Actor::new(&shape, &ComputeDevice::plain());
        actor.load(&session.learner.publish());
        let moments = session.learner.returns.clone();
        let prepared = session.learner.prepare(&rollout);
        let (width, steps) = (shape.outputs(), rollout.steps());
        let mut seen = 0;
        for lane in 0..rollout.lanes() {
            let (part, own) = rollout.find(lane);
            let mut own_ends = ends(part).into_iter().filter(|row| row % part.lanes == own);
            let (Some(before), Some(row)) = (own_ends.next(), own_ends.next()) else { continue };
            // The episode between two ends lies in this rollout as a whole.
            let began = before / part.lanes + 1;
            let (_, episode) = part
                .episodes
                .iter()
                .find(|(step, episode)| *step == row / part.lanes && episode.lane == lane)
                .unwrap();
            let mut world = Risk::new(true);
            world.reset(episode.seed);
            let (mut state, mut safety) = (shape.zero_state(1), 1.0);
            let mut said = vec![0.0; width];
            let mut ask = |world: &mut Risk, safety: f64, said: &mut [f32]| {
                let mut picture = vec![0; shape.pixels()];
                world.observe(&mut picture);
                let extra = [safety.clamp(-5.0, 5.0) as f32];
                let extra = &extra[..shape.extra_inputs()];
                actor.act(&picture, extra, &[], &mut state, 0..1, said, None);
            };
            for step in began..=row / part.lanes {
                let at = step * part.lanes + own;
                ask(&mut world, safety, &mut said);
                for (now, then) in said.iter().zip(&part.outputs[at * width..]) {
                    assert!((now - then).abs() < 1e-4, "{name}, step {step}: {now}, not {then}");
                }
                let cost = world.step(&part.actions[at * 2..at * 2 + 2], &[]).cost;
                safety = next_safety(safety, cost);
            }
            ask(&mut world, safety, &mut said);
            let at = lane * steps + row / part.lanes;
            let brought = [part.rewards[row], part.costs[row]];
            for (critic, moments) in moments.iter().enumerate() {
                let after = moments.denormalise(said[shape.value_column() + critic]);
                let value = moments.denormalise(prepared.old_values[critic][at]);
                let expected = brought[critic] + gamma * after - value;
                let found = prepared.advantages[critic][at];
                assert!((found - expected).abs() < 1e-4, "{name}: {found}, not {expected}");
                // What it would be without the memory, or of the other critic, is far off.
                assert!(after.abs() > 1e-3, "{name}: a value of {after} shows nothing");
                seen += 1;
            }
        }
        assert!(seen >= 8, "{name}: {seen}");
    }
}

/// The network sees the safety state of each step: 1 at an episode's start, then as the costs of
/// the episode have it.
#[test]
fn the_network_sees_the_safety_state_of_each_step() {
    let mut session = Session::new(saute(), &Beginning::Nothing, &tiny::worlds).unwrap();
    let rollout = session.gatherer.next_rollout().unwrap();
    let mut least = f32::INFINITY;
    for part in &rollout.parts {
        for lane in 0..part.lanes {
            let mut safety = 1.0;
            for step in 0..=part.steps {
                let row = step * part.lanes + lane;
                let expected = f64::clamp(safety, -5.0, 5.0) as f32;
                let found = part.extra[row];
                assert!((found - expected).abs() < 1e-5, "step {step}: {found}, not {expected}");
                least = least.min(found);
                if step < part.steps {
                    safety = match part.done[row] {
                        true => 1.0,
                        false => next_safety(safety, part.costs[row].into()),
                    };
                }
            }
        }
    }
    assert!(least < 0.0, "no lane spent its budget");
}

/// Evaluations show the policy its safety state too: they equal a plain loop that does, and differ
/// from one that forgets it.
#[test]
fn evaluations_keep_the_safety_state() {
    let mut session = Session::new(saute(), &Beginning::Nothing, &tiny::worlds).unwrap();
    session.learner.parameters.iter_mut().for_each(|value| *value *= 3.0);
    session.learner.replaced();
    let published = session.learner.publish();
    let policy = TrainedPolicy::new(
        &session.config,
        session.learner.shape(),
        published,
        ComputeDevice::plain(),
        session.cost_terms,
    )
    .unwrap();
    let seeds: Vec<u64> = (0..100).collect();
    let played = play(&policy, Choice::Sampled, &tiny::worlds, &seeds, 2).unwrap();
    let loops = [true, false].map(|remember| {
        let one = |&seed: &u64| {
            let mut agent = policy.agent(Choice::Sampled, 1);
            let mut world = Risk::new(true);
            world.reset(seed);
            agent.reset(0, seed);
            let mut picture = vec![0; session.learner.shape().pixels()];
            loop {
                world.observe(&mut picture);
                let action = agent.act(&picture).remove(0);
                let step = world.step(&action.actions, &action.deltas);
                if remember {
                    agent.observe_cost(0, step.cost, world.step_costs());
                }
                if step.ended() {
                    break (world.episode().episode_return, world.episode().cost);
                }
            }
        };
        seeds.iter().map(one).collect::<Vec<_>>()
    });
    let played: Vec<(f64, f64)> =
        played.iter().map(|episode| (episode.episode_return, episode.cost)).collect();
    assert_eq!(played, loops[0]);
    assert_ne!(played, loops[1], "the safety state changes nothing");
}
