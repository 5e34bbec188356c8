use super::*;
use crate::algorithms;
use crate::config::{AlgorithmKind, EnvConfig, Preset, TrainConfig};

fn signal(step_cost: f64) -> Signal {
    Signal::steady(step_cost * 525.0, 50.0, 525.0)
}

fn config(algorithm: AlgorithmKind, preset: Preset) -> TrainConfig {
    TrainConfig::plain(algorithm, preset, EnvConfig::new("test"))
}

fn settings() -> AlgorithmConfig {
    config(AlgorithmKind::PpoLag, Preset::Released).algorithm_settings
}

/// The released code's rules, worked out apart in double precision: ten updates at a step cost
/// of 0.3, then of 0.05.
#[test]
fn multipliers_follow_the_recorded_numbers() {
    let mut lagrange = Lagrange::all(&settings(), 1);
    let mut pid = Pid::all(&settings(), 1);
    let expected = [
        (1, 0.002_047_62, 0.004_221_43),
        (2, 0.004_095_24, 0.007_384_17),
        (3, 0.006_142_86, 0.010_491_15),
        (10, 0.020_476_19, 0.030_896_32),
        (11, 0.022_523_81, 0.033_496_74),
    ];
    for update in 1..=11 {
        lagrange.update(&[signal(0.3)]);
        pid.update(&[signal(0.3)]);
        if let Some((_, l, p)) = expected.iter().find(|(at, ..)| *at == update) {
            assert!(
                (lagrange.values()[0] - l).abs() < 1e-8,
                "update {update}: {}",
                lagrange.values()[0]
            );
            assert!((pid.values()[0] - p).abs() < 1e-8, "update {update}: {}", pid.values()[0]);
        }
    }
    lagrange.update(&[signal(0.05)]);
    pid.update(&[signal(0.05)]);
    assert!((lagrange.values()[0] - 0.022_071_43).abs() < 1e-8);
    assert!((pid.values()[0] - 0.032_194_52).abs() < 1e-8);
}

/// A2. Ray et al. 2019: gradient ascent on lambda (J_C - d), projected to lambda >= 0. So the
/// multiplier is a running sum that is cut off at zero, under every preset, and nothing of the
/// present excess is in it: back at the budget it stays where it was.
#[test]
fn the_lagrangian_is_a_sum_of_excesses_under_every_preset() {
    let costs = [90.0, 120.0, 40.0, 50.0, 50.0, 20.0, 0.0, 0.0, 0.0, 75.0];
    for algorithm in
        [AlgorithmKind::PpoLag, AlgorithmKind::TrpoLag, AlgorithmKind::Focops, AlgorithmKind::Cup]
    {
        for &preset in Preset::ALL {
            let config = config(algorithm, preset);
            let rate = config.algorithm_settings.multiplier_rate;
            let mut made = algorithms::make(&config);
            let mut expected = 0.0f64;
            for done in [0.0, 1.0] {
                for cost in costs {
                    made.constrain(&[Signal { done, ..Signal::steady(cost, 50.0, 525.0) }]);
                    expected = (expected + rate * (cost - 50.0) / 525.0).max(0.0);
                    let found = made.multipliers()[0];
                    assert!(
                        (found - expected).abs() < 1e-12,
                        "{algorithm} {preset}: {found} against {expected}"
                    );
                }
            }
        }
    }
    for algorithm in [AlgorithmKind::PpoPid, AlgorithmKind::TrpoPid] {
        for &preset in Preset::ALL {
            let mut made = algorithms::make(&config(algorithm, preset));
            made.constrain(&[Signal::steady(500.0, 50.0, 525.0)]);
            let (gains, decay, integral) = {
                let settings = config(algorithm, preset).algorithm_settings;
                (settings.pid_gains, settings.pid_decay, settings.pid_initial)
            };
            // Stooke et al. 2020, algorithm 2: K_P Delta + I + K_D (J_C - J_C before)+, the
            // first and the last smoothed.
            let excess = 450.0 / 525.0;
            let expected = gains.0 * (1.0 - decay) * excess
                + integral
                + gains.1 * excess
                + gains.2 * (1.0 - decay) * 500.0 / 525.0;
            let found = made.multipliers()[0];
            assert!(
                (found - expected).abs() < 1e-12,
                "{algorithm} {preset}: {found} against {expected}"
            );
        }
    }
}

