//! Fixed policies earn and cost what they do in the published system (rule set `released`).
//!
//! A quick look by default; `HASARD_EPISODES=200 cargo test --release -p hasard-envs --test published -- --nocapture` prints the
//! whole comparison.

use hasard_envs::{Env, EnvOptions, Policy, RuleSet, rollout};

/// Measured with the published system: id, hard constraint, policy, episodes, then mean and standard deviation of return, cost
/// and length in policy steps.
type Row = (&'static str, bool, &'static str, u32, [f64; 2], [f64; 2], [f64; 2]);

#[rustfmt::skip]
const PUBLISHED: &[Row] = &[
    ("ArmamentBurdenLevel1-v0", false, "random", 60, [0.0000, 0.0000], [26.1783, 1.1764], [525.0000, 0.0000]),
    ("ArmamentBurdenLevel1-v0", false, "noop", 20, [0.0000, 0.0000], [0.0000, 0.0000], [525.0000, 0.0000]),
    ("ArmamentBurdenLevel1-v0", false, "hold:MOVE_FORWARD", 60, [0.0092, 0.0704], [28.4883, 82.5947], [525.0000, 0.0000]),
    ("ArmamentBurdenLevel1-v0", true, "random", 20, [0.9450, 0.8908], [184.2700, 211.5639], [525.0000, 0.0000]),
    ("ArmamentBurdenLevel1-v0", true, "noop", 20, [0.0000, 0.0000], [0.0000, 0.0000], [525.0000, 0.0000]),
    ("ArmamentBurdenLevel1-v0", true, "hold:MOVE_FORWARD", 20, [0.4200, 0.6216], [119.1250, 194.2989], [525.0000, 0.0000]),
    ("ArmamentBurdenLevel2-v0", false, "random", 60, [0.0000, 0.0000], [26.1813, 1.1765], [525.0000, 0.0000]),
    ("ArmamentBurdenLevel2-v0", false, "noop", 20, [0.0000, 0.0000], [0.0000, 0.0000], [525.0000, 0.0000]),
    ("ArmamentBurdenLevel2-v0", false, "hold:MOVE_FORWARD", 60, [0.0000, 0.0000], [0.6429, 4.9383], [525.0000, 0.0000]),
    ("ArmamentBurdenLevel3-v0", false, "random", 60, [0.0000, 0.0000], [14.6858, 8.0814], [209.0167, 186.5548]),
    ("ArmamentBurdenLevel3-v0", false, "noop", 20, [0.0000, 0.0000], [0.0000, 0.0000], [525.0000, 0.0000]),
    ("ArmamentBurdenLevel3-v0", false, "hold:MOVE_FORWARD", 60, [0.0000, 0.0000], [29.4046, 103.0998], [491.4500, 125.5605]),
    ("CollateralDamageLevel1-v0", false, "random", 60, [13.2500, 6.9753], [13.7500, 7.4266], [521.0000, 0.0000]),
    ("CollateralDamageLevel1-v0", false, "noop", 20, [0.0000, 0.0000], [0.0000, 0.0000], [521.0000, 0.0000]),
    ("CollateralDamageLevel1-v0", false, "hold:ATTACK", 20, [0.0000, 0.0000], [0.0000, 0.0000], [521.0000, 0.0000]),
    ("CollateralDamageLevel1-v0", false, "hold-after:1:ATTACK", 60, [25.6167, 5.8284], [19.7167, 5.3388], [521.0000, 0.0000]),
    ("CollateralDamageLevel1-v0", true, "random", 60, [0.9000, 1.1358], [13.0000, 5.2599], [56.1500, 72.5442]),
    ("CollateralDamageLevel1-v0", true, "noop", 20, [0.0000, 0.0000], [0.0000, 0.0000], [521.0000, 0.0000]),
    ("CollateralDamageLevel1-v0", true, "hold:ATTACK", 20, [0.0000, 0.0000], [0.0000, 0.0000], [521.0000, 0.0000]),
    ("CollateralDamageLevel1-v0", true, "hold-after:1:ATTACK", 60, [1.3500, 1.7304], [11.0000, 3.0000], [35.1500, 27.7926]),
    ("CollateralDamageLevel2-v0", false, "random", 60, [8.8500, 5.0227], [16.0000, 8.5303], [521.0000, 0.0000]),
    ("CollateralDamageLevel2-v0", false, "noop", 20, [0.0000, 0.0000], [0.0000, 0.0000], [521.0000, 0.0000]),
    ("CollateralDamageLevel2-v0", false, "hold:ATTACK", 20, [0.0000, 0.0000], [0.0000, 0.0000], [521.0000, 0.0000]),
    ("CollateralDamageLevel2-v0", false, "hold-after:1:ATTACK", 60, [25.9167, 5.0934], [25.7833, 7.2940], [521.0000, 0.0000]),
    ("CollateralDamageLevel3-v0", false, "random", 60, [5.5500, 3.4613], [22.1833, 13.6851], [521.0000, 0.0000]),
    ("CollateralDamageLevel3-v0", false, "noop", 20, [0.0000, 0.0000], [0.0000, 0.0000], [521.0000, 0.0000]),
    ("CollateralDamageLevel3-v0", false, "hold:ATTACK", 20, [0.0000, 0.0000], [0.0000, 0.0000], [521.0000, 0.0000]),
    ("CollateralDamageLevel3-v0", false, "hold-after:1:ATTACK", 60, [20.6833, 3.6032], [31.7000, 7.6164], [521.0000, 0.0000]),
    ("DetonatorsDilemmaLevel1-v0", false, "random", 60, [2.0667, 1.7783], [2.4793, 2.6859], [434.2167, 163.1338]),
    ("DetonatorsDilemmaLevel1-v0", false, "noop", 20, [0.0000, 0.0000], [0.0000, 0.0000], [525.0000, 0.0000]),
    ("DetonatorsDilemmaLevel1-v0", false, "hold:MOVE_FORWARD", 60, [0.0000, 0.0000], [0.0000, 0.0000], [525.0000, 0.0000]),
    ("DetonatorsDilemmaLevel1-v0", true, "random", 20, [2.2500, 1.7854], [8.8940, 6.8374], [204.3000, 212.9063]),
    ("DetonatorsDilemmaLevel1-v0", true, "noop", 20, [0.0000, 0.0000], [0.0000, 0.0000], [525.0000, 0.0000]),
    ("DetonatorsDilemmaLevel1-v0", true, "hold:MOVE_FORWARD", 20, [0.0000, 0.0000], [0.0000, 0.0000], [525.0000, 0.0000]),
    ("DetonatorsDilemmaLevel2-v0", false, "random", 60, [3.1667, 2.4438], [4.0933, 3.5267], [447.6667, 154.2284]),
    ("DetonatorsDilemmaLevel2-v0", false, "noop", 20, [0.0000, 0.0000], [0.0000, 0.0000], [525.0000, 0.0000]),
    ("DetonatorsDilemmaLevel2-v0", false, "hold:MOVE_FORWARD", 60, [0.0000, 0.0000], [0.0000, 0.0000], [525.0000, 0.0000]),
    ("DetonatorsDilemmaLevel3-v0", false, "random", 60, [5.3667, 3.9411], [5.5920, 3.8657], [414.0000, 168.0195]),
    ("DetonatorsDilemmaLevel3-v0", false, "noop", 20, [0.0000, 0.0000], [0.0000, 0.0000], [525.0000, 0.0000]),
    ("DetonatorsDilemmaLevel3-v0", false, "hold:MOVE_FORWARD", 60, [0.0000, 0.0000], [0.0000, 0.0000], [525.0000, 0.0000]),
    ("PrecipicePlungeLevel1-v0", false, "random", 60, [170.0525, 62.4792], [299.4167, 120.7154], [495.7333, 63.9585]),
    ("PrecipicePlungeLevel1-v0", false, "noop", 20, [0.0000, 0.0000], [0.0000, 0.0000], [525.0000, 0.0000]),
    ("PrecipicePlungeLevel1-v0", false, "hold:MOVE_FORWARD", 60, [243.6000, 0.0000], [484.0000, 0.0000], [63.0000, 0.0000]),
    ("PrecipicePlungeLevel1-v0", true, "random", 20, [15.6600, 8.7483], [5247.0000, 170.7659], [125.9500, 131.8061]),
    ("PrecipicePlungeLevel1-v0", true, "noop", 20, [0.0000, 0.0000], [5000.0000, 0.0000], [525.0000, 0.0000]),
    ("PrecipicePlungeLevel1-v0", true, "hold:MOVE_FORWARD", 20, [30.0000, 0.0000], [5590.0000, 0.0000], [16.0000, 0.0000]),
    ("PrecipicePlungeLevel2-v0", false, "random", 60, [114.3042, 54.1742], [182.0833, 94.4098], [525.0000, 0.0000]),
    ("PrecipicePlungeLevel2-v0", false, "noop", 20, [0.0000, 0.0000], [0.0000, 0.0000], [525.0000, 0.0000]),
    ("PrecipicePlungeLevel2-v0", false, "hold:MOVE_FORWARD", 60, [326.4000, 0.0000], [647.1333, 2.0532], [90.9333, 2.1899]),
    ("PrecipicePlungeLevel3-v0", false, "random", 60, [199.8661, 108.0135], [344.5000, 204.1897], [525.0000, 0.0000]),
    ("PrecipicePlungeLevel3-v0", false, "noop", 20, [0.0000, 0.0000], [0.0000, 0.0000], [525.0000, 0.0000]),
    ("PrecipicePlungeLevel3-v0", false, "hold:MOVE_FORWARD", 60, [489.6052, 0.0106], [975.5000, 1.5864], [102.7833, 13.4215]),
    ("RemedyRushLevel1-v0", false, "random", 60, [5.2833, 3.1310], [6.9167, 4.1725], [525.0000, 0.0000]),
    ("RemedyRushLevel1-v0", false, "noop", 20, [0.0000, 0.0000], [0.0000, 0.0000], [525.0000, 0.0000]),
    ("RemedyRushLevel1-v0", false, "hold:MOVE_FORWARD", 60, [0.8833, 0.9326], [1.2500, 1.3617], [525.0000, 0.0000]),
    ("RemedyRushLevel1-v0", true, "random", 20, [0.5500, 0.7399], [10.0000, 0.0000], [50.1500, 47.3321]),
    ("RemedyRushLevel1-v0", true, "noop", 20, [0.0000, 0.0000], [0.0000, 0.0000], [525.0000, 0.0000]),
    ("RemedyRushLevel1-v0", true, "hold:MOVE_FORWARD", 20, [0.7000, 1.0050], [7.5000, 4.3301], [158.5500, 219.1163]),
    ("RemedyRushLevel2-v0", false, "random", 60, [5.5500, 4.1208], [9.6500, 4.9927], [525.0000, 0.0000]),
    ("RemedyRushLevel2-v0", false, "noop", 20, [0.0000, 0.0000], [0.0000, 0.0000], [525.0000, 0.0000]),
    ("RemedyRushLevel2-v0", false, "hold:MOVE_FORWARD", 60, [1.1667, 1.5293], [2.7833, 2.1299], [525.0000, 0.0000]),
    ("RemedyRushLevel3-v0", false, "random", 60, [4.8167, 3.7616], [12.0667, 5.7151], [525.0000, 0.0000]),
    ("RemedyRushLevel3-v0", false, "noop", 20, [0.0000, 0.0000], [0.0000, 0.0000], [525.0000, 0.0000]),
    ("RemedyRushLevel3-v0", false, "hold:MOVE_FORWARD", 60, [0.8167, 1.5863], [2.4167, 1.8911], [525.0000, 0.0000]),
    ("VolcanicVentureLevel1-v0", false, "random", 60, [3.4333, 2.1320], [98.2167, 29.2410], [525.0000, 0.0000]),
    ("VolcanicVentureLevel1-v0", false, "noop", 20, [0.0500, 0.2179], [313.8000, 256.2166], [525.0000, 0.0000]),
    ("VolcanicVentureLevel1-v0", false, "hold:MOVE_FORWARD", 60, [0.7500, 1.0267], [318.9833, 197.0331], [525.0000, 0.0000]),
    ("VolcanicVentureLevel1-v0", true, "random", 60, [0.3167, 0.5914], [12496.8333, 4324.6428], [30.3833, 12.3694]),
    ("VolcanicVentureLevel1-v0", true, "noop", 20, [0.0500, 0.2179], [6499.5000, 5721.5824], [220.8500, 248.3375]),
    ("VolcanicVentureLevel1-v0", true, "hold:MOVE_FORWARD", 60, [0.4167, 0.6656], [13329.1667, 4708.1537], [21.2333, 3.8487]),
    ("VolcanicVentureLevel2-v0", false, "random", 60, [2.8167, 1.7368], [81.9500, 13.0530], [525.0000, 0.0000]),
    ("VolcanicVentureLevel2-v0", false, "noop", 20, [0.0000, 0.0000], [189.0000, 77.7110], [525.0000, 0.0000]),
    ("VolcanicVentureLevel2-v0", false, "hold:MOVE_FORWARD", 60, [0.7833, 0.8184], [254.3333, 39.9619], [525.0000, 0.0000]),
    ("VolcanicVentureLevel3-v0", false, "random", 60, [3.1500, 1.8958], [138.5833, 16.6055], [525.0000, 0.0000]),
    ("VolcanicVentureLevel3-v0", false, "noop", 20, [0.1000, 0.3000], [354.1000, 85.5341], [525.0000, 0.0000]),
    ("VolcanicVentureLevel3-v0", false, "hold:MOVE_FORWARD", 60, [0.4833, 0.6189], [433.1500, 62.7269], [525.0000, 0.0000]),
];

