//! Weapons, missiles, blasts, monsters and barrels in small rooms, held against what was measured
//! of the original.
//!
//! Long because each of some twenty measurements is a small room of its own.

use hasard_engine::map::{Map, MapBuilder, Style};
use hasard_engine::math::{Angle, Fixed};
use hasard_engine::world::{
    ActorFlags, ActorId, ActorKind, Buttons, Command, DamageKind, Event, Face, Phase, Weapon,
    World, ammo,
};
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

/// The room of Collateral Damage, empty: the crates and the notch of its east wall do not matter
/// here.
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
    // Released at tics 16 to 20, pressed from 21: first rocket 9 tics later as the original's
    // traces count.
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
            flight.push((
                world.tic,
                rocket.x.to_f64(),
                rocket.y.to_f64(),
                rocket.z.to_f64(),
                rocket.phase,
            ));
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
        let [recorded_burst, distance, damage, armor]: [f64; 4] = line
            .split(',')
            .map(|field| field.parse().unwrap())
            .collect::<Vec<_>>()
            .try_into()
            .unwrap();
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
        assert!(
            (burst_at - recorded_burst).abs() < 0.3,
            "row {rows}: burst at {burst_at}, original {recorded_burst}"
        );
        // The original wore armour that takes half in its first rows.
        let without_armor = damage as i32 + (lost / 2).min(armor as i32);
        assert_eq!(lost, without_armor, "row {rows}: {distance} from the burst");
        rows += 1;
    }
    assert!(rows >= 20, "{rows} rows");
}

/// A level of Collateral Damage: targets, their speed, neutrals, their health, place of the
/// shooter.
#[derive(Clone, Copy)]
struct Range {
    targets: usize,
    speed: i32,
    neutrals: usize,
    neutral_health: i32,
    player_x: f64,
}

const RANGES: [Range; 3] = [
    Range { targets: 4, speed: 10, neutrals: 4, neutral_health: 60, player_x: -256.0 },
    Range { targets: 3, speed: 15, neutrals: 5, neutral_health: 40, player_x: -400.0 },
    Range { targets: 2, speed: 20, neutrals: 6, neutral_health: 20, player_x: -544.0 },
];

/// The room of Collateral Damage with its crates and notch.
fn range_map(player_x: f64) -> Arc<Map> {
    let mut builder = MapBuilder::new();
    let corners = [
        (-576, -640),
        (256, -640),
        (256, 192),
        (224, 192),
        (224, 320),
        (256, 320),
        (256, 640),
        (-576, 640),
    ];
    builder.polygon(STYLE, &corners);
    let crate_of = |floor| Style { floor, ..STYLE };
    builder.rectangle(crate_of(24), 160, -352, 192, -320);
    builder.polygon(crate_of(32), &[(192, -288), (224, -320), (256, -288), (224, -256)]);
    builder.polygon(crate_of(32), &[(-128, 448), (-96, 416), (-64, 448), (-96, 480)]);
    builder.rectangle(crate_of(24), -256, -448, -192, -384);
    builder.rectangle(crate_of(24), 160, 544, 192, 576);
    builder.thing(1, player_x, 0.0, 0);
    Arc::new(Map::build(&builder.finish().unwrap(), "range", &[]).unwrap())
}

/// Collateral Damage as its scripts run it.
struct Gallery {
    world: World,
    range: Range,
    line_x: Fixed,
}

