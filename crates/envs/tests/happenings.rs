//! What happened in a step is noted as it was: rewards and costs can be made of it.

use hasard_engine::world::{ActorKind, DamageKind};
use hasard_envs::{Env, EnvOptions, HappeningKind, Policy, PolicyRun, VecEnv, VecOptions};

fn options() -> EnvOptions {
    EnvOptions { events: true, ..EnvOptions::default() }
}

/// The rewards and costs of Remedy Rush and Volcanic Venture follow from their happenings.
#[test]
fn rewards_and_costs_follow_from_what_happened() {
    for id in ["RemedyRushLevel1-v0", "VolcanicVentureLevel1-v0"] {
        let mut env = Env::new(id, &options()).unwrap();
        let (mut taken, mut burnt) = (0, 0);
        for seed in 0..4 {
            env.reset(seed);
            assert!(env.happenings().is_empty());
            let mut run =
                PolicyRun::new("sticky:8".parse::<Policy>().unwrap(), &env, seed).unwrap();
            loop {
                let step = env.make_move(run.next_move(&env)).unwrap();
                let count = |wanted: &dyn Fn(ActorKind) -> bool| {
                    let all = env.happenings().iter();
                    all.filter(|one| one.kind == HappeningKind::Pickup && wanted(one.what)).count()
                };
                let lava: f32 = env
                    .happenings()
                    .iter()
                    .filter(|one| one.cause == Some(DamageKind::Sector))
                    .map(|one| one.amount)
                    .sum();
                if id.starts_with("Remedy") {
                    let vials = count(&|kind| kind == ActorKind::HealthBonus);
                    let packs = count(&|kind| kind == ActorKind::Stimpack);
                    let kits = count(&|kind| kind == ActorKind::Medikit);
                    assert_eq!(step.reward, (vials + 3 * packs + 6 * kits) as f64);
                    taken += vials;
                } else {
                    assert_eq!(step.cost, f64::from(lava));
                    burnt += lava as usize;
                }
                for one in env.happenings() {
                    assert_eq!(one.player, Some(0));
                    assert!(one.tic > env.world().tic - 5 && one.tic <= env.world().tic);
                }
                if step.ended() {
                    break;
                }
            }
        }
        assert!(taken + burnt > 10, "{id}: {taken} {burnt}");
    }
}

#[test]
fn a_batch_notes_each_lane_apart() {
    const LANES: usize = 5;
    let id = "RemedyRushLevel1-v0";
    let make = |threads| {
        let lanes = VecOptions { lanes: LANES, threads, ..VecOptions::default() };
        VecEnv::new(id, &options(), lanes).unwrap()
    };
    let (mut one, mut two) = (make(0), make(2));
    let (mut batch, mut other) = (one.whole_batch(), two.whole_batch());
    one.reset(&mut batch).unwrap();
    two.reset(&mut other).unwrap();
    assert_eq!(batch.happening_offsets, [0; LANES + 1]);
    let groups = one.action_space().groups.len();
    let mut noted = 0;
    for step in 0..600 {
        for lane in 0..LANES {
            batch.actions[lane * groups] = ((step / 9 + lane) % 3) as u8;
            batch.actions[lane * groups + 1] = 1;
        }
        other.actions.clone_from(&batch.actions);
        one.step(&mut batch).unwrap();
        two.step(&mut other).unwrap();
        assert_eq!(batch, other);
        for lane in 0..LANES {
            let happened = batch.happenings_of(lane);
            let worth = |kind| match kind {
                ActorKind::HealthBonus => 1.0,
                ActorKind::Stimpack => 3.0,
                ActorKind::Medikit => 6.0,
                _ => 0.0,
            };
            let earned: f32 = happened.iter().map(|one| worth(one.what)).sum();
            assert_eq!(batch.rewards[lane], earned);
            noted += happened.len();
        }
        assert_eq!(batch.happening_offsets[LANES], batch.happenings.len());
    }
    assert!(noted > 20);
}

#[test]
fn nothing_is_noted_unless_it_is_asked_for() {
    let mut env = Env::new("RemedyRushLevel1-v0", &EnvOptions::default()).unwrap();
    let mut run = PolicyRun::new("sticky:8".parse().unwrap(), &env, 1).unwrap();
    while !env.make_move(run.next_move(&env)).unwrap().ended() {
        assert!(env.happenings().is_empty());
    }
}
