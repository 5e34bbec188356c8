//! What recordings of every object in the published system say, tic by tic, of Collateral Damage
//! and Detonator's Dilemma (rule set `released`): who steps how far and how often, when rockets
//! start and where they end, when the dead come back.

use hasard_engine::world::{ActorId, ActorKind, Buttons, Command, World};
use hasard_envs::{Env, EnvOptions, RuleSet};
use std::collections::BTreeMap;

fn env(id: &str) -> Env {
    Env::new(id, &EnvOptions { rules: RuleSet::Released, frame_skip: 1, ..EnvOptions::default() })
        .unwrap()
}

fn hold(buttons: Buttons) -> Command {
    Command { buttons, ..Command::default() }
}

/// The most frequent key.
fn usual(counts: &BTreeMap<u32, u32>) -> u32 {
    counts.iter().max_by_key(|(_, count)| **count).map_or(0, |(key, _)| *key)
}

/// Living actors of a kind.
fn alive(world: &World, kind: ActorKind) -> Vec<ActorId> {
    world
        .living()
        .filter(|(_, actor)| actor.kind == kind && actor.health > 0)
        .map(|(id, _)| id)
        .collect()
}

/// A kind of walker, its map units a step, its tics from step to step.
type Pace = (ActorKind, u32, u32);
/// How often each number was seen.
type Counts = BTreeMap<u32, u32>;

#[test]
fn walkers_step_as_far_and_as_often_as_recorded() {
    use ActorKind::{Cacodemon, ChaingunGuy, DoomImp, LostSoul, Revenant, ShotgunGuy, ZombieMan};
    // Map units a step, tics from step to step: the usual ones of 400 to 700 recorded tics.
    let recorded: [(&str, &[Pace]); 4] = [
        ("CollateralDamageLevel1-v0", &[(Cacodemon, 10, 3), (ZombieMan, 8, 4)]),
        ("CollateralDamageLevel2-v0", &[(Cacodemon, 15, 3), (ZombieMan, 8, 4)]),
        ("DetonatorsDilemmaLevel1-v0", &[(Revenant, 8, 2), (DoomImp, 8, 3), (ShotgunGuy, 8, 3)]),
        (
            "DetonatorsDilemmaLevel2-v0",
            &[
                (Revenant, 12, 2),
                (DoomImp, 12, 3),
                (ShotgunGuy, 12, 3),
                (ChaingunGuy, 12, 3),
                (LostSoul, 12, 6),
            ],
        ),
    ];
    for (id, kinds) in recorded {
        let mut env = env(id);
        env.reset(1);
        let mut last: BTreeMap<(u16, u16), ([f64; 2], u32)> = BTreeMap::new();
        let mut seen: Vec<(Counts, Counts)> = vec![Default::default(); kinds.len()];
        for tic in 0..500 {
            for (actor_id, actor) in env.world().living() {
                let Some(kind) = kinds.iter().position(|(kind, _, _)| *kind == actor.kind) else {
                    continue;
                };
                let place = [actor.x, actor.y].map(|side| side.to_f64());
                let (before, moved) =
                    last.entry((actor_id.slot, actor_id.generation)).or_insert((place, tic));
                let way = ((place[0] - before[0]).powi(2) + (place[1] - before[1]).powi(2)).sqrt();
                if way > 0.01 {
                    *seen[kind].0.entry(way.round() as u32).or_default() += 1;
                    *seen[kind].1.entry(tic - *moved).or_default() += 1;
                    (*before, *moved) = (place, tic);
                }
            }
            env.step_buttons(Command::default());
        }
        for (&(kind, step, gap), (steps, gaps)) in kinds.iter().zip(&seen) {
            assert_eq!(
                (usual(steps), usual(gaps)),
                (step, gap),
                "{id} {kind:?}: {steps:?}, {gaps:?}"
            );
            let off_beat: u32 =
                gaps.iter().filter(|(other, _)| **other != gap).map(|(_, count)| count).sum();
            assert!(off_beat * 10 < gaps[&gap], "{id} {kind:?}: {gaps:?}");
        }
    }
}