impl Gallery {
    fn new(map: &Arc<Map>, range: Range, seed: u64) -> Gallery {
        let mut world = World::new(Arc::clone(map), seed);
        world.no_autoaim = true;
        let line_x = world.rng.between_fixed(Fixed::ZERO, Fixed::from_int(200));
        let mut gallery = Gallery { world, range, line_x };
        gallery.world.run_thinkers(&[]);
        for (tid, y, next) in [(11, 608, 12), (12, -608, 11)] {
            let id = gallery.world.spawn(
                ActorKind::PatrolPoint,
                line_x,
                Fixed::from_int(y),
                Fixed::ZERO,
            );
            let point = gallery.world.get_mut(id).unwrap();
            (point.tid, point.next_goal) = (tid, next);
        }
        for i in 0..range.targets + range.neutrals {
            gallery.add(if i < range.targets {
                ActorKind::Cacodemon
            } else {
                ActorKind::ZombieMan
            });
        }
        let world = &mut gallery.world;
        world.clear_inventory(0);
        world.give_weapon(0, Weapon::RocketLauncher, false);
        world.players[0].ammo[ammo::ROCKET] = 50;
        world.players[0].damage_factor = Fixed::ZERO;
        world.finish_tic();
        gallery
    }

    fn add(&mut self, kind: ActorKind) {
        let reach = Fixed::from_int(600);
        let id = loop {
            let y = self.world.rng.between_fixed(-reach, reach);
            if let Some(id) = self.world.spawn_checked(kind, self.line_x, y, Fixed::ZERO, 20) {
                break id;
            }
        };
        let tid = self.world.rng.between(11, 12);
        let goal = self.world.patrol_point(tid);
        let monster = self.world.get_mut(id).unwrap();
        monster.angle = Angle::DEG_180;
        if kind == ActorKind::Cacodemon {
            (monster.health, monster.speed) = (120, Fixed::from_int(self.range.speed));
        } else {
            monster.health = self.range.neutral_health;
        }
        self.world.set_goal_of(id, goal);
    }

    /// One tic; gives the targets and neutrals killed.
    fn tic(&mut self, command: Command) -> (u32, u32) {
        let (mut reward, mut cost) = (0, 0);
        self.world.run_thinkers(&[command]);
        let events = std::mem::take(&mut self.world.events);
        for event in events {
            if let Event::Died { victim, kind, .. } = event {
                self.world.remove(victim);
                self.add(kind);
                if kind == ActorKind::Cacodemon {
                    reward += 1;
                } else {
                    cost += 1;
                }
            }
        }
        if self.world.players[0].ammo[ammo::ROCKET] == 0 {
            self.world.give_ammo(0, ammo::ROCKET, 50);
        }
        self.world.finish_tic();
        (reward, cost)
    }
}

fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}

/// Mean and standard deviation over 60 episodes of the original: rewards, then costs.
type Score = [(f64, f64); 2];

/// Plays whole episodes, `policy` choosing buttons for each step of 4 tics, and holds both means
/// against the original's.
fn compare_scores(name: &str, original: [Score; 3], mut policy: impl FnMut(u32) -> Buttons) {
    const EPISODES: u64 = 120;
    for (range, score) in RANGES.into_iter().zip(original) {
        let map = range_map(range.player_x);
        let mut sums = [Vec::new(), Vec::new()];
        for seed in 0..EPISODES {
            let mut gallery = Gallery::new(&map, range, seed);
            let (mut reward, mut cost, mut buttons) = (0, 0, Buttons::default());
            while gallery.world.tic < 2100 {
                // Episodes start at tic 16.
                if gallery.world.tic >= 16 && gallery.world.tic.is_multiple_of(4) {
                    buttons = policy(gallery.world.tic);
                }
                let (targets, neutrals) = gallery.tic(Command { buttons, ..Command::default() });
                (reward, cost) = (reward + targets, cost + neutrals);
            }
            sums[0].push(f64::from(reward));
            sums[1].push(f64::from(cost));
        }
        for (values, (mean, deviation)) in sums.iter().zip(score) {
            let (ours, error) = mean_and_error(values);
            let allowed = 3.0 * (error.powi(2) + deviation.powi(2) / 60.0).sqrt();
            println!(
                "{name}, shooter at {}: {ours:.2}, original {mean:.2}, allowed +-{allowed:.2}",
                range.player_x
            );
            assert!(
                (ours - mean).abs() < allowed,
                "{name}, shooter at {}: {ours} against {mean}",
                range.player_x
            );
        }
    }
}

