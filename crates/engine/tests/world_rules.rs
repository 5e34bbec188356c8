//! Rules of the world beyond recorded motion: items, room, moving floors, light, damage, copies.
//!
//! Long because each rule is a small room of its own.

mod hall;

use hall::{hall, run, units};
use hasard_engine::map::SectorId;
use hasard_engine::math::{Angle, Fixed, Rng};
use hasard_engine::world::{ActorFlags, ActorKind, Busy, Buttons, Command, Event, World};

const NOTHING: Buttons = Buttons(0);

fn sector(world: &World, tag: i32) -> SectorId {
    world.map.tagged(tag).next().unwrap()
}

fn floor(world: &World, tag: i32) -> Fixed {
    world.sector(sector(world, tag)).floor
}

fn light(world: &World, tag: i32) -> i16 {
    world.sector(sector(world, tag)).light
}

fn body(world: &World) -> &hasard_engine::world::Actor {
    world.get(world.players[0].actor).unwrap()
}

fn pickups(world: &World) -> usize {
    world.events.iter().filter(|event| matches!(event, Event::PickedUp { .. })).count()
}

/// A world past the spawn freeze.
fn ready(mut world: World) -> World {
    run(&mut world, 8, NOTHING);
    world
}

#[test]
fn bodies_neither_turn_nor_walk_in_the_first_seven_tics_after_the_reset_but_look_and_crouch() {
    let mut world = hall(4, 2, (64, 64), |_, _| 0);
    // Tic 0 belongs to the reset.
    run(&mut world, 1, NOTHING);
    let all = Buttons::MOVE_FORWARD | Buttons::TURN_LEFT | Buttons::LOOK_UP | Buttons::CROUCH;
    run(&mut world, 1, all);
    // Recorded: -2.4719 degrees and a twelfth of the eye's 41 units from the first tic on.
    let first_pitch = f64::from(world.players[0].pitch) / 4_294_967_296.0 * 360.0;
    assert!((first_pitch + 2.4719).abs() < 1e-4, "{first_pitch}");
    assert!((world.players[0].view_height.to_f64() - 41.0 * 11.0 / 12.0).abs() < 1e-3);
    run(&mut world, 6, all);
    assert_eq!((body(&world).x, body(&world).angle), (units(64), Angle::EAST));
    run(&mut world, 1, all);
    assert!(body(&world).x > units(64));
    // The turn key was held all the while, so that the turn is the fast one at once.
    assert_eq!(body(&world).angle, Angle::from_turn_65536(640));
}

#[test]
fn items_are_taken_in_passing_but_not_by_standing_still() {
    let mut world = ready(hall(4, 2, (64, 64), |_, _| 0));
    // On top of the player: he must move to take it.
    world.spawn_checked(ActorKind::ArmorBonus, units(64), units(64), units(0), 7).unwrap();
    run(&mut world, 5, NOTHING);
    assert_eq!(pickups(&world), 0);
    run(&mut world, 1, Buttons::MOVE_FORWARD);
    assert_eq!(pickups(&world), 1);
    let Some(Event::PickedUp { player: 0, kind: ActorKind::ArmorBonus, tid: 7, .. }) =
        world.events.iter().find(|event| matches!(event, Event::PickedUp { .. }))
    else {
        panic!("{:?}", world.events)
    };
}

#[test]
fn the_touch_reaches_36_units_in_the_plane() {
    for (distance, taken) in [(35, 1), (36, 0)] {
        let mut world = ready(hall(4, 2, (200, 64), |_, _| 0));
        world
            .spawn_checked(ActorKind::ArmorBonus, units(200 + distance), units(64), units(0), 0)
            .unwrap();
        // A push to the north, so that the distance to the east stays.
        world.thrust_thing(world.players[0].actor, 64, 1);
        run(&mut world, 1, NOTHING);
        assert_eq!(pickups(&world), taken, "{distance}");
    }
}

