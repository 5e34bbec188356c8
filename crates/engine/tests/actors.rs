//! Weapons, missiles, blasts, monsters and barrels in small rooms, held against what was measured of the original.

use hasard_engine::map::{Map, MapBuilder, Style};
use hasard_engine::math::Angle;
use hasard_engine::world::{ActorId, ActorKind, Buttons, Command, Event, Phase, Weapon, World, ammo};
use std::sync::Arc;

const STYLE: Style = Style {
    floor: 0,
    ceiling: 80,
    light: 210,
    floor_texture: "STONE5",
    ceiling_texture: "TLITE6_5",
    wall: "SLIME16",
    step: "CRATE1",
    lintel: "SLIME16",
    special: 0,
    tag: 0,
};

/// A room with the player facing east.
fn room(rectangle: [i32; 4], player: (f64, f64), crates: &[([i32; 4], i32)]) -> World {
    let mut builder = MapBuilder::new();
    let [west, south, east, north] = rectangle;
    builder.rectangle(STYLE, west, south, east, north);
    for &([west, south, east, north], floor) in crates {
        builder.rectangle(Style { floor, ..STYLE }, west, south, east, north);
    }
    builder.thing(1, player.0, player.1, 0);
    let source = builder.finish().expect("the room is well formed");
    World::new(Arc::new(Map::build(&source, "room", &[]).expect("the room builds")), 1)
}

/// The room of Collateral Damage, empty: the crates and the notch of its east wall do not matter here.
fn shooting_room(seed: u64) -> World {
    let mut world = room([-576, -640, 256, 640], (-256.0, 0.0), &[]);
    world.rng = hasard_engine::math::Rng::new(seed);
    world
}

/// One tic with `buttons` held, and `script` in the script phase.
fn tic(world: &mut World, buttons: Buttons, script: impl FnOnce(&mut World)) {
    world.run_thinkers(&[Command { buttons, ..Command::default() }]);
    script(world);
    world.finish_tic();
}

fn run(world: &mut World, tics: u32, buttons: Buttons) {
    for _ in 0..tics {
        tic(world, buttons, |_| ());
    }
}

/// Tic 0, in which the scripts arm the player.
fn arm(world: &mut World, weapon: Weapon, rounds: i32) {
    tic(world, Buttons::default(), |world| {
        world.clear_inventory(0);
        world.give_weapon(0, weapon, false);
        world.players[0].ammo[weapon.ammo_type()] = rounds;
    });
}

fn all(world: &World, kind: ActorKind) -> Vec<ActorId> {
    world.living().filter(|(_, actor)| actor.kind == kind).map(|(id, _)| id).collect()
}

fn drain_shots(world: &mut World) -> usize {
    let shots = world.events.iter().filter(|event| matches!(event, Event::Fired { .. })).count();
    world.events.clear();
    shots
}

/// Tics (by their number) in which a shot is fired while `held` says whether ATTACK is down.
fn shots(world: &mut World, tics: u32, held: impl Fn(u32) -> bool) -> Vec<u32> {
    let mut fired = Vec::new();
    for _ in 0..tics {
        let now = world.tic;
        let buttons = if held(now) { Buttons::ATTACK } else { Buttons::default() };
        tic(world, buttons, |_| ());
        fired.extend((0..drain_shots(world)).map(|_| now));
    }
    fired
}

#[test]
fn the_launcher_wants_a_fresh_press_then_fires_8_tics_later_and_every_20() {
    let mut world = shooting_room(1);
    arm(&mut world, Weapon::RocketLauncher, 50);
    assert_eq!(shots(&mut world, 300, |_| true), [], "held since the start");
    let mut world = shooting_room(1);
    arm(&mut world, Weapon::RocketLauncher, 50);
    // Released at tics 16 to 20, pressed from 21: first rocket 9 tics later as the original's traces count.
    let fired = shots(&mut world, 120, |tic| !(16..21).contains(&tic));
    assert_eq!(fired, [29, 49, 69, 89, 109]);
    assert_eq!(world.players[0].ammo[ammo::ROCKET], 45);
}

#[test]
fn the_weapon_is_up_after_16_tics() {
    let mut world = shooting_room(1);
    arm(&mut world, Weapon::RocketLauncher, 50);
    let heights: Vec<f64> = (1..=17)
        .map(|_| {
            run(&mut world, 1, Buttons::default());
            world.players[0].sprites[0].expect("something is in the hands").y.to_f64()
        })
        .collect();
    assert_eq!(heights[..3], [122.0, 116.0, 110.0]);
    assert_eq!(heights[14..], [38.0, 32.375, 32.375]);
}