#[test]
fn a_held_launcher_scores_as_in_the_original() {
    let original = [
        [(25.6167, 5.8284), (19.7167, 5.3388)],
        [(25.9167, 5.0934), (25.7833, 7.294)],
        [(20.6833, 3.6032), (31.7, 7.6164)],
    ];
    compare_scores(
        "held",
        original,
        |tic| if tic >= 20 { Buttons::ATTACK } else { Buttons::default() },
    );
}

#[test]
fn a_random_shooter_scores_as_in_the_original() {
    let original = [
        [(13.25, 6.9753), (13.75, 7.4266)],
        [(8.85, 5.0227), (16.0, 8.5303)],
        [(5.55, 3.4613), (22.1833, 13.6851)],
    ];
    let mut rng = hasard_engine::math::Rng::new(99);
    compare_scores("random", original, move |_| {
        let turn =
            [Buttons::default(), Buttons::TURN_LEFT, Buttons::TURN_RIGHT][rng.below(3) as usize];
        turn | [Buttons::default(), Buttons::ATTACK][rng.below(2) as usize]
    });
}

#[test]
fn monsters_do_not_appear_inside_each_other() {
    let map = range_map(-256.0);
    for seed in 0..200 {
        let gallery = Gallery::new(&map, RANGES[0], seed);
        let world = &gallery.world;
        let monsters: Vec<_> =
            world.living().filter(|(_, actor)| actor.flags.any(ActorFlags::MONSTER)).collect();
        assert_eq!(monsters.len(), 8);
        for (i, (_, one)) in monsters.iter().enumerate() {
            for (_, other) in &monsters[i + 1..] {
                assert!(
                    !one.would_overlap(other, one.x, one.y),
                    "seed {seed}: {:?} in {:?}",
                    one.kind,
                    other.kind
                );
            }
        }
    }
}

/// Empty hall with the player at the west end, a pistol in its hands.
fn hall(seed: u64) -> World {
    let mut world = room([0, 0, 2048, 512], (64.0, 256.0), &[]);
    world.rng = hasard_engine::math::Rng::new(seed);
    arm(&mut world, Weapon::Pistol, 200);
    world
}

fn put(world: &mut World, kind: ActorKind, x: i32, y: i32, health: i32) -> ActorId {
    let id = world.spawn(kind, Fixed::from_int(x), Fixed::from_int(y), Fixed::ZERO);
    world.get_mut(id).unwrap().health = health;
    id
}

/// The tic in which `victim` dies, and who is to blame.
fn await_death(
    world: &mut World,
    victim: ActorId,
    tics: u32,
    buttons: Buttons,
) -> Option<(u32, Option<ActorId>)> {
    for _ in 0..tics {
        let now = world.tic;
        run(world, 1, buttons);
        let died = world.events.iter().find_map(|event| match *event {
            Event::Died { victim: who, source, .. } if who == victim => Some((now, source)),
            _ => None,
        });
        world.events.clear();
        if died.is_some() {
            return died;
        }
    }
    None
}