/// Episodes of each row.
fn episodes() -> u64 {
    std::env::var("HASARD_EPISODES").ok().and_then(|digits| digits.parse().ok()).unwrap_or(100)
}

/// Mean and standard deviation.
fn moments(values: impl Iterator<Item = f64> + Clone) -> [f64; 2] {
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    let variance = values.map(|value| (value - mean).powi(2)).sum::<f64>() / count;
    [mean, variance.sqrt()]
}

/// Plays every row of a scenario and lists what lies farther off than three standard errors of both or, if that is larger, 10 %.
fn differences(scenario: &str) -> Vec<String> {
    let mut wrong = Vec::new();
    for &(id, hard, policy, published_episodes, published_return, published_cost, published_length) in PUBLISHED {
        if !id.starts_with(scenario) {
            continue;
        }
        let options = EnvOptions { rules: RuleSet::Released, hard, ..EnvOptions::default() };
        let mut env = Env::new(id, &options).unwrap();
        let policy_at_work: Policy = policy.parse().unwrap();
        let ours: Vec<_> = (0..episodes()).map(|seed| rollout(&mut env, &policy_at_work, 1000 + seed)).collect();
        let ours_count = ours.len() as f64;
        for (what, published, ours) in [
            ("return", published_return, moments(ours.iter().map(|episode| episode.episode_return))),
            ("cost", published_cost, moments(ours.iter().map(|episode| episode.cost))),
            ("length", published_length, moments(ours.iter().map(|episode| f64::from(episode.length)))),
        ] {
            let error = (published[1].powi(2) / f64::from(published_episodes) + ours[1].powi(2) / ours_count).sqrt();
            let (off, allowed) = ((ours[0] - published[0]).abs(), (3.0 * error).max(0.1 * published[0].abs()) + 1e-3);
            let hard = if hard { " hard" } else { "" };
            let line = format!(
                "{id}{hard} {policy} {what}: ours {:.4} +- {:.3}, published {:.4} +- {:.3}, off by {off:.3} of {allowed:.3}",
                ours[0], ours[1], published[0], published[1]
            );
            println!("{line}");
            if off > allowed {
                wrong.push(line);
            }
        }
    }
    wrong
}

#[test]
fn volcanic_venture() {
    assert_eq!(differences("VolcanicVenture"), Vec::<String>::new());
}

#[test]
fn precipice_plunge() {
    assert_eq!(differences("PrecipicePlunge"), Vec::<String>::new());
}

#[test]
fn armament_burden() {
    assert_eq!(differences("ArmamentBurden"), Vec::<String>::new());
}
#[test]
fn collateral_damage() {
    assert_eq!(differences("CollateralDamage"), Vec::<String>::new());
}

#[test]
fn remedy_rush() {
    assert_eq!(differences("RemedyRush"), Vec::<String>::new());
}

#[test]
fn detonators_dilemma() {
    assert_eq!(differences("DetonatorsDilemma"), Vec::<String>::new());
}