#[test]
fn feet_at_an_items_top_pass_over_it() {
    for (height, taken) in [(15, 1), (16, 0)] {
        let mut world = ready(hall(4, 2, (64, 64), |_, _| 0));
        world.spawn_checked(ActorKind::ArmorBonus, units(100), units(64), units(0), 0).unwrap();
        assert!(world.set_position(world.players[0].actor, units(64), units(64), units(height)));
        world.thrust_thing(world.players[0].actor, 0, 10);
        run(&mut world, 1, NOTHING);
        assert_eq!(pickups(&world), taken, "{height}");
    }
    // From below, an item is out of reach only above the head.
    for (height, taken) in [(55, 1), (56, 0)] {
        let mut world = ready(hall(4, 2, (64, 64), |_, _| 0));
        let item = world
            .spawn_checked(ActorKind::ArmorBonus, units(64), units(64), units(height), 0)
            .unwrap();
        world.get_mut(item).unwrap().flags.set(ActorFlags::NO_GRAVITY, true);
        run(&mut world, 1, Buttons::MOVE_FORWARD);
        assert_eq!(pickups(&world), taken, "{height}");
    }
}

#[test]
fn a_moving_floor_hands_a_standing_player_what_he_touches() {
    let mut world = ready(hall(4, 2, (64, 64), |_, _| 0));
    world.spawn_checked(ActorKind::ArmorBonus, units(64), units(64), units(0), 0).unwrap();
    run(&mut world, 5, NOTHING);
    assert_eq!(pickups(&world), 0);
    world.floor_move_to_value(1, 8, 4);
    run(&mut world, 2, NOTHING);
    assert_eq!(pickups(&world), 1);
}

#[test]
fn items_fall_to_the_floor_under_their_centre_and_rise_with_a_neighbour() {
    let mut world = hall(4, 2, (64, 64), |column, _| if column == 2 { 16 } else { 0 });
    // The item's square reaches over tile 2, which is higher.
    let item =
        world.spawn_checked(ActorKind::ArmorBonus, units(250), units(64), units(20), 0).unwrap();
    run(&mut world, 20, NOTHING);
    assert_eq!(world.get(item).unwrap().z, units(0));
    // Whatever moves nearby lifts it to the highest floor that it touches.
    world.floor_move_to_value(3, 8, 17);
    run(&mut world, 3, NOTHING);
    assert_eq!(world.get(item).unwrap().z, units(17));
}

#[test]
fn spawning_tests_walls_heights_and_solids() {
    let mut world = hall(4, 2, (64, 64), |column, _| if column == 2 { 16 } else { 0 });
    let mut fits = |kind, x, y, z| match world.spawn_checked(kind, units(x), units(y), units(z), 0)
    {
        Some(id) => {
            world.remove(id);
            true
        }
        None => false,
    };
    // Walls: 20 is the radius, and touching is no cut.
    assert!(fits(ActorKind::ArmorBonus, 20, 200, 0) && !fits(ActorKind::ArmorBonus, 19, 200, 0));
    // The floor under the centre counts, not that of neighbours; the ceiling is at 200 and the item
    // 16 high.
    assert!(fits(ActorKind::ArmorBonus, 250, 200, 0) && !fits(ActorKind::ArmorBonus, 300, 200, 15));
    assert!(
        fits(ActorKind::ArmorBonus, 300, 200, 16) && fits(ActorKind::ArmorBonus, 300, 200, 184)
    );
    assert!(!fits(ActorKind::ArmorBonus, 300, 200, 185));
    // Solids keep clear of the player's square, but fit above him; items do not care.
    assert!(!fits(ActorKind::ZombieMan, 99, 64, 0) && fits(ActorKind::ZombieMan, 100, 64, 0));
    assert!(fits(ActorKind::ZombieMan, 64, 64, 56) && fits(ActorKind::ArmorBonus, 64, 64, 0));
}

#[test]
fn a_refused_position_leaves_the_actor_where_it_was() {
    let mut world = ready(hall(4, 2, (64, 64), |column, _| if column == 2 { 16 } else { 0 }));
    let player = world.players[0].actor;
    assert!(!world.set_position(player, units(10), units(64), units(0)));
    assert_eq!((body(&world).x, body(&world).z), (units(64), units(0)));
    assert!(world.set_position(player, units(300), units(100), units(40)));
    assert_eq!((body(&world).x, body(&world).z), (units(300), units(40)));
    run(&mut world, 10, NOTHING);
    assert_eq!(body(&world).z, units(16));
    // Items at the new place are not taken.
    world.spawn_checked(ActorKind::ArmorBonus, units(64), units(64), units(0), 0).unwrap();
    assert!(world.set_position(player, units(64), units(64), units(0)));
    assert_eq!(pickups(&world), 0);
}

