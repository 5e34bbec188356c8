//! Every algorithm on a small constrained problem whose optimum is known.

mod tiny;

use hasard_learn::config::{AlgorithmKind, Preset, TrainConfig};
use hasard_learn::runs::report::Report;
use hasard_learn::runs::trainer::Start;

/// Mean return and cost over the last half of the run. A multiplier that follows the gradient
/// circles around the optimum (the best action jumps where the price crosses 1), and it is the mean
/// of a circle that lies there.
fn late(reports: &[Report]) -> (f64, f64) {
    let late = &reports[reports.len() / 2..];
    let mean = |of: fn(&Report) -> f64| late.iter().map(of).sum::<f64>() / late.len() as f64;
    (mean(|report| report.means.unwrap().0), mean(|report| report.means.unwrap().1))
}

fn outcome(config: TrainConfig, name: &str) -> (f64, f64, Vec<Report>) {
    let path = tiny::directory(&format!("optimum-{name}"));
    let (result, reports, warnings) = tiny::run(Start::Fresh(config), &path);
    result.unwrap();
    assert!(warnings.is_empty());
    std::fs::remove_dir_all(path).unwrap();
    let (episode_return, cost) = late(&reports);
    println!("{name}: return {episode_return:.2}, cost {cost:.2}");
    (episode_return, cost, reports)
}

/// Short runs: multipliers move faster than in runs of hundreds of millions of frames.
fn quick(algorithm: AlgorithmKind) -> TrainConfig {
    let mut config = tiny::config(algorithm);
    config.frames = 512 * 200;
    config.reporting.window = 64;
    let settings = &mut config.algorithm_settings;
    settings.multiplier_rate = if algorithm == AlgorithmKind::Focops { 0.03 } else { 0.1 };
    settings.pid_gains = (0.5, 0.1, 0.1);
    if algorithm == AlgorithmKind::PpoPid {
        (settings.pid_gains, settings.pid_decay, settings.pid_delay) = ((0.5, 0.4, 0.1), 0.8, 3);
    }
    settings.ipo_kappa = 0.075;
    config
}

#[test]
fn without_a_constraint_the_budget_is_overrun() {
    let (episode_return, cost, _) = outcome(quick(AlgorithmKind::Ppo), "PPO");
    assert!(episode_return > 6.3 && cost > 9.0, "the best is 7 at cost 10");
}

/// Who always takes the risk of a trap, and so does not look, gets 3; the best is 5.
#[test]
fn policies_look_at_the_picture() {
    for mut config in [quick(AlgorithmKind::Ppo), second_order(AlgorithmKind::Trpo)] {
        config.env.id = "Trap".into();
        let name = format!("{} in a trap", config.algorithm);
        let (episode_return, ..) = outcome(config, &name);
        assert!(episode_return > 4.5, "{name}: return {episode_return}");
    }
}

/// The settings that users get: nothing of the preset but sizes and lengths is another.
#[test]
fn the_quick_presets_own_settings_constrain() {
    use AlgorithmKind::{Cup, Focops, P3o, PpoLag, PpoPid};
    for algorithm in [PpoLag, PpoPid, P3o, Focops, Cup] {
        let small = tiny::config(algorithm);
        let mut config = TrainConfig::plain(algorithm, Preset::Quick, small.env.clone());
        (config.network, config.sampling, config.reporting) =
            (small.network, small.sampling, small.reporting);
        (config.constraints, config.episode_steps) = (small.constraints, small.episode_steps);
        config.learning.threads = 1;
        config.learning.gamma = 0.9;
        config.frames = 512 * 600;
        let (episode_return, cost, _) = outcome(config, &format!("{algorithm}-quick"));
        assert!(
            cost < 4.6 && episode_return > 0.8 * cost,
            "{algorithm}: cost {cost}, return {episode_return}"
        );
    }
}

/// The second cost has a budget that only its own multiplier can bring it under.
#[test]
fn two_constraints_are_both_kept() {
    for algorithm in [AlgorithmKind::PpoLag, AlgorithmKind::Focops, AlgorithmKind::Cpo] {
        let mut config = if algorithm == AlgorithmKind::Cpo {
            second_order(algorithm)
        } else {
            quick(algorithm)
        };
        config
            .constraints
            .push(hasard_learn::config::Constraint { term: Some("second".into()), budget: 1.0 });
        let (episode_return, _, reports) = outcome(config, &format!("{algorithm}-two"));
        let late = &reports[reports.len() / 2..];
        let costs = [0, 1].map(|index| {
            late.iter().map(|report| report.constraint_costs[index]).sum::<f64>()
                / late.len() as f64
        });
        println!("{algorithm}: costs {costs:?}");
        assert!(costs[0] < 4.6 && costs[1] < 1.4, "{algorithm}: costs {costs:?}");
        assert!(episode_return > 0.8 * costs[0], "{algorithm}: return {episode_return}");
        assert!(
            reports
                .last()
                .unwrap()
                .learning
                .iter()
                .any(|(name, _)| name == "cost_value_loss/second")
        );
    }
}

