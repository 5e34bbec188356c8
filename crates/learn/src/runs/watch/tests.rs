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
}

/// By hand: costs of 20, 30 and 40 have a deviation of 10, of which 0.4 are taken off a budget of
/// 50; jumps of 1, 1 and 1 have none, and their aim is the share of 0.95 of 2.
#[test]
fn aims_keep_a_margin_by_how_costs_scatter() {
    let mut config =
        TrainConfig::plain(AlgorithmKind::PpoLag, Preset::Paper, EnvConfig::new("test"));
    (config.budget_share, config.budget_margin) = (0.95, 0.4);
    config.constraints = vec![
        Constraint { term: None, budget: 50.0 },
        Constraint { term: Some("jumps".into()), budget: 2.0 },
    ];
    let mut watch = Watch::new(&config);
    for cost in [20.0, 30.0, 40.0] {
        watch.add(&episode(cost, 1.0), &config.constraints).unwrap();
    }
    let aims: Vec<f64> =
        watch.signals(&config, 0.5, &[0.0; 2]).iter().map(|one| one.episode_budget).collect();
    assert!((aims[0] - 46.0).abs() < 1e-9 && (aims[1] - 1.9).abs() < 1e-9, "{aims:?}");
}

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
    // The surrogate of the second's cost is a mean over all three worlds' steps.
    let excess: Vec<f64> = signals(&watch).iter().map(Signal::surrogate_excess).collect();
    let expected = [(6.0 - 5.0) / 525.0 * 2.0 / 3.0, (70.0 - 50.0) / 300.0 / 3.0];
    assert!(excess.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{excess:?}");
    // And so is the mean cost of a step, from which 525 steps of the second cost 3 * 0.02 * 525.
    let by_step =
        TrainConfig { constraint_statistic: ConstraintStatistic::StepMean, ..config.clone() };
    let costs_by_step = watch.signals(&by_step, 0.0, &[0.01, 0.02]);
    let costs_by_step: Vec<f64> = costs_by_step.iter().map(|one| one.episode_cost).collect();
    let expected = [0.01 * 1.5 * 525.0, 0.02 * 3.0 * 525.0];
    assert!(
        costs_by_step.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9),
        "{costs_by_step:?}"
    );
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
    let details: std::collections::BTreeMap<String, f64> = watch.details().into_iter().collect();
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
    // Episodes of a rollout that is thrown away count as new in the next.
    let mut lagged = watch.clone();
    lagged.thrown_away();
    lagged.add(&episode(4.0, 0.0), &config.constraints).unwrap();
    assert_eq!(fresh(&lagged), (21.5, 3.0, 2.0));
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
        assert!(message.contains("cvar:0.1") && message.contains(algorithm.name()), "{message}");
    }
}