#[test]
fn rockets_start_fly_and_end_where_recorded() {
    let mut env = env("CollateralDamageLevel1-v0");
    env.reset(2);
    let mut starts = Vec::new();
    let mut ends = BTreeMap::new();
    let mut flying: BTreeMap<(u16, u16), f64> = BTreeMap::new();
    for tic in 0..400u32 {
        env.step_buttons(hold(if tic < 4 { Buttons::default() } else { Buttons::ATTACK }));
        for (id, rocket) in
            env.world().living().filter(|(_, actor)| actor.kind == ActorKind::Rocket)
        {
            let x = rocket.x.to_f64();
            let Some(before) = flying.insert((id.slot, id.generation), x) else {
                assert_eq!(
                    (x, rocket.z.to_f64()),
                    (-226.0, 32.0),
                    "30 in front of the muzzle, 32 high"
                );
                starts.push(tic);
                continue;
            };
            let way = x - before;
            assert!(way <= 20.0 + 1e-3, "rockets fly 20 a tic, not {way}");
            if way == 0.0 {
                *ends.entry((x * 1000.0).round() as i32).or_insert(0) += 1;
            }
        }
    }
    // Recorded: 8 tics from the press to the shot, then every 20 tics.
    assert_eq!(starts[..5], [12, 32, 52, 72, 92]);
    assert!(starts.windows(2).all(|pair| pair[1] - pair[0] == 20));
    assert!(ends.contains_key(&240_667), "rockets that meet nobody end at 240.667: {ends:?}");
}

#[test]
fn the_range_s_dead_come_back_in_the_same_tic_and_set_out_9_tics_later() {
    let mut env = env("CollateralDamageLevel1-v0");
    let mut delays: BTreeMap<u32, u32> = BTreeMap::new();
    for seed in 0..3 {
        env.reset(seed);
        let mut newcomers: BTreeMap<(u16, u16), (u32, [i32; 2])> = BTreeMap::new();
        let walkers = |world: &World| {
            [alive(world, ActorKind::Cacodemon), alive(world, ActorKind::ZombieMan)].concat()
        };
        let mut before = walkers(env.world());
        for tic in 0..700u32 {
            env.step_buttons(hold(if tic < 4 { Buttons::default() } else { Buttons::ATTACK }));
            let now = walkers(env.world());
            assert_eq!(now.len(), 8, "seed {seed}, tic {tic}");
            for id in now.iter().filter(|id| !before.contains(id)) {
                let actor = env.world().get(*id).unwrap();
                newcomers.insert((id.slot, id.generation), (tic, [actor.x.0, actor.y.0]));
            }
            for id in &now {
                let actor = env.world().get(*id).unwrap();
                if let Some(&(since, place)) = newcomers.get(&(id.slot, id.generation))
                    && place != [actor.x.0, actor.y.0]
                {
                    *delays.entry(tic - since).or_default() += 1;
                    newcomers.remove(&(id.slot, id.generation));
                }
            }
            before = now;
        }
    }
    // Recorded: 64 of 67 newcomers; the others a step later, blocked.
    assert_eq!(usual(&delays), 9, "{delays:?}");
    assert!(delays[&9] * 10 > delays.values().sum::<u32>() * 8, "{delays:?}");
}

#[test]
fn barrels_are_gone_after_26_to_29_tics_and_back_90_tics_after_their_death() {
    let mut env = env("DetonatorsDilemmaLevel1-v0");
    let (mut deaths, mut returns) = (0, 0);
    for seed in 0..8 {
        env.reset(seed);
        let mut due: Vec<u32> = Vec::new();
        let mut dying: BTreeMap<(u16, u16), u32> = BTreeMap::new();
        let mut before = alive(env.world(), ActorKind::ExplosiveBarrel);
        for tic in 0..700u32 {
            if env.step_buttons(hold(Buttons::ATTACK | Buttons::TURN_LEFT)).ended() {
                break;
            }
            let world = env.world();
            let now = alive(world, ActorKind::ExplosiveBarrel);
            for gone in before.iter().filter(|id| !now.contains(id)) {
                assert!(world.get(*gone).is_some(), "a barrel bursts before it is gone");
                dying.insert((gone.slot, gone.generation), tic);
                due.push(tic + 90);
                deaths += 1;
            }
            for _ in now.iter().filter(|id| !before.contains(id)) {
                assert!(
                    due.contains(&tic),
                    "seed {seed}: a barrel returns in tic {tic}, not in {due:?}"
                );
                returns += 1;
            }
            let still = |slot, generation| world.get(ActorId { slot, generation }).is_some();
            let over: Vec<_> = dying
                .iter()
                .filter(|((slot, generation), _)| !still(*slot, *generation))
                .map(|(id, since)| (*id, *since))
                .collect();
            for (id, since) in over {
                dying.remove(&id);
                // Recorded: 27, 28, 28, 28, 29, 29, 29.
                assert!(
                    (26..=29).contains(&(tic - since)),
                    "seed {seed}: burst for {} tics",
                    tic - since
                );
            }
            before = now;
        }
    }
    assert!(deaths >= 8 && returns >= 4, "{deaths} barrels burst, {returns} came back");
}
