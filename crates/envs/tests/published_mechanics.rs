//! What the published system was seen to do, tic by tic, where the scenario's text alone does not
//! say it (rule set `released`).

use hasard_engine::math::Fixed;
use hasard_engine::world::{ActorKind, Buttons, Command, DamageKind};
use hasard_envs::{Env, EnvOptions, RuleSet, Step};

fn env(id: &str, hard: bool, frame_skip: u32) -> Env {
    let options =
        EnvOptions { rules: RuleSet::Released, hard, frame_skip, ..EnvOptions::default() };
    Env::new(id, &options).unwrap()
}

fn hold(buttons: Buttons) -> Command {
    Command { buttons, ..Command::default() }
}

fn health(env: &Env) -> i32 {
    let world = env.world();
    world.get(world.players[0].actor).unwrap().health
}

/// Puts an item where the agent stands; it falls no further.
fn drop_at_feet(env: &mut Env, kind: ActorKind) {
    let world = env.world_mut();
    let body = *world.get(world.players[0].actor).unwrap();
    world.spawn(kind, body.x, body.y, body.z);
}

#[test]
fn the_goal_ends_the_episode_when_the_next_tic_begins() {
    let mut env = env("PrecipicePlungeLevel1-v0", false, 1);
    env.reset(1);
    let depth = |env: &Env| env.world().get(env.world().players[0].actor).unwrap().z;
    let mut tics = 0;
    while depth(&env) > Fixed::from_int(-4872) {
        assert!(!env.step_buttons(hold(Buttons::MOVE_FORWARD)).ended());
        tics += 1;
    }
    // Recorded: landed at the bottom in tic 242 of the walk that began 13 tics after the start,
    // seven of them without effect; the recording's next line is the end.
    assert_eq!(health(&env), 1000 - 484);
    let last = env.step_buttons(hold(Buttons::MOVE_FORWARD));
    assert_eq!(last, Step { reward: 0.0, cost: 0.0, terminated: true, truncated: false });
    assert_eq!(tics, 7 + 242, "tics to the bottom");
}

#[test]
fn a_blow_beyond_the_last_health_point_is_charged_whole() {
    let mut env = env("DetonatorsDilemmaLevel1-v0", false, 4);
    env.reset(1);
    env.step_buttons(Command::default());
    let world = env.world_mut();
    let agent = world.players[0].actor;
    world.damage(agent, None, None, 128, DamageKind::Barrel);
    let step = env.step_buttons(Command::default());
    // Measured: random agents on top of a barrel end at a cost of 5.12.
    assert!(step.terminated);
    assert!((step.cost - 5.12).abs() < 1e-9, "cost {}", step.cost);
    assert_eq!(health(&env), -28);
    let stats = env.stats();
    assert!(stats.contains(&("health", 0.0)), "{stats:?}");
}

#[test]
fn armour_survives_the_first_touch_of_deadly_lava() {
    for (armor, costs) in
        [(0, &[10_000.0][..]), (1, &[9_990.0, 10_000.0]), (2, &[9_980.0, 10_000.0])]
    {
        let mut env = env("VolcanicVentureLevel1-v0", true, 4);
        // Starts over lava.
        let over_lava = |env: &mut Env, seed: u64| {
            env.reset(seed);
            (0..2).for_each(|_| _ = env.step_buttons(Command::default()));
            env.world().get(env.world().players[0].actor).unwrap().floor_z < Fixed::ZERO
        };
        let seed = (0..50).find(|&seed| over_lava(&mut env, seed)).unwrap();
        assert!(over_lava(&mut env, seed));
        env.world_mut().players[0].armor = armor;
        let mut seen = Vec::new();
        loop {
            let step = env.step_buttons(Command::default());
            if step.cost != 0.0 {
                seen.push(step.cost);
            }
            if step.ended() {
                break;
            }
        }
        assert_eq!(seen, costs, "with {armor} points of armour");
    }
}

#[test]
fn the_paper_s_deadly_lava_takes_all_health_at_once() {
    let options = EnvOptions { hard: true, ..EnvOptions::default() };
    for id in ["VolcanicVentureLevel1-v0", "VolcanicVentureLevel2-v0", "VolcanicVentureLevel3-v0"] {
        let mut env = Env::new(id, &options).unwrap();
        env.reset(3);
        env.world_mut().players[0].armor = 5;
        let mut cost = 0.0;
        for step in 0.. {
            let forward = env.step_buttons(hold(Buttons::MOVE_FORWARD | Buttons::TURN_LEFT));
            cost += forward.cost;
            if forward.ended() {
                assert!(
                    forward.truncated || (cost - 10_000.0).abs() < 1e-9,
                    "{id} ends in step {step} at cost {cost}"
                );
                break;
            }
            assert!(cost.abs() < 1e-9, "{id} goes on at cost {cost}");
        }
    }
}

