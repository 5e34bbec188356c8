//! Small halls of tiles for tests.

use hasard_engine::map::{Map, MapBuilder, Style, TileGrid};
use hasard_engine::math::Fixed;
use hasard_engine::world::{Buttons, Command, World};
use std::sync::Arc;

/// A style with everything but heights and tag filled in.
pub fn style(floor: i32, ceiling: i32, tag: i32) -> Style {
    Style {
        floor,
        ceiling,
        light: 200,
        floor_texture: "FLOOR0_1",
        ceiling_texture: "CEIL1_1",
        wall: "STARTAN2",
        step: "STARTAN2",
        lintel: "STARTAN2",
        special: 0,
        tag,
    }
}

/// A hall of `columns` x `rows` tiles of 128 units from (0, 0), with the player at `start` facing
/// east. Tile (c, r) has the height that `floor` gives and the tag 1 + 100 r + c.
#[allow(dead_code, reason = "not every test binary that shares this file needs it")]
pub fn hall(
    columns: usize,
    rows: usize,
    start: (i32, i32),
    floor: impl Fn(usize, usize) -> i32,
) -> World {
    let grid = TileGrid::new((0, 0), 128, columns, rows, |c, r| {
        style(floor(c, r), 200, 1 + 100 * r as i32 + c as i32)
    });
    world_of(&grid, (f64::from(start.0), f64::from(start.1)))
}

/// The world of a grid with one player.
pub fn world_of(grid: &TileGrid, start: (f64, f64)) -> World {
    let mut builder = MapBuilder::new();
    grid.paint(&mut builder);
    builder.thing(1, start.0, start.1, 0);
    World::new(Arc::new(Map::build(&builder.finish().unwrap(), "hall", &[]).unwrap()), 1)
}

/// Runs tics with the same buttons held.
#[allow(dead_code, reason = "not every test binary that shares this file needs it")]
pub fn run(world: &mut World, tics: u32, buttons: Buttons) {
    for _ in 0..tics {
        world.run_thinkers(&[Command { buttons, ..Command::default() }]);
        world.finish_tic();
    }
}

/// Whole map units.
#[allow(dead_code, reason = "not every test binary that shares this file needs it")]
pub fn units(units: i32) -> Fixed {
    Fixed::from_int(units)
}
