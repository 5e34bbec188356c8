use super::*;
use crate::map::stone_room;
use crate::world::state::world::World;
use crate::world::tables::states::Phase;

/// A world in which a player far from the eastern wall throws a rocket at it, a number of tics
/// after.
fn flight(shed: bool, tics: u32) -> World {
    let mut world = World::new(stone_room(200, [-64, -256, 4000, 256], &[[0.0, 0.0]]), 7);
    world.rockets_shed = shed;
    world.throw_missile(0, ActorKind::Rocket);
    world.finish_tic();
    for _ in 0..tics {
        world.run_thinkers(&[]);
        world.finish_tic();
    }
    world
}

fn squares(world: &World) -> Vec<(u32, Square)> {
    let mut seen = Vec::new();
    for trail in &world.trails {
        let mut left = Vec::new();
        trail.list(world.tic, &mut left);
        seen.extend(
            left.iter().map(|shed| (world.tic - 1 - shed.tic, trail.square(shed, world.tic))),
        );
    }
    seen
}

#[test]
fn as_many_squares_fly_as_in_the_original_and_as_old() {
    let (mut count, mut worlds) = ([0; 3], 0);
    let mut ages = [0; LONGEST_LIFE as usize];
    for tics in 40..160 {
        let world = flight(true, tics);
        for (age, square) in squares(&world) {
            count[square.shade as usize] += 1;
            ages[age as usize] += 1;
        }
        worlds += 1;
    }
    // Measured: seven a tic, one of them yellow, an eighth of the others dark; all lives from 3
    // to 34 tics as often.
    let all: i32 = count.iter().sum();
    assert!((all - worlds * 259 / 2).abs() < worlds * 4, "{all} in {worlds} worlds");
    assert!((all - count[Shade::Yellow as usize] * 7).abs() < all / 10, "{count:?}");
    assert!(
        (all - count[Shade::Yellow as usize] - count[Shade::Dark as usize] * 8).abs() < all / 10,
        "{count:?}"
    );
    assert!(ages[..3].iter().all(|&age| age == worlds * SQUARES as i32), "{ages:?}");
    for (age, &number) in ages.iter().enumerate().skip(3) {
        let left = 7 * worlds * (LONGEST_LIFE as i32 - age as i32) / 32;
        assert!((number - left).abs() <= 12 + left / 5, "{number} of age {age}, not {left}");
    }
}