/// The best return within the budget of 4 is 4; a policy that does not distinguish rich from poor
/// gets 2.8 out of it.
#[test]
fn constrained_algorithms_end_near_the_best_return_within_the_budget() {
    use AlgorithmKind::{Cup, Focops, Ipo, P3o, PpoLag, PpoPid};
    for algorithm in [PpoLag, PpoPid, P3o, Focops, Cup, Ipo] {
        let (episode_return, cost, reports) = outcome(quick(algorithm), algorithm.name());
        assert!(cost < 4.6, "{algorithm}: cost {cost}");
        assert!(episode_return > 3.3, "{algorithm}: return {episode_return}");
        if matches!(algorithm, PpoLag | PpoPid) {
            // Near the optimum the multiplier is the price of a rich risk: 1 reward for 1 cost.
            let late = &reports[reports.len() / 2..];
            let multiplier =
                late.iter().map(|report| report.multipliers[0]).sum::<f64>() / late.len() as f64;
            println!("{algorithm}: multiplier {multiplier:.2}");
            assert!((0.5..1.5).contains(&multiplier), "{algorithm}: multiplier {multiplier}");
        }
    }
}

/// Second-order steps are large and few: two epochs on a rollout would move twice as far as the
/// trust region allows.
fn second_order(algorithm: AlgorithmKind) -> TrainConfig {
    let mut config = quick(algorithm);
    config.learning.epochs = 1;
    config.learning.minibatches = 1;
    config.network.recurrent = None;
    config.frames = 512 * 160;
    config.algorithm_settings.trust_radius = 0.02;
    config
}

#[test]
fn second_order_algorithms_do_so_too() {
    use AlgorithmKind::{Cpo, Trpo, TrpoLag, TrpoPid};
    let (episode_return, cost, _) = outcome(second_order(Trpo), "TRPO");
    assert!(episode_return > 6.3 && cost > 9.0, "the best is 7 at cost 10");
    for algorithm in [TrpoLag, TrpoPid, Cpo] {
        let (episode_return, cost, reports) = outcome(second_order(algorithm), algorithm.name());
        assert!(cost < 4.6, "{algorithm}: cost {cost}");
        assert!(episode_return > 3.3, "{algorithm}: return {episode_return}");
        let loss = |report: &Report| {
            report.learning.iter().find(|(name, _)| *name == "cost_value_loss").unwrap().1
        };
        let (early, late) = (loss(&reports[2]), loss(reports.last().unwrap()));
        assert!(late < early, "{algorithm}: the cost critic does not learn ({early} to {late})");
    }
}

/// Under a penalty of 0.7 a unit of cost the rich risk is worth it and the poor one is not: cost 5,
/// return 5.
#[test]
fn penalties_and_safety_states_shape_the_policy() {
    let mut config = quick(AlgorithmKind::PpoCost);
    config.algorithm_settings.penalty_scale = 0.7;
    let (episode_return, cost, _) = outcome(config, "PPOCost");
    assert!((4.5..5.6).contains(&cost), "cost {cost}");
    assert!(episode_return > 4.4, "return {episode_return}");
    let mut config = quick(AlgorithmKind::PpoSaute);
    config.algorithm_settings.saute_unsafe_reward = -1.0;
    let (episode_return, cost, _) = outcome(config, "PPOSaute");
    assert!((2.5..4.6).contains(&cost), "cost {cost}");
    assert!(
        episode_return > 0.8 * cost,
        "return {episode_return}: a policy blind to the picture has 0.7 of the cost"
    );
}

/// CPO's excess is in the unit of its surrogate whatever the discount is: here 1 / (1 - gamma) is a
/// fifth of the episode.
#[test]
fn cpo_counts_an_episodes_excess_by_its_steps() {
    let mut config = second_order(AlgorithmKind::Cpo);
    config.learning.gamma = 0.5;
    let (episode_return, cost, _) = outcome(config, "CPO-gamma");
    assert!(
        (3.6..4.6).contains(&cost) && episode_return > 3.5,
        "cost {cost}, return {episode_return}"
    );
}

#[test]
fn the_released_presets_rules_work_too() {
    let mut config = quick(AlgorithmKind::PpoLag);
    let released = TrainConfig::plain(AlgorithmKind::PpoLag, Preset::Released, config.env.clone());
    config.constraint_statistic = released.constraint_statistic;
    config.algorithm_settings.multiplier_update = released.algorithm_settings.multiplier_update;
    config.algorithm_settings.multiplier_rate = 0.03;
    config.network.initialisation = released.network.initialisation;
    config.learning.clip_value = released.learning.clip_value;
    config.learning.bootstrap_time_outs = released.learning.bootstrap_time_outs;
    let (episode_return, cost, _) = outcome(config, "PPOLag-released");
    assert!(cost < 4.6 && episode_return > 3.3);
}