#[test]
fn floors_move_in_eighths_and_arrive_exactly() {
    let mut world = hall(4, 2, (64, 64), |_, _| 0);
    world.floor_lower_by_value(4, 100, 40);
    let mut heights = Vec::new();
    for _ in 0..5 {
        run(&mut world, 1, NOTHING);
        heights.push(floor(&world, 4).to_f64());
    }
    assert_eq!(heights, [-12.5, -25.0, -37.5, -40.0, -40.0]);
    // A negative amount raises at once; so does the ceiling's.
    world.floor_lower_by_value(4, 8, -30);
    world.ceiling_lower_by_value(4, 8, -30);
    run(&mut world, 1, NOTHING);
    let state = world.sector(sector(&world, 4));
    assert_eq!((state.floor, state.ceiling), (units(-10), units(230)));
    // A busy floor ignores new movers.
    world.floor_move_to_value(4, 8, 10);
    world.floor_move_to_value(4, 800, -200);
    run(&mut world, 30, NOTHING);
    assert_eq!(floor(&world, 4), units(10));
}

#[test]
fn movers_started_by_a_script_move_in_the_same_tic() {
    let mut world = hall(4, 2, (64, 64), |_, _| 0);
    world.run_thinkers(&[]);
    world.floor_lower_by_value(4, 1000, 300);
    world.finish_tic();
    assert_eq!(floor(&world, 4), units(-125));
}

#[test]
fn floors_carry_whom_they_can() {
    let mut world = ready(hall(4, 2, (64, 64), |_, _| 0));
    world.floor_move_to_value(1, 80, 50);
    run(&mut world, 3, NOTHING);
    assert_eq!(body(&world).z, units(30));
    run(&mut world, 5, NOTHING);
    // Slow floors take their riders down; from 9 units per tic on they fall behind.
    world.floor_move_to_value(1, 64, 0);
    run(&mut world, 3, NOTHING);
    assert_eq!((body(&world).z, floor(&world, 1)), (units(26), units(26)));
    run(&mut world, 10, NOTHING);
    world.floor_move_to_value(1, 72, -90);
    run(&mut world, 2, NOTHING);
    assert!(body(&world).z > floor(&world, 1));
}

#[test]
fn swinging_floors_have_the_scripts_amplitude_and_period() {
    // Volcanic Venture level 3: amplitude 192, frequency 256, a second; the tile swung 8..=56
    // about 32.
    let mut world = hall(4, 2, (64, 64), |_, _| 32);
    world.floor_waggle(7, 192, 256, 0, 1);
    world.floor_waggle(4, 192, 256, 0, 1);
    assert!(world.map.tagged(7).next().is_none());
    let heights: Vec<f64> = (0..300)
        .map(|_| {
            run(&mut world, 1, NOTHING);
            floor(&world, 4).to_f64()
        })
        .collect();
    let limits =
        heights.iter().fold((f64::MAX, f64::MIN), |(low, high), &h| (low.min(h), high.max(h)));
    assert!((limits.0 - 8.0).abs() < 0.02 && (limits.1 - 56.0).abs() < 0.02, "{limits:?}");
    // It grows for 35 + 105 * 192 / 255 = 114 tics; in full swing the period is 16 tics.
    assert_eq!(heights[120..130], heights[136..146]);
    // Full for 35 tics more, then it shrinks and ends at the height that it had.
    assert!(heights[265..].iter().all(|&h| h == 32.0));
    assert!(!world.sector(sector(&world, 4)).busy.any(Busy::FLOOR));
}

#[test]
fn floors_that_are_stopped_stay_and_the_others_swing_on() {
    let swinging = || {
        let mut world = hall(8, 2, (64, 64), |_, _| 32);
        (1..=6).for_each(|tag| world.floor_waggle(tag, 100 + 20 * tag, 256, 0, 1));
        world.floor_move_to_value(7, 1, 100);
        run(&mut world, 60, NOTHING);
        world
    };
    let (mut world, mut undisturbed) = (swinging(), swinging());
    let stopped = [2, 5, 7].map(|tag| {
        world.stop_floors(tag);
        (tag, floor(&world, tag))
    });
    for tic in 0..300 {
        run(&mut world, 1, NOTHING);
        run(&mut undisturbed, 1, NOTHING);
        for tag in [1, 3, 4, 6] {
            assert_eq!(
                floor(&world, tag),
                floor(&undisturbed, tag),
                "floor {tag}, {tic} tics later"
            );
        }
        assert!(
            stopped.iter().all(|&(tag, height)| floor(&world, tag) == height),
            "{tic} tics later"
        );
    }
    assert!((1..=7).all(|tag| !world.sector(sector(&world, tag)).busy.any(Busy::FLOOR)));
    world.floor_waggle(5, 200, 256, 0, 1);
    run(&mut world, 60, NOTHING);
    assert_ne!(floor(&world, 5), stopped[1].1);
}