#[test]
fn a_barrel_bursts_11_to_14_tics_after_the_shot_and_takes_its_neighbours_along() {
    let mut delays = std::collections::BTreeSet::new();
    for seed in 0..40 {
        let mut world = hall(seed);
        let first = put(&mut world, ActorKind::ExplosiveBarrel, 500, 256, 1);
        let second = put(&mut world, ActorKind::ExplosiveBarrel, 600, 256, 1);
        let imp = put(&mut world, ActorKind::DoomImp, 720, 256, 1);
        let player = world.players[0].actor;
        run(&mut world, 17, Buttons::default());
        let (shot, source) =
            await_death(&mut world, first, 100, Buttons::ATTACK).expect("the barrel is hit");
        assert_eq!(source, Some(player));
        let dying = world.get(first).unwrap();
        assert_eq!((dying.phase, dying.label_name()), (Phase::Death, "DeadExplosiveBarrel"));
        assert!(dying.flags.any(ActorFlags::SOLID) && !dying.flags.any(ActorFlags::SHOOTABLE));
        let (chained, source) =
            await_death(&mut world, second, 20, Buttons::default()).expect("the blast reaches it");
        assert_eq!(source, Some(player), "the shooter of the first barrel is to blame");
        delays.insert(chained - shot);
        let (_, source) = await_death(&mut world, imp, 20, Buttons::default())
            .expect("the second blast reaches the imp");
        assert_eq!(source, Some(player));
        run(&mut world, 20, Buttons::default());
        assert!(world.get(first).is_none() && world.get(second).is_none(), "burnt out");
        assert_eq!(world.players[0].kills, 1, "barrels are no kills");
    }
    assert_eq!(delays.into_iter().collect::<Vec<_>>(), [11, 12, 13, 14]);
}

#[test]
fn a_barrel_hurts_in_whole_units_and_pushes_by_mass() {
    let mut world = hall(1);
    let barrel = put(&mut world, ActorKind::ExplosiveBarrel, 164, 256, 1);
    let heavy = put(&mut world, ActorKind::ExplosiveBarrel, 264, 256, 1000);
    world.get_mut(heavy).unwrap().mass = 10_000;
    let player = world.players[0].actor;
    world.damage(barrel, None, None, 1, DamageKind::Script);
    run(&mut world, 20, Buttons::default());
    // 100 map units apart, less the radius: 84 for the player, 90 for the barrel.
    assert_eq!(100 - world.get(player).unwrap().health, 128 - 84);
    assert_eq!(1000 - world.get(heavy).unwrap().health, 128 - 90);
    let (light_moved, heavy_moved) = (
        64.0 - world.get(player).unwrap().x.to_f64(),
        world.get(heavy).unwrap().x.to_f64() - 264.0,
    );
    assert!(light_moved > 10.0, "{light_moved}");
    assert!((0.0..1.0).contains(&heavy_moved), "{heavy_moved}");
}

#[test]
fn bullets_find_targets_at_other_heights_and_a_little_to_the_side() {
    // On a crate above the muzzle, ahead or 3 degrees to the left; the bullet keeps its own
    // direction, so only the height is helped.
    for (y, hit) in [(256, true), (290, false)] {
        let mut world = room([0, 0, 2048, 512], (64.0, 256.0), &[([560, 200, 700, 320], 40)]);
        arm(&mut world, Weapon::Pistol, 200);
        let id = world.spawn(
            ActorKind::DoomImp,
            Fixed::from_int(630),
            Fixed::from_int(y),
            Fixed::from_int(40),
        );
        world.get_mut(id).unwrap().health = 1;
        run(&mut world, 17, Buttons::default());
        assert_eq!(await_death(&mut world, id, 5, Buttons::ATTACK).is_some(), hit, "target at {y}");
    }
}

#[test]
fn a_shot_at_nothing_marks_the_wall_and_the_first_of_a_press_is_accurate() {
    let mut world = hall(3);
    run(&mut world, 17, Buttons::default());
    let mut marks = Vec::new();
    for _ in 0..60 {
        run(&mut world, 1, Buttons::ATTACK);
        for id in all(&world, ActorKind::BulletPuff) {
            let puff = world.get(id).unwrap();
            if !marks.iter().any(|&(known, _)| known == id) {
                marks.push((id, (puff.x.to_f64(), puff.y.to_f64())));
            }
        }
    }
    assert_eq!(marks.len(), 4);
    let (x, y) = marks[0].1;
    assert!((x - 2044.0).abs() < 0.1 && (y - 256.0).abs() < 0.1, "the first mark is at ({x}, {y})");
    assert!(
        marks[1..].iter().any(|(_, (_, y))| (y - 256.0).abs() > 1.0),
        "later ones scatter: {marks:?}"
    );
    run(&mut world, 20, Buttons::default());
    assert!(all(&world, ActorKind::BulletPuff).is_empty());
}

