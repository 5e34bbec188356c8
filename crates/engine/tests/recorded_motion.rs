//! Replays recorded motion of the original tic by tic: every file in `traces/` on a map of the same
//! shape.

use hasard_engine::map::{Map, MapBuilder, Style, TileGrid};
use hasard_engine::math::{Angle, Fixed};
use hasard_engine::world::{Buttons, Command, World};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Tics that had passed when the recordings start: one of the reset, then 12 without input.
const TICS_BEFORE: u32 = 13;

/// Allowed difference of positions, velocities and eye height, 65536ths of a map unit.
const UNIT_TOLERANCE: i64 = 2;

/// Allowed difference of angle and pitch, millionths of a degree.
const ANGLE_TOLERANCE: i64 = 100;

/// What a recording says about one tic, by the letters of `traces/convert.py`.
type Row = BTreeMap<char, i64>;

/// A recording: the start, then an action and the outcome for each tic.
struct Trace {
    start: Row,
    tics: Vec<(Command, Row)>,
}

fn read_trace(path: &Path) -> Trace {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let numbers = |line: &str| -> Vec<(char, i64)> {
        line.split(' ')
            .map(|word| (word.chars().next().unwrap(), word[1..].parse().unwrap()))
            .collect()
    };
    let start: Row = numbers(lines.next().unwrap()).into_iter().collect();
    let (mut row, mut command, mut tics) = (start.clone(), Command::default(), Vec::new());
    for line in lines {
        if let Some(action) = line.strip_prefix("> ") {
            command = read_action(action);
        } else if let Some(count) = line.strip_prefix('.') {
            let count = if count.is_empty() { 1 } else { count.parse().unwrap() };
            tics.extend((0..count).map(|_| (command, row.clone())));
        } else {
            for (letter, change) in numbers(line) {
                *row.get_mut(&letter).unwrap() += change;
            }
            tics.push((command, row.clone()));
        }
    }
    Trace { start, tics }
}

fn read_action(action: &str) -> Command {
    let mut command = Command::default();
    for word in action.split('+').filter(|&word| word != "noop") {
        let (name, value) = word.split_once('=').unwrap_or((word, "1"));
        let value = || Command::quantise_delta(value.parse().unwrap());
        command.buttons |= match name {
            "MOVE_FORWARD" => Buttons::MOVE_FORWARD,
            "MOVE_BACKWARD" => Buttons::MOVE_BACKWARD,
            "MOVE_RIGHT" => Buttons::MOVE_RIGHT,
            "MOVE_LEFT" => Buttons::MOVE_LEFT,
            "ATTACK" => Buttons::ATTACK,
            "SPEED" => Buttons::SPEED,
            "JUMP" => Buttons::JUMP,
            "CROUCH" => Buttons::CROUCH,
            "TURN180" => Buttons::TURN180,
            "TURN_LEFT" => Buttons::TURN_LEFT,
            "TURN_RIGHT" => Buttons::TURN_RIGHT,
            "LOOK_UP" => Buttons::LOOK_UP,
            "LOOK_DOWN" => Buttons::LOOK_DOWN,
            "TURN_LEFT_RIGHT_DELTA" => {
                command.turn_delta = value();
                Buttons::default()
            }
            "LOOK_UP_DOWN_DELTA" => {
                command.look_delta = value();
                Buttons::default()
            }
            other => panic!("unknown action {other}"),
        };
    }
    command
}

/// What the world says, in the recording's units.
fn observe(world: &World) -> Row {
    let player = &world.players[0];
    let body = world.get(player.actor).unwrap();
    let degrees = |binary: i64| (binary as f64 * 360e6 / 4_294_967_296.0).round() as i64;
    let fixed = |value: Fixed| i64::from(value.0);
    Row::from([
        ('x', fixed(body.x)),
        ('y', fixed(body.y)),
        ('z', fixed(body.z)),
        ('u', fixed(body.vx)),
        ('v', fixed(body.vy)),
        ('w', fixed(body.vz)),
        ('h', fixed(player.view_z - body.z)),
        ('a', degrees(i64::from(body.angle.0))),
        ('p', degrees(i64::from(player.pitch))),
        ('g', i64::from(player.on_ground)),
    ])
}

