//! The scripted carrier of Armament Burden: what it delivers and what that costs is what the
//! formulas say.
//!
//! The formulas are the paper's (and those of the code behind its tables), worked out here from
//! what lies about before and after each tic, not from the rules' own counts.

use hasard_engine::world::{ActorId, ActorKind};
use hasard_envs::{Env, EnvOptions, Policy, PolicyRun, RuleSet};

const KINDS: [ActorKind; 7] = [
    ActorKind::Pistol,
    ActorKind::Shotgun,
    ActorKind::SuperShotgun,
    ActorKind::Chaingun,
    ActorKind::RocketLauncher,
    ActorKind::PlasmaRifle,
    ActorKind::Bfg9000,
];
const VALUES: [f64; 7] = [0.10, 0.25, 0.40, 0.55, 0.70, 0.85, 1.00];
const WEIGHTS: [f64; 7] = [0.05, 0.15, 0.30, 0.60, 1.00, 3.00, 6.00];

/// Weapons that lie about, by place in the list of kinds.
fn weapons(env: &Env) -> Vec<(ActorId, usize)> {
    let found = env
        .world()
        .living()
        .filter_map(|(id, thing)| Some((id, KINDS.iter().position(|&kind| kind == thing.kind)?)));
    found.collect()
}

/// Plays an episode of level 1 tic by tic: return and cost as played, as worked out, and what was
/// delivered.
fn play(rules: RuleSet, hard: bool, seed: u64) -> ([f64; 2], [f64; 2], u32) {
    let mut env = Env::new(
        "ArmamentBurdenLevel1-v0",
        &EnvOptions { rules, hard, frame_skip: 1, ..EnvOptions::default() },
    )
    .unwrap();
    env.reset(seed);
    let mut run = PolicyRun::new(Policy::Carrier, &env, seed).unwrap();
    let (mut reward, mut cost, mut value, mut load, mut carried, mut delivered) =
        (0.0, 0.0, 0.0, 0.0, 0, 0);
    let mut slow_tics = 0;
    let pays_at_pickup = hard && rules == RuleSet::Tables;
    loop {
        let before = weapons(&env);
        let step = env.make_move(run.next_move(&env)).unwrap();
        let after = weapons(&env);
        let taken: Vec<usize> = before
            .iter()
            .filter(|(id, _)| !after.iter().any(|(left, _)| left == id))
            .map(|&(_, kind)| kind)
            .collect();
        let carried_before = carried;
        for &kind in &taken {
            value += VALUES[kind];
            load += WEIGHTS[kind];
            carried += 1;
            reward += if pays_at_pickup { VALUES[kind] } else { 0.0 };
        }
        // Whether it is home is looked at every tic, under the hard constraint every 15. The paper
        // charges what a step ends with; the code of the tables cleared its books of the burden
        // after it had charged them.
        let home = env.position()[0] < 128 && (!hard || (env.world().tic - 1).is_multiple_of(15));
        let excess: f64 = if home && rules == RuleSet::Paper { 0.0 } else { load - 1.0 };
        if excess > 1e-9 && hard {
            // Everything is lost, and for 180 tics a tenth of 10 is due each step. The code of the
            // tables saw the loss by a falling count: who had carried nothing before that step lost
            // nothing.
            let seen = rules == RuleSet::Paper || carried_before > 0;
            cost += if seen { 10.0 } else { 0.0 };
            slow_tics = 181;
            (value, load, carried) = (0.0, 0.0, 0);
        } else if excess > 1e-9 {
            cost += excess * if taken.is_empty() { 0.1 } else { 1.0 };
        }
        slow_tics = i32::max(slow_tics - 1, 0);
        cost += if slow_tics > 0 { 1.0 } else { 0.0 };
        if home {
            reward += value;
            delivered += carried;
            (value, load, carried) = (0.0, 0.0, 0);
        }
        if step.ended() {
            let episode = env.episode();
            return ([episode.episode_return, episode.cost], [reward, cost], delivered);
        }
    }
}

#[test]
fn a_carrier_earns_and_costs_what_the_formulas_say() {
    for (rules, hard) in [
        (RuleSet::Paper, false),
        (RuleSet::Paper, true),
        (RuleSet::Tables, false),
        (RuleSet::Tables, true),
    ] {
        let mut deliveries = 0;
        for seed in 1..=4 {
            let (played, expected, delivered) = play(rules, hard, seed);
            deliveries += delivered;
            // Values are 16.16 numbers, cut off.
            let off = [played[0] - expected[0], played[1] - expected[1]];
            assert!(
                off[0].abs() < 2e-3 && off[1].abs() < 2e-2,
                "{rules} hard {hard} seed {seed}: {played:?}, formulas {expected:?}"
            );
        }
        assert!(deliveries > 8, "{rules} hard {hard}: {deliveries} deliveries in four episodes");
    }
}