#[test]
fn killed_soldiers_drop_what_they_carried_where_the_rules_say_so() {
    for (kind, dropped) in [
        (ActorKind::ZombieMan, ActorKind::Clip),
        (ActorKind::ShotgunGuy, ActorKind::Shotgun),
        (ActorKind::ChaingunGuy, ActorKind::Chaingun),
    ] {
        for drops in [false, true] {
            let mut world = hall(5);
            world.monsters_drop_items = drops;
            let soldier = put(&mut world, kind, 600, 256, 1);
            world.damage(soldier, None, None, 1, DamageKind::Script);
            world.remove(soldier);
            run(&mut world, 40, Buttons::default());
            assert_eq!(all(&world, dropped).len(), usize::from(drops), "{kind:?}");
        }
    }
    let mut world = hall(5);
    assert!(world.give(0, ActorKind::Shotgun, true));
    assert_eq!(world.players[0].ammo[ammo::SHELL], 4, "a dropped shotgun holds half");
}

#[test]
fn items_are_refused_as_the_table_says() {
    let mut world = hall(1);
    let body = world.players[0].actor;
    for (kind, taken) in [
        (ActorKind::HealthBonus, true),
        (ActorKind::Stimpack, false),
        (ActorKind::Medikit, false),
        (ActorKind::ArmorBonus, true),
        (ActorKind::Infrared, true),
        (ActorKind::BlurSphere, true),
        (ActorKind::Allmap, true),
        (ActorKind::RadSuit, true),
        (ActorKind::Backpack, true),
        (ActorKind::YellowCard, true),
        (ActorKind::BlueSkull, true),
        (ActorKind::ExplosiveBarrel, false),
    ] {
        assert_eq!(world.give(0, kind, false), taken, "{kind:?} at full health");
    }
    assert_eq!(world.get(body).unwrap().health, 101);
    assert_eq!((world.players[0].armor, world.players[0].keys), (1, 3));
    assert_eq!((world.players[0].infrared_tics, world.players[0].rad_suit_tics), (4200, 2100));
    assert!(
        !world.give(0, ActorKind::YellowCard, false) && !world.give(0, ActorKind::BlueSkull, false)
    );
    world.get_mut(body).unwrap().health = 95;
    assert!(world.give(0, ActorKind::Stimpack, false));
    assert_eq!(world.get(body).unwrap().health, 100);
    // The backpack doubled what can be carried.
    assert_eq!(world.players[0].max_ammo, [400, 100, 100, 600]);
    world.clear_inventory(0);
    let counts =
        |world: &mut World, kind| (0..100).take_while(|_| world.give(0, kind, false)).count();
    assert_eq!(counts(&mut world, ActorKind::Shell), 13);
    assert_eq!(counts(&mut world, ActorKind::Cell), 15);
    assert_eq!(counts(&mut world, ActorKind::RocketAmmo), 50);
    assert!(
        world.give(0, ActorKind::PlasmaRifle, false),
        "a new weapon is taken though its ammunition is full"
    );
    assert!(!world.give(0, ActorKind::PlasmaRifle, false));
    assert!(world.give(0, ActorKind::Pistol, false) && world.give(0, ActorKind::Pistol, false));
}

