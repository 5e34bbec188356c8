//! Every step that monsters of the original were recorded to take must be one that ours could take
//! from the same place.

use crate::map::{Map, MapBuilder, Style};
use crate::math::{Angle, Fixed, Rng};
use crate::world::state::world::World;
use crate::world::tables::heading::Heading;
use crate::world::tables::kinds::ActorKind;
use crate::world::tables::states::Phase;
use std::sync::Arc;

pub(in crate::world) const STYLE: Style = Style {
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

/// Tic of the recording's first row, and of its last.
const FIRST_TIC: u32 = 16;
const LAST_TIC: u32 = 500;

/// The room of the recording: Collateral Damage with its crates and notch.
fn room() -> Arc<Map> {
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
    builder.thing(1, -256.0, 0.0, 0);
    Arc::new(
        Map::build(&builder.finish().expect("the room is well formed"), "room", &[])
            .expect("the room builds"),
    )
}

/// Where each of eight monsters is after each tic.
fn recording() -> Vec<[(f64, f64); 8]> {
    let mut places = vec![[(0.0, 0.0); 8]; (LAST_TIC + 1) as usize];
    for line in include_str!("../../../tests/data/patrol.csv").lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let (tic, monster): (usize, usize) =
            (fields[0].parse().unwrap(), fields[1].parse().unwrap());
        for row in &mut places[tic..] {
            row[monster] = (fields[2].parse().unwrap(), fields[3].parse().unwrap());
        }
    }
    places
}

fn close(a: Fixed, b: f64) -> bool {
    (a.to_f64() - b).abs() < 0.01
}

#[test]
fn recorded_patrols_are_explained_step_by_step() {
    let places = recording();
    let start = places[FIRST_TIC as usize];
    let mut world = World::new(room(), 1);
    let line_x = Fixed::from_f64(start[0].0);
    let point = |world: &mut World, tid, y, next| {
        let id = world.spawn(ActorKind::PatrolPoint, line_x, Fixed::from_int(y), Fixed::ZERO);
        let actor = world.get_mut(id).unwrap();
        (actor.tid, actor.next_goal) = (tid, next);
        id
    };
    let goals = [point(&mut world, 11, 608, 12), point(&mut world, 12, -608, 11)];
    let mut slots = Vec::new();
    for (monster, &(x, y)) in start.iter().enumerate() {
        let kind = if monster < 4 { ActorKind::Cacodemon } else { ActorKind::ZombieMan };
        let id = world.spawn(kind, Fixed::from_f64(x), Fixed::from_f64(y), Fixed::ZERO);
        let north = places.iter().skip(FIRST_TIC as usize).find(|row| row[monster].1 != y).unwrap()
            [monster]
            .1
            > y;
        let actor = world.get_mut(id).unwrap();
        actor.speed = Fixed::from_int(if monster < 4 { 10 } else { 8 });
        (actor.heading, actor.goal) =
            if north { (Heading::North, Some(goals[0])) } else { (Heading::South, Some(goals[1])) };
        actor.angle = if north { Angle::DEG_90 } else { Angle::DEG_90 + Angle::DEG_180 };
        (actor.pursuing, actor.phase) = (true, Phase::Walk);
        slots.push(usize::from(id.slot));
    }
    let (mut steps, mut turns) = (0, 0);
    for tic in FIRST_TIC..LAST_TIC {
        for (monster, &slot) in slots.iter().enumerate() {
            let period = if monster < 4 { 3 } else { 4 };
            world.move_actor(slot);
            if (tic - 9) % period != 0 {
                continue;
            }
            let (x, y) = places[tic as usize + 1][monster];
            let before = world.actors[slot];
            // On in the old direction, or, with any luck, in a new one.
            let found = [(15, 1), (0, 60)]
                .into_iter()
                .flat_map(|(left, seeds)| (0..seeds).map(move |seed| (left, seed)))
                .find_map(|(steps_left, seed)| {
                    let mut copy = world.clone();
                    copy.rng = Rng::new(seed);
                    copy.actors[slot].steps_left = steps_left;
                    copy.chase(slot);
                    (close(copy.actors[slot].x, x) && close(copy.actors[slot].y, y)).then_some(copy)
                });
            let Some(found) = found else {
                panic!(
                    "tic {tic}, monster {monster}: from {before:?} to ({x}, {y}) is no step of ours"
                );
            };
            world = found;
            steps += 1;
            turns += u32::from(world.actors[slot].heading != before.heading);
        }
        world.tic += 1;
    }
    assert!(steps > 1000 && turns > 80, "{steps} steps, {turns} turns");
}