/// A cost that follows the multiplier with a delay: the integral alone runs in circles, with a
/// proportional part it settles.
#[test]
fn a_proportional_part_ends_the_circles() {
    let swing = |gain: f64| {
        let settings = AlgorithmConfig {
            pid_gains: (gain, 0.02, 0.0),
            pid_initial: 0.0,
            pid_decay: 0.0,
            ..settings()
        };
        let mut multiplier = Pid::all(&settings, 1);
        let (mut cost, mut seen) = (100.0, std::collections::VecDeque::from(vec![100.0; 66]));
        let mut late = Vec::new();
        for update in 0..4000 {
            // It falls by 575 a unit of the multiplier, within 146 updates, and is seen 66
            // updates later.
            cost += (165.0 - 575.0 * multiplier.values()[0] - cost) / 146.0;
            seen.push_back(cost);
            multiplier.update(&[signal(seen.pop_front().unwrap() / 525.0)]);
            late.extend((update >= 2000).then_some(cost));
        }
        late.iter().fold(0.0f64, |most, cost| most.max((cost - 50.0f64).abs()))
    };
    assert!(swing(0.0) > 10.0, "{}", swing(0.0));
    assert!(swing(1.5) < 2.0, "{}", swing(1.5));
}

/// A cost that answers to ratios of the multiplier: the gain that brings a budget of 45 to rest
/// where 0.3 is needed also brings one of 4.5 to rest where 3 is, and moves the first as it
/// would without.
#[test]
fn a_reference_brings_small_budgets_to_rest_as_soon() {
    let distance = |reference: Option<f64>, scale: f64| {
        let settings = AlgorithmConfig {
            pid_gains: (1.5, 0.01, 0.0),
            pid_initial: 0.0,
            pid_decay: 0.0,
            pid_reference_budget: reference,
            ..settings()
        };
        let mut multiplier = Pid::all(&settings, 1);
        let budget = 45.0 / scale;
        let mut cost = 2.0 * budget;
        for update in 0..12_000 {
            let wanted = budget * (1.0 - (multiplier.values()[0] / (0.3 * scale)).max(0.05).ln());
            cost += (wanted - cost) / 146.0;
            multiplier.update(&[Signal {
                done: f64::from(update) / 12e3,
                ..Signal::steady(cost, budget, 525.0)
            }]);
        }
        (cost / budget - 1.0).abs()
    };
    assert!(
        distance(None, 1.0) < 0.01 && distance(None, 10.0) > 0.5,
        "{} {}",
        distance(None, 1.0),
        distance(None, 10.0)
    );
    assert!(
        distance(Some(45.0), 1.0) == distance(None, 1.0) && distance(Some(45.0), 10.0) < 0.25,
        "{}",
        distance(Some(45.0), 10.0)
    );
}

/// Worked out by hand: halfway, an excess of 5 over a budget of 5 counts 1 + (45 / 5 - 1) / 8 =
/// 2 times; at first it counts once. A budget of nothing counts as one of 1.
#[test]
fn an_excess_counts_by_its_share_of_the_budget_at_last() {
    let moved = |gains: (f64, f64, f64), budget: f64, done: f64| {
        let settings = AlgorithmConfig {
            pid_gains: gains,
            pid_initial: 0.0,
            pid_decay: 0.0,
            pid_reference_budget: Some(45.0),
            ..settings()
        };
        let mut multiplier = Pid::all(&settings, 1);
        multiplier.update(&[Signal { done, ..Signal::steady(budget + 5.0, budget, 100.0) }]);
        multiplier.values()[0]
    };
    for (budget, done, expected) in
        [(5.0, 0.0, 0.05), (5.0, 0.5, 0.1), (5.0, 1.0, 0.45), (45.0, 1.0, 0.05), (0.0, 1.0, 2.25)]
    {
        for gains in [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0)] {
            let found = moved(gains, budget, done);
            assert!((found - expected).abs() < 1e-12, "{gains:?} {budget} {done}: {found}");
        }
    }
}

