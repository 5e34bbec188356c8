//! Prints what a world costs: four tics of a hall with a hundred items, a reset by copying, a
//! fingerprint.
//!
//! `cargo run --release -p hasard-engine --example tic_cost`

use hasard_engine::map::{Map, MapBuilder, Style, TileGrid};
use hasard_engine::math::{Fixed, Rng};
use hasard_engine::world::{ActorKind, Buttons, Command, World};
use std::sync::Arc;
use std::time::Instant;

fn hall() -> World {
    let grid = TileGrid::new((0, 0), 64, 30, 30, |column, row| Style {
        floor: 8 * ((column * 7 + row * 5) % 3) as i32,
        ceiling: 160,
        light: 200,
        floor_texture: "FLOOR0_1",
        ceiling_texture: "CEIL1_1",
        wall: "STARTAN2",
        step: "STARTAN2",
        lintel: "STARTAN2",
        special: 0,
        tag: 1 + (row * 30 + column) as i32,
    });
    let mut builder = MapBuilder::new();
    grid.paint(&mut builder);
    builder.thing(1, 960.0, 960.0, 0);
    let map = Map::build(&builder.finish().expect("tiles"), "hall", &[]).expect("a map");
    let mut world = World::new(Arc::new(map), 1);
    let mut items = 0;
    while items < 100 {
        let (x, y) = (world.rng.between(32, 1888), world.rng.between(32, 1888));
        let spawned = world.spawn_checked(
            ActorKind::ArmorBonus,
            Fixed::from_int(x),
            Fixed::from_int(y),
            Fixed::from_int(20),
            0,
        );
        items += i32::from(spawned.is_some());
    }
    world
}

/// The least of nine timings of `work`, in microseconds a turn: other programs only ever add to it.
fn time(turns: u32, mut work: impl FnMut(u32)) -> f64 {
    let timings: Vec<f64> = (0..9)
        .map(|_| {
            let start = Instant::now();
            (0..turns).for_each(&mut work);
            start.elapsed().as_secs_f64() * 1e6 / f64::from(turns)
        })
        .collect();
    timings.into_iter().fold(f64::INFINITY, f64::min)
}

fn main() {
    let template = hall();
    let mut world = template.clone();
    let mut rng = Rng::new(2);
    let mut command = Command::default();
    let steps = time(2000, |turn| {
        if turn % 500 == 0 {
            world.clone_from(&template);
        }
        let choices = [Buttons::TURN_LEFT, Buttons::TURN_RIGHT, Buttons::default()];
        command.buttons = Buttons::MOVE_FORWARD | Buttons::SPEED | choices[rng.below(3) as usize];
        for _ in 0..4 {
            world.run_thinkers(&[command]);
            world.finish_tic();
        }
        world.events.clear();
    });
    println!("4 tics, running about among 100 items: {steps:.2} us");
    let mut waggling = template.clone();
    for tag in 1..=900 {
        if tag % 5 == 0 {
            waggling.floor_waggle(tag, 64, 128, 0, 0);
        }
    }
    let swinging = time(200, |_| {
        for _ in 0..4 {
            waggling.run_thinkers(&[command]);
            waggling.finish_tic();
        }
        waggling.events.clear();
    });
    println!("the same with 180 of 900 floors swinging: {swinging:.2} us");
    println!("reset by copying: {:.2} us", time(2000, |_| world.clone_from(&template)));
    println!("fingerprint: {:.2} us", time(200, |_| assert_ne!(world.state_hash(), 0)));
}