#[test]
fn lights_glow_in_a_triangle_and_strobe_dark_first() {
    let mut world = hall(4, 2, (64, 64), |_, _| 0);
    world.light_glow(1, 200, 100, 50);
    world.light_strobe(2, 255, 0, 20, 40);
    // A second effect in the same sector is ignored.
    world.light_strobe(1, 255, 0, 20, 40);
    let (mut glow, mut strobe) = (Vec::new(), Vec::new());
    for _ in 0..130 {
        run(&mut world, 1, NOTHING);
        glow.push(light(&world, 1));
        strobe.push(light(&world, 2));
    }
    assert_eq!(
        (glow[0], glow[1], glow[25], glow[50], glow[75], glow[100]),
        (200, 198, 150, 100, 150, 200)
    );
    assert_eq!(glow[..30], glow[100..]);
    let expected: Vec<i16> = (0..130).map(|tic| if tic % 60 < 40 { 0 } else { 255 }).collect();
    assert_eq!(strobe, expected);
    world.light_change_to_value(3, 300);
    assert_eq!(light(&world, 3), 300);
}

#[test]
fn harmful_floors_hurt_those_who_stand_on_them() {
    let mut world = ready(hall(4, 2, (64, 64), |column, _| if column == 1 { 8 } else { 0 }));
    world.set_sector_damage(1, 1, 4, 0);
    let health = |world: &World| body(world).health;
    run(&mut world, 8, NOTHING);
    assert_eq!(health(&world), 98);
    // In the air there is no damage.
    let player = world.players[0].actor;
    world.get_mut(player).unwrap().vz = units(8);
    run(&mut world, 1, NOTHING);
    let before = health(&world);
    run(&mut world, 15, NOTHING);
    assert_eq!(health(&world), before);
    // Nor on the edge of a neighbour, higher by 8, with the centre still inside.
    assert!(world.set_position(player, units(120), units(64), units(8)));
    world.thrust_thing(player, 64, 1);
    run(&mut world, 20, NOTHING);
    assert_eq!((body(&world).z, health(&world)), (units(8), before));
}

#[test]
fn the_map_special_83_burns_before_any_script() {
    let grid = hasard_engine::map::TileGrid::new((0, 0), 128, 2, 2, |column, row| {
        hasard_engine::map::Style {
            special: 83,
            ..hall::style(0, 200, (1 + column + 2 * row) as i32)
        }
    });
    let mut world = hall::world_of(&grid, (64.0, 64.0));
    run(&mut world, 1, NOTHING);
    assert_eq!(body(&world).health, 92);
    run(&mut world, 31, NOTHING);
    assert_eq!(body(&world).health, 92);
    run(&mut world, 1, NOTHING);
    assert_eq!(body(&world).health, 84);
}

#[test]
fn players_are_in_each_others_way() {
    let mut world = hall(8, 2, (64, 64), |_, _| 0);
    let second = world.add_player(units(200), units(64), Angle::DEG_180);
    let forward = Command { buttons: Buttons::MOVE_FORWARD, ..Command::default() };
    for _ in 0..80 {
        world.run_thinkers(&[forward, forward]);
        world.finish_tic();
    }
    let gap = world.get(world.players[second].actor).unwrap().x - body(&world).x;
    assert!(gap >= units(32) && gap < units(34), "{gap}");
}

#[test]
fn a_crouched_player_stays_down_under_a_low_ceiling() {
    let grid = hasard_engine::map::TileGrid::new((0, 0), 128, 3, 1, |column, _| {
        hall::style(0, if column == 1 { 40 } else { 200 }, column as i32 + 1)
    });
    let mut world = ready(hall::world_of(&grid, (64.0, 64.0)));
    run(&mut world, 60, Buttons::MOVE_FORWARD | Buttons::SPEED);
    assert!(body(&world).x < units(113), "upright he does not fit");
    while body(&world).x < units(192) {
        run(&mut world, 1, Buttons::MOVE_FORWARD | Buttons::SPEED | Buttons::CROUCH);
    }
    run(&mut world, 20, NOTHING);
    // He rises as far as the room allows.
    assert_eq!((world.players[0].crouch.to_f64() * 12.0 + 0.5).floor(), 8.0);
    while body(&world).x < units(320) {
        run(&mut world, 1, Buttons::MOVE_FORWARD | Buttons::SPEED);
    }
    run(&mut world, 20, NOTHING);
    assert_eq!((world.players[0].crouch, body(&world).height), (Fixed::ONE, units(56)));
}