/// A15. Stooke et al. 2020, algorithm 2: once an iteration, I <- (I + J_C - d)+ over the
/// episodes of that iteration. Two rollouts pass without an episode, the third brings three: as
/// if each of the three rollouts had brought one, and a fourth without any moves nothing.
#[test]
fn the_pid_counts_new_episodes_once() {
    let made = |signals: &[Signal]| {
        let mut pid = Pid::all(&AlgorithmConfig { pid_delay: 4, ..settings() }, 1);
        signals.iter().for_each(|signal| pid.update(std::slice::from_ref(signal)));
        pid
    };
    let steady = Signal::steady(80.0, 50.0, 525.0);
    let none = Signal { fresh_weight: 0.0, ..steady };
    let three = Signal { fresh_weight: 3.0, ..steady };
    let (late, each) = (made(&[none, none, three]), made(&[steady, steady, steady]));
    let parts = |multipliers: &Multipliers| {
        let Multipliers::Pid(all) = multipliers else { panic!("no PID") };
        (all[0].integral, all[0].proportional, all[0].cost)
    };
    let (a, b) = (parts(&late), parts(&each));
    assert!(
        (a.0 - b.0).abs() < 1e-15 && (a.1 - b.1).abs() < 1e-15 && (a.2 - b.2).abs() < 1e-15,
        "{a:?} {b:?}"
    );
    // 0.001 + 3 * 0.01 * 30 / 525, and 1 - 0.95^3 of the excess.
    assert!(
        (a.0 - (0.001 + 0.9 / 525.0)).abs() < 1e-15
            && (a.1 - 0.142_625 * 30.0 / 525.0).abs() < 1e-15
    );
    let mut after = late.clone();
    after.update(&[none]);
    assert_eq!(after, late);
}

/// A2: a checkpoint of older versions' damped multiplier is one of a PI controller.
#[test]
fn damped_multipliers_go_on_as_the_controllers_that_they_were() {
    let saved = serde_json::json!([{ "value": 0.2, "integral": 0.15, "rate": 0.01, "damping": 1.5, "reference": 45.0, "limit": null }]);
    let mut pid = algorithms::make(&config(AlgorithmKind::PpoPid, Preset::Quick));
    pid.load(&saved).unwrap();
    assert_eq!(pid.multipliers(), [0.2]);
    pid.constrain(&[Signal::steady(0.0, 0.0, 525.0)]);
    assert_eq!(pid.multipliers(), [0.15]);
    // A plain Lagrangian is no controller, nor the other way round.
    let plain = serde_json::json!([{ "value": 0.2, "rate": 0.01, "limit": null }]);
    assert!(pid.load(&plain).unwrap_err().to_string().contains("another algorithm's"));
    let mut lagrangian = algorithms::make(&config(AlgorithmKind::PpoLag, Preset::Quick));
    lagrangian.load(&plain).unwrap();
    assert_eq!(lagrangian.multipliers(), [0.2]);
}

#[test]
fn multipliers_stay_within_their_bounds() {
    let mut lagrange =
        Lagrange::all(&AlgorithmConfig { multiplier_limit: Some(0.01), ..settings() }, 1);
    lagrange.update(&[signal(0.0)]);
    assert_eq!(lagrange.values()[0], 0.0);
    (0..100).for_each(|_| lagrange.update(&[signal(1.0)]));
    assert_eq!(lagrange.values()[0], 0.01);
}

/// A limit holds the integral of a PID too, so that it has nothing to unwind: after a hundred
/// updates far above the budget the first one below it lowers the multiplier.
#[test]
fn a_limited_integral_does_not_wind_up() {
    let limited = |gain: f64| AlgorithmConfig {
        multiplier_limit: Some(2.0),
        pid_gains: (gain, 1.0, 0.0),
        pid_initial: 0.0,
        ..settings()
    };
    let mut pid = Pid::all(&limited(0.5), 1);
    (0..100).for_each(|_| pid.update(&[signal(1.0)]));
    assert_eq!(pid.values()[0], 2.0);
    let mut integral = Pid::all(&limited(0.0), 1);
    (0..100).for_each(|_| integral.update(&[signal(1.0)]));
    integral.update(&[signal(0.0)]);
    let expected = 2.0 - 50.0 / 525.0;
    assert!((integral.values()[0] - expected).abs() < 1e-12, "{:?}", integral.values());
}

#[test]
fn saved_multipliers_come_back_as_what_they_were() {
    for mut multipliers in [Lagrange::all(&settings(), 2), Pid::all(&settings(), 2)] {
        multipliers.update(&[signal(0.3), signal(0.1)]);
        let saved = serde_json::to_value(&multipliers).unwrap();
        let loaded: Multipliers = serde_json::from_value(saved).unwrap();
        assert_eq!(loaded, multipliers);
        assert!(loaded.is_like(&multipliers));
        assert!(
            !loaded.is_like(&Pid::all(&settings(), 1))
                && !loaded.is_like(&Lagrange::all(&settings(), 1))
        );
    }
}