fn tile_style(floor: i32, ceiling: i32, tag: i32) -> Style {
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

fn grid_map(name: &str, grid: &TileGrid, start: (f64, f64)) -> Arc<Map> {
    let mut builder = MapBuilder::new();
    grid.paint(&mut builder);
    builder.thing(1, start.0, start.1, 0);
    Arc::new(Map::build(&builder.finish().unwrap(), name, &[]).unwrap())
}

/// Armament Burden level 1: a room of 15 x 15 tiles with four crates.
fn armament_burden() -> World {
    let raised = |at: usize| matches!(at, 2 | 3 | 11 | 12);
    let grid = TileGrid::new((0, 256), 64, 15, 15, |column, row| {
        let crate_here = matches!(column, 4 | 5 | 11 | 12) && raised(row);
        tile_style(if crate_here { 16 } else { 0 }, 150, (row * 15 + column) as i32 + 1)
    });
    World::new(grid_map("armament burden", &grid, (32.0, 736.0)), 1)
}

/// Precipice Plunge level 1: a corridor of 58 x 7 tiles whose floors sink, tile
/// by tile.
fn precipice_plunge() -> World {
    let tag_of = |column: usize, row: usize| {
        if column < 2 { 0 } else { (128 + (column - 2) * 7 + row) as i32 }
    };
    let grid =
        TileGrid::new((0, 0), 64, 58, 7, |column, row| tile_style(0, 128, tag_of(column, row)));
    World::new(grid_map("precipice plunge", &grid, (32.0, 224.0)), 1)
}

/// The script of Precipice Plunge's first tic.
fn sink_floors(world: &mut World) {
    let mut depth = 0;
    for x in 1..=35 {
        for i in 0..7 {
            let row = if x % 2 == 1 { i } else { 6 - i };
            let tag = 128 + (x - 1) * 7 + row;
            depth = if x < 30 { depth + 24 } else { 4872 };
            world.floor_lower_by_value(tag, 1000, depth);
            if x > 7 {
                world.ceiling_lower_by_value(tag, 1000, (x - 1) * 168 - 1320);
            }
        }
    }
}

/// Replays a recording; the first tic and field that differ, if any.
fn replay(path: &Path) -> Result<usize, String> {
    let trace = read_trace(path);
    let name = path.file_stem().unwrap().to_str().unwrap();
    let sinks = name.starts_with("PrecipicePlunge");
    let mut world = if sinks { precipice_plunge() } else { armament_burden() };
    for tic in 0..TICS_BEFORE {
        world.run_thinkers(&[]);
        if sinks && tic == 0 {
            sink_floors(&mut world);
        }
        world.finish_tic();
    }
    let at = |letter: char| Fixed(trace.start[&letter] as i32);
    let binary =
        |letter: char| (trace.start[&letter] as f64 / 360e6 * 4_294_967_296.0).round() as i64;
    world.place_player(0, at('x'), at('y'), at('z'), Angle(binary('a') as u32), binary('p') as i32);
    for (tic, (command, expected)) in trace.tics.iter().enumerate() {
        world.run_thinkers(&[*command]);
        world.finish_tic();
        let seen = observe(&world);
        for (letter, &value) in expected {
            let mut difference = seen[letter] - value;
            let tolerance = match letter {
                'a' | 'p' => ANGLE_TOLERANCE,
                'g' => 0,
                _ => UNIT_TOLERANCE,
            };
            if *letter == 'a' {
                difference = (difference + 180_000_000).rem_euclid(360_000_000) - 180_000_000;
            }
            if difference.abs() > tolerance {
                return Err(format!(
                    "{name}: tic {}: {letter} is {}, recorded {value}",
                    tic + 1,
                    seen[letter]
                ));
            }
        }
    }
    Ok(trace.tics.len())
}

fn recordings() -> Vec<PathBuf> {
    let mut paths: Vec<_> =
        std::fs::read_dir("tests/traces").unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "trace"));
    paths.sort();
    paths
}

#[test]
fn motion_equals_the_recordings_on_every_tic() {
    let outcomes: Vec<_> = recordings().iter().map(|path| replay(path)).collect();
    let faults: Vec<_> = outcomes.iter().filter_map(|outcome| outcome.as_ref().err()).collect();
    assert!(
        faults.is_empty(),
        "{} of {} recordings differ:\n{faults:#?}",
        faults.len(),
        outcomes.len()
    );
    assert!(outcomes.len() > 80, "recordings are missing");
}