#[test]
fn squares_appear_behind_the_rocket_and_drift_as_measured() {
    let (mut aside, mut rises) = (Vec::new(), Vec::new());
    let worlds = [40, 75, 110, 145].map(|tics| flight(true, tics));
    for (world, (age, square)) in
        worlds.iter().flat_map(|world| squares(world).into_iter().map(move |seen| (world, seen)))
    {
        let rocket = world.actors.iter().find(|actor| actor.kind == ActorKind::Rocket).unwrap();
        let [x, y, z] = square.place.map(Fixed::to_f64);
        let [behind, above] =
            [rocket.x.to_f64() - x - 20.0 * f64::from(age), z - rocket.z.to_f64()];
        assert!((16.0..=48.0).contains(&behind), "{behind} behind at age {age}");
        if age == 0 {
            assert_eq!((y, square.opacity), (0.0, OPAQUE));
            assert!(
                (5.3..9.4).contains(&above) && (square.shade != Shade::Yellow || above < 5.4),
                "{square:?}"
            );
        } else {
            aside.push(y / f64::from(age));
        }
        if age == 20 && square.shade != Shade::Yellow {
            rises.push(above - 7.3);
        }
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let spread = (aside.iter().map(|v| v * v).sum::<f64>() / aside.len() as f64).sqrt();
    assert!(
        mean(&aside).abs() < 0.08 && (0.28..0.39).contains(&spread),
        "{} {spread}",
        mean(&aside)
    );
    assert!(rises.is_empty() || (1.0..9.0).contains(&mean(&rises)), "{rises:?}");
}

/// In a bare room, of a rocket that flew across the view 60 units ahead: the bytes that its
/// second tic drew, and the first column and row, width and height at 1600x1200 of what each
/// square covered then and in the next three tics.
#[test]
fn squares_are_where_the_published_engine_had_them() {
    const DRAWS: [u8; 75] = [
        107, 69, 202, 58, 173, 98, 51, 125, 178, // the yellow one's
        254, 12, 60, 20, 186, 203, 50, 178, 204, 112, 186, 63, 9, 197, 185, 152, 170, 168, 127,
        215, 72, 52, 156, //
        182, 39, 106, 33, 234, 26, 236, 234, 225, 202, 0, 0, 240, 60, 229, 233, 177, 86, 111, 243,
        22, 199, 95, 103, //
        185, 88, 12, 88, 48, 255, 105, 89, 247, 18, 58, 137, 170, 183, 37, 211, 70, 134, 236,
    ];
    const SEEN: [&[[u16; 4]]; 7] = [
        &[[1353, 590, 7, 9], [1355, 591, 7, 9], [1357, 592, 7, 9], [1359, 595, 7, 9]],
        &[[1406, 537, 10, 13], [1406, 537, 10, 13], [1406, 537, 10, 13], [1405, 537, 10, 13]],
        &[[1353, 534, 10, 13], [1351, 534, 10, 13], [1348, 534, 10, 13], [1345, 533, 10, 13]],
        &[[1467, 530, 10, 13], [1472, 529, 10, 13], [1478, 528, 10, 13], [1483, 527, 11, 13]],
        &[[1311, 560, 10, 13], [1315, 560, 10, 13], [1320, 559, 10, 14]],
        &[[1271, 524, 10, 13], [1270, 524, 10, 13], [1270, 524, 10, 12], [1269, 523, 10, 12]],
        &[[1441, 571, 10, 13], [1442, 570, 10, 13], [1442, 570, 10, 13], [1443, 569, 10, 13]],
    ];
    let mut draws = DRAWS.iter().copied();
    let lots = Lots::of_tic(|| draws.next().unwrap());
    assert_eq!(draws.len(), 0);
    let world = World::new(stone_room(200, [-64, -512, 600, 512], &[[0.0, 0.0]]), 7);
    let [place, velocity] = [[60, -10, 36], [0, 20, 0]].map(|vector| vector.map(Fixed::from_int));
    let id = world.players[0].actor;
    let mut trail =
        Trail::new(id, place, velocity, 37, SectorId(0), Chance::Given(Arc::new([lots])));
    trail.ended = 38;
    for (age, now) in (0..).zip(38..42) {
        let mut left = Vec::new();
        trail.list(now, &mut left);
        let seen: Vec<[u16; 4]> = SEEN.iter().filter_map(|spots| spots.get(age)).copied().collect();
        assert_eq!(left.len(), seen.len(), "tics later: {age}");
        for (shed, [column, row, width, height]) in left.iter().zip(seen) {
            let [x, y, z] = trail.square(shed, now).place.map(Fixed::to_f64);
            let middle = [800.0 - y / x * 800.0, 600.0 - (z - 41.0) / x * 960.0];
            let there = [
                f64::from(column) + f64::from(width) / 2.0,
                f64::from(row) + f64::from(height) / 2.0,
            ];
            assert!(
                middle.iter().zip(there).all(|(here, there)| (here - there).abs() < 1.5),
                "{middle:?}, not {there:?}"
            );
        }
    }
}

#[test]
fn only_pictures_mind_them() {
    for tics in [0, 30, 150, 260] {
        let (with, without) = (flight(true, tics), flight(false, tics));
        assert_eq!((with.state_hash(), &with.rng), (without.state_hash(), &without.rng));
        assert!(without.trails.is_empty() && with.trails.len() == 1);
        assert_eq!(squares(&with.clone()), squares(&with));
    }
}

#[test]
fn a_trail_ends_where_its_rocket_bursts_and_fades() {
    let burst = |world: &World| {
        world
            .actors
            .iter()
            .all(|actor| actor.kind != ActorKind::Rocket || actor.phase == Phase::Death)
    };
    let mut world = flight(true, 0);
    for _ in 0..300 {
        if burst(&world) {
            break;
        }
        world.run_thinkers(&[]);
        world.finish_tic();
    }
    let ended = world.trails[0].ended;
    assert_eq!(ended, world.tic - 1);
    assert!(squares(&world).iter().all(|&(age, _)| age > 0) && !squares(&world).is_empty());
    world.tic += LONGEST_LIFE;
    assert!(squares(&world).is_empty());
    world.trails.retain(|trail| trail.ended.saturating_add(LONGEST_LIFE) > world.tic);
    assert!(world.trails.is_empty());
}