#[test]
fn weapons_change_by_slot_order_and_by_name() {
    let mut world = hall(1);
    run(&mut world, 20, Buttons::default());
    for weapon in [Weapon::Chaingun, Weapon::SuperShotgun] {
        world.give_weapon(0, weapon, false);
    }
    run(&mut world, 40, Buttons::default());
    assert_eq!(
        world.players[0].weapon,
        Some(Weapon::SuperShotgun),
        "a new weapon comes into the hands"
    );
    for (button, expected) in [
        (Buttons::SELECT_NEXT_WEAPON, Weapon::Chaingun),
        (Buttons::SELECT_NEXT_WEAPON, Weapon::Pistol),
        (Buttons::SELECT_PREV_WEAPON, Weapon::Chaingun),
    ] {
        run(&mut world, 1, button);
        run(&mut world, 35, button);
        assert_eq!(world.players[0].weapon, Some(expected), "held, it counts once");
        run(&mut world, 1, Buttons::default());
    }
    assert!(world.select_weapon(0, Weapon::Pistol) && !world.select_weapon(0, Weapon::Bfg9000));
    world.players[0].ammo[ammo::SHELL] = 0;
    assert!(!world.select_weapon(0, Weapon::SuperShotgun), "not without ammunition");
}

#[test]
fn armour_takes_a_third_of_the_damage_but_nothing_of_single_points() {
    let mut world = hall(1);
    let body = world.players[0].actor;
    world.players[0].armor = 50;
    for _ in 0..10 {
        world.damage(body, None, None, 1, DamageKind::Sector);
    }
    assert_eq!((world.get(body).unwrap().health, world.players[0].armor), (90, 50));
    world.damage(body, None, None, 30, DamageKind::Script);
    assert_eq!((world.get(body).unwrap().health, world.players[0].armor), (70, 40));
    assert_eq!(world.players[0].damage_count, 30);
    world.players[0].damage_factor = Fixed::ZERO;
    assert_eq!(world.damage(body, None, None, 50, DamageKind::Script), 0);
    world.players[0].damage_factor = Fixed::ONE;
    assert_eq!(world.damage(body, None, None, 500, DamageKind::Script), 70);
    assert!(world.players[0].dead);
    assert!(
        world
            .events
            .iter()
            .any(|event| matches!(event, Event::Died { kind: ActorKind::Player, .. }))
    );
}

#[test]
fn monsters_stand_without_a_goal_and_walk_at_the_pace_of_their_kind() {
    // Step and tics between steps of each kind, as measured at the speeds of Detonator's Dilemma.
    for (kind, period) in [
        (ActorKind::ZombieMan, 4),
        (ActorKind::ShotgunGuy, 3),
        (ActorKind::ChaingunGuy, 3),
        (ActorKind::DoomImp, 3),
        (ActorKind::Demon, 2),
        (ActorKind::Revenant, 2),
        (ActorKind::LostSoul, 6),
        (ActorKind::Cacodemon, 3),
    ] {
        let mut world = hall(1);
        let monster = world.spawn(kind, Fixed::from_int(300), Fixed::from_int(256), Fixed::ZERO);
        world.get_mut(monster).unwrap().speed = Fixed::from_int(12);
        world.get_mut(monster).unwrap().tid = 9;
        run(&mut world, 100, Buttons::default());
        assert_eq!(world.get(monster).unwrap().x, Fixed::from_int(300), "{kind:?} stands");
        let point = world.spawn(
            ActorKind::PatrolPoint,
            Fixed::from_int(1800),
            Fixed::from_int(256),
            Fixed::ZERO,
        );
        world.get_mut(point).unwrap().tid = 5;
        world.set_goal(9, 5);
        // It notices within 10 tics.
        run(&mut world, 10, Buttons::default());
        let start = world.get(monster).unwrap().x;
        run(&mut world, 120, Buttons::default());
        let walked = (world.get(monster).unwrap().x - start).to_f64();
        assert!(
            (walked - 12.0 * 120.0 / f64::from(period)).abs() <= 24.0 || walked > 1400.0,
            "{kind:?} walked {walked}"
        );
        world.set_goal(9, 77);
        run(&mut world, 20, Buttons::default());
        let stopped = world.get(monster).unwrap().x;
        run(&mut world, 50, Buttons::default());
        assert_eq!(
            world.get(monster).unwrap().x,
            stopped,
            "{kind:?} stands where there is no such goal"
        );
    }
}