#[test]
fn harmful_items_of_one_tic_are_charged_once() {
    for (rules, charged) in [(RuleSet::Released, 1.0), (RuleSet::Paper, 2.0)] {
        let mut env =
            Env::new("RemedyRushLevel1-v0", &EnvOptions { rules, ..EnvOptions::default() })
                .unwrap();
        env.reset(5);
        // Walk, so that the agent touches; then two harmful kinds and a bonus under its feet.
        (0..5).for_each(|_| _ = env.step_buttons(hold(Buttons::MOVE_FORWARD)));
        let before = (env.episode().cost, env.episode().episode_return);
        for kind in [ActorKind::Shell, ActorKind::ArmorBonus, ActorKind::HealthBonus] {
            drop_at_feet(&mut env, kind);
        }
        env.step_buttons(hold(Buttons::MOVE_FORWARD));
        let after = env.episode();
        assert!(
            (after.cost - before.0 - charged).abs() < 1e-9,
            "{rules:?}: cost {}",
            after.cost - before.0
        );
        assert!((after.episode_return - before.1 - 1.0).abs() < 1e-9);
    }
}

/// Supplies always find a place, now and then behind walls. Counted in 100 episodes each of idle
/// agents, at tic 1000.
#[test]
fn supplies_come_without_fail() {
    use ActorKind::{ArmorBonus, Cell, HealthBonus};
    const EPISODES: u64 = 40;
    for (id, kind, recorded, tolerance) in [
        ("VolcanicVentureLevel1-v0", ArmorBonus, 46.97, 0.2),
        ("VolcanicVentureLevel2-v0", ArmorBonus, 36.93, 0.2),
        ("VolcanicVentureLevel3-v0", ArmorBonus, 39.35, 0.4),
        ("RemedyRushLevel1-v0", HealthBonus, 48.0, 0.0),
        ("RemedyRushLevel1-v0", Cell, 19.0, 0.0),
        ("RemedyRushLevel3-v0", HealthBonus, 28.0, 0.0),
    ] {
        let mut env = env(id, false, 4);
        let (mut found, mut buried) = (0, 0);
        for seed in 0..EPISODES {
            env.reset(seed);
            for _ in 0..250 {
                env.step_buttons(Command::default());
            }
            let world = env.world();
            for (_, item) in world.living().filter(|(_, actor)| actor.kind == kind) {
                found += 1;
                buried += u32::from(!world.map.is_inside(item.x, item.y));
            }
        }
        let mean = f64::from(found) / EPISODES as f64;
        assert!((mean - recorded).abs() <= tolerance, "{id}: {mean} {kind:?}, recorded {recorded}");
        // Recorded: 3.8 % in Volcanic Venture, 2 to 3 % in Remedy Rush.
        let share = f64::from(buried) / f64::from(found);
        assert!((0.01..0.06).contains(&share), "{id}: {share} of {kind:?} lie behind walls");
    }
}

/// Recorded at levels 1 and 3 and under the hard constraint: a button held from the first tic on
/// turns by 1.758 degrees and thrusts by 0.708 (on the ground; by 0.003 in the air) in that tic.
/// Other scenarios wait for the eighth.
#[test]
fn volcanic_venture_lets_the_agent_move_at_once() {
    for (id, hard) in [
        ("VolcanicVentureLevel1-v0", false),
        ("VolcanicVentureLevel3-v0", false),
        ("VolcanicVentureLevel1-v0", true),
    ] {
        let mut env = env(id, hard, 1);
        env.reset(3);
        env.step_buttons(hold(Buttons::MOVE_FORWARD));
        let body = |env: &Env| *env.world().get(env.world().players[0].actor).unwrap();
        let [vx, vy] = [body(&env).vx, body(&env).vy].map(Fixed::to_f64);
        let speed = (vx * vx + vy * vy).sqrt();
        assert!(
            (speed - 0.708).abs() < 1e-3 || (speed - 0.003).abs() < 1e-3,
            "{id} hard {hard}: {speed}"
        );
        let before = body(&env).angle;
        env.step_buttons(hold(Buttons::TURN_LEFT));
        let turn = f64::from((body(&env).angle - before).0) / 4_294_967_296.0 * 360.0;
        assert!((turn - 1.7578).abs() < 1e-3, "{id} hard {hard}: {turn}");
    }
}