#[test]
fn solid_things_low_enough_are_stepped_on() {
    let mut world = ready(hall(6, 2, (64, 64), |column, _| if column == 1 { 24 } else { 0 }));
    // A column 40 high beside the tile of height 24: 16 to climb from there, too much from the
    // floor.
    world.spawn_checked(ActorKind::ShortRedColumn, units(280), units(64), units(0), 0).unwrap();
    run(&mut world, 1, NOTHING);
    let mut highest = Fixed::ZERO;
    for _ in 0..60 {
        run(&mut world, 1, Buttons::MOVE_FORWARD);
        highest = highest.max(body(&world).z);
    }
    assert_eq!(highest, units(40));
    let mut world = ready(hall(6, 2, (64, 64), |_, _| 0));
    world.spawn_checked(ActorKind::ShortRedColumn, units(280), units(64), units(0), 0).unwrap();
    run(&mut world, 80, Buttons::MOVE_FORWARD);
    assert_eq!((body(&world).x.floor(), body(&world).z), (247, units(0)));
}

/// A world with everything in motion, driven by a seed.
fn busy(world: &mut World, rng: &mut Rng, tics: u32) {
    for _ in 0..tics {
        let held = Buttons(rng.below(1 << 16) & !Buttons::ATTACK.0);
        let command = Command {
            buttons: held,
            turn_delta: rng.between(-1365, 1365),
            look_delta: rng.between(-1365, 1365),
        };
        world.run_thinkers(&[command]);
        if world.tic.is_multiple_of(16) {
            let (x, y) = (rng.between(30, 1000), rng.between(30, 1000));
            let kind = [ActorKind::ArmorBonus, ActorKind::Medikit, ActorKind::ExplosiveBarrel]
                [rng.below(3) as usize];
            world.spawn_checked(kind, units(x), units(y), units(60), 0);
            let tag = 1 + 100 * rng.between(0, 7) + rng.between(0, 7);
            match rng.below(3) {
                0 => world.floor_move_to_value(tag, 100, rng.between(0, 40)),
                1 => world.floor_waggle(tag, 64, 64, 0, 1),
                _ => world.light_glow(tag, 200, 100, 20),
            }
        }
        world.finish_tic();
    }
}

#[test]
fn a_restored_snapshot_goes_on_as_if_nothing_had_been() {
    let mut world = hall(8, 8, (512, 512), |_, _| 0);
    let template = world.clone();
    let mut rng = Rng::new(5);
    busy(&mut world, &mut rng, 300);
    let (snapshot, rng_then) = (world.clone(), rng.clone());
    assert_eq!(snapshot.state_hash(), world.state_hash());
    busy(&mut world, &mut rng, 300);
    let straight = world.state_hash();
    // Into a fresh copy, and over a world full of other things.
    let mut restored = snapshot.clone();
    busy(&mut restored, &mut rng_then.clone(), 300);
    assert_eq!(restored.state_hash(), straight);
    world.clone_from(&snapshot);
    assert_eq!(world.state_hash(), snapshot.state_hash());
    busy(&mut world, &mut rng_then.clone(), 300);
    assert_eq!(world.state_hash(), straight);
    // A used world reset from the template is the template.
    world.clone_from(&template);
    assert_eq!(world.state_hash(), template.state_hash());
    busy(&mut world, &mut Rng::new(6), 300);
    assert_ne!(world.state_hash(), snapshot.state_hash());
}

#[test]
fn removed_actors_are_never_mistaken_for_their_successors() {
    let mut world = hall(4, 2, (64, 64), |_, _| 0);
    let first = world.spawn(ActorKind::ArmorBonus, units(200), units(64), units(0));
    world.remove(first);
    let second = world.spawn(ActorKind::Medikit, units(200), units(64), units(0));
    assert_eq!(first.slot, second.slot);
    assert!(world.get(first).is_none() && world.get_mut(first).is_none());
    world.remove(first);
    assert_eq!(world.get(second).unwrap().kind, ActorKind::Medikit);
}