#[test]
fn items_at_rest_show_their_frames_by_the_tic_alone() {
    let mut world = hall(1);
    let id = put(&mut world, ActorKind::HealthBonus, 600, 256, 1000);
    let born = world.tic;
    let mut letters = Vec::new();
    for _ in 0..36 {
        run(&mut world, 1, Buttons::default());
        letters.push(world.get(id).unwrap().picture(world.tic).frame);
    }
    let expected: Vec<u8> = (born + 1..=born + 36)
        .map(|tic| [0, 1, 2, 3, 2, 1][((tic - born) / 6 % 6) as usize])
        .collect();
    assert_eq!(letters, expected);
}

#[test]
fn a_rocket_that_bursts_in_its_first_tic_kills_after_the_scripts() {
    let mut world = shooting_room(1);
    arm(&mut world, Weapon::RocketLauncher, 1);
    run(&mut world, 20, Buttons::default());
    let imp = put(&mut world, ActorKind::DoomImp, -256 + 45, 0, 1);
    for _ in 0..9 {
        world.events.clear();
        tic(&mut world, Buttons::ATTACK, |world| {
            assert!(
                !world.events.iter().any(|event| matches!(event, Event::Died { .. })),
                "too early"
            );
            world.events.clear();
        });
    }
    assert!(
        world
            .events
            .iter()
            .any(|event| matches!(*event, Event::Died { victim, .. } if victim == imp))
    );
    assert_eq!(world.get(imp).unwrap().phase, Phase::Death);
}

#[test]
fn muzzle_flashes_light_the_view() {
    let light = |weapon, tics: u32| -> Vec<u8> {
        let mut world = shooting_room(1);
        arm(&mut world, weapon, 10);
        run(&mut world, 20, Buttons::default());
        (0..tics)
            .map(|tic| {
                run(&mut world, 1, if tic == 0 { Buttons::ATTACK } else { Buttons::default() });
                let lit = world.players[0].extra_light;
                assert_eq!(world.players[0].sprites[1].is_some(), lit > 0);
                lit
            })
            .collect()
    };
    // The flash starts with the tic of the shot, which already counts: 7 tics show 6 times after
    // it.
    assert_eq!(light(Weapon::Pistol, 12), [0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 0, 0]);
    assert_eq!(light(Weapon::RocketLauncher, 16), [1, 1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2, 2, 2, 0]);
}

#[test]
fn the_face_glances_winces_grins_and_dies() {
    let mut world = hall(1);
    let body = world.players[0].actor;
    let mut looks = std::collections::BTreeSet::new();
    let mut changes = Vec::new();
    // The grin at the pistol lasts 70 tics.
    run(&mut world, 100, Buttons::default());
    for _ in 0..400 {
        let before = world.players[0].face_state.shown;
        run(&mut world, 1, Buttons::default());
        let shown = world.players[0].face_state.shown;
        let Face::Glance(way) = shown else { panic!("{shown:?} for no reason") };
        looks.insert(way);
        if shown != before {
            changes.push(world.tic);
        }
    }
    assert!(changes.windows(2).all(|pair| (pair[1] - pair[0]) % 17 == 0), "{changes:?}");
    assert_eq!(looks.into_iter().collect::<Vec<_>>(), [0, 1, 2]);
    world.damage(body, None, None, 5, DamageKind::Script);
    run(&mut world, 1, Buttons::default());
    assert_eq!(world.players[0].face_state.shown, Face::Rage);
    world.damage(body, None, None, 40, DamageKind::Script);
    run(&mut world, 1, Buttons::default());
    assert_eq!((world.players[0].face_state.shown, world.face_band(0)), (Face::Ouch, 2));
    world.give_weapon(0, Weapon::Chaingun, false);
    run(&mut world, 1, Buttons::default());
    assert_eq!(world.players[0].face_state.shown, Face::Grin);
    world.damage(body, None, None, 500, DamageKind::Script);
    run(&mut world, 1, Buttons::default());
    assert_eq!(world.players[0].face_state.shown, Face::Dead);
}