#[test]
fn the_pistol_fires_after_4_tics_and_every_14_though_held_from_the_start() {
    let mut world = shooting_room(1);
    arm(&mut world, Weapon::Pistol, 200);
    assert_eq!(shots(&mut world, 100, |_| true), [20, 34, 48, 62, 76, 90]);
}

#[test]
fn held_weapons_repeat_at_their_own_pace() {
    let paces = [
        (Weapon::Shotgun, 37, 3),
        (Weapon::SuperShotgun, 57, 3),
        (Weapon::Chaingun, 4, 0),
        (Weapon::PlasmaRifle, 3, 0),
        (Weapon::Bfg9000, 40, 30),
    ];
    for (weapon, pace, delay) in paces {
        let mut world = shooting_room(1);
        arm(&mut world, weapon, 120);
        let fired = shots(&mut world, 200, |tic| tic > 20);
        assert_eq!(fired[0], 21 + delay, "{weapon:?}");
        assert_eq!(fired[1] - fired[0], pace, "{weapon:?}");
    }
}

#[test]
fn a_rocket_starts_30_in_front_at_height_32_flies_20_a_tic_and_burns_18_tics() {
    let mut world = shooting_room(1);
    world.no_autoaim = true;
    arm(&mut world, Weapon::RocketLauncher, 1);
    run(&mut world, 20, Buttons::default());
    let mut flight = Vec::new();
    for _ in 21..80 {
        run(&mut world, 1, Buttons::ATTACK);
        for id in all(&world, ActorKind::Rocket) {
            let rocket = world.get(id).unwrap();
            flight.push((world.tic, rocket.x.to_f64(), rocket.y.to_f64(), rocket.z.to_f64(), rocket.phase));
        }
    }
    assert_eq!(flight[0], (30, -226.0, 0.0, 32.0, Phase::Idle));
    for pair in flight.windows(2).take(23) {
        assert_eq!(pair[1].1 - pair[0].1, 20.0, "at tic {}", pair[0].0);
    }
    // The wall at 256: the rocket stops at the last third of a step that fits.
    let flown = flight.iter().filter(|row| row.4 == Phase::Idle).count();
    let burning = flight.len() - flown;
    assert!((flight[flown].1 - 240.667).abs() < 0.001, "burst at {}", flight[flown].1);
    assert!((14..=17).contains(&burning), "burnt for {burning} tics");
    assert!(all(&world, ActorKind::Rocket).is_empty());
}

#[test]
fn the_splash_on_the_shooter_is_that_of_the_original() {
    let data = include_str!("data/splash_selfdamage.csv");
    let mut rows = 0;
    for line in data.lines().skip(1) {
        let [recorded_burst, distance, damage, armor]: [f64; 4] =
            line.split(',').map(|field| field.parse().unwrap()).collect::<Vec<_>>().try_into().unwrap();
        // In one row the player still drifted: 0.2 map units between firing and burst.
        let mut world = room([-448, -256, 448, 256], (recorded_burst + distance, 150.0), &[]);
        arm(&mut world, Weapon::RocketLauncher, 50);
        let body = world.players[0].actor;
        let player = world.get_mut(body).unwrap();
        (player.angle, player.health) = (Angle::DEG_180, 200);
        run(&mut world, 17, Buttons::default());
        let mut burst_at = None;
        let mut tics = 0;
        while burst_at.is_none() && tics < 100 {
            run(&mut world, 1, Buttons::ATTACK);
            tics += 1;
            burst_at = all(&world, ActorKind::Rocket)
                .into_iter()
                .map(|id| *world.get(id).unwrap())
                .find(|rocket| rocket.phase == Phase::Death)
                .map(|rocket| rocket.x.to_f64());
        }
        let burst_at = burst_at.expect("the rocket bursts");
        let lost = 200 - world.get(body).unwrap().health;
        assert!((burst_at - recorded_burst).abs() < 0.3, "row {rows}: burst at {burst_at}, original {recorded_burst}");
        // The original wore armour that takes half in its first rows.
        let without_armor = damage as i32 + (lost / 2).min(armor as i32);
        assert_eq!(lost, without_armor, "row {rows}: {distance} from the burst");
        rows += 1;
    }
    assert!(rows >= 20, "{rows} rows");
}
