//! A body alone in the map of an environment, without rules and what moves or can be taken:
//! `beside_published.py` drives it.
//!
//! Argument: a folder of maps, or none for the built-in ones; floors are then given in the order of
//! that map's sectors. Standard input: a line with the id; a line with the start (x, y, z, angle,
//! pitch: map units and degrees); a line with the number of floors, and for each a line with a
//! point of its sector (x, y), floor and ceiling; then a line of buttons for every tic. Standard
//! output: position, angle, pitch and velocity after each.

use hasard_engine::map::SectorId;
use hasard_engine::math::{Angle, Fixed};
use hasard_engine::world::{ActorFlags, World};
use hasard_envs::maps::Maps;
use hasard_envs::{Env, EnvOptions, RuleSet, parse_command};
use std::error::Error;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::sync::Arc;

const TURN: f64 = 4_294_967_296.0 / 360.0;

fn numbers(line: &str) -> Result<Vec<f64>, Box<dyn Error>> {
    Ok(line.split_whitespace().map(str::parse).collect::<Result<_, _>>()?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let text = std::io::read_to_string(std::io::stdin())?;
    let mut lines = text.lines();
    let mut line = || lines.next().ok_or("the input ends too early");
    let maps = std::env::args().nth(1).map(|folder| Arc::new(Maps::new(Path::new(&folder), None)));
    let in_order = maps.is_some();
    let env =
        Env::new(line()?, &EnvOptions { maps, rules: RuleSet::Released, ..EnvOptions::default() })?;
    let mut world = World::new(env.world().map.clone(), 1);
    // Past the spawn freeze.
    for _ in 0..20 {
        world.run_thinkers(&[]);
        world.finish_tic();
    }
    let fixed = |value: f64| Fixed((value * 65536.0).round() as i32);
    let start = numbers(line()?)?;
    for index in 0..line()?.parse()? {
        let floor = numbers(line()?)?;
        let sector = if in_order {
            SectorId(index)
        } else {
            world.map.sector_at(fixed(floor[0]), fixed(floor[1]))
        };
        let state = world.sector_mut(sector);
        (state.floor, state.ceiling) = (fixed(floor[2]), fixed(floor[3]));
        *world.sector_damage_mut(sector) = Default::default();
    }
    // What the original has left as well: the body, trees and lamps.
    let own = world.players[0].actor;
    let moves = |slot: &usize| {
        world.actors[*slot]
            .flags
            .any(ActorFlags::ITEM.with(ActorFlags::MONSTER).with(ActorFlags::SHOOTABLE))
    };
    let things: Vec<_> = (0..world.actors.len())
        .filter(moves)
        .map(|slot| world.id_of(slot))
        .filter(|&id| id != own)
        .collect();
    things.into_iter().for_each(|id| world.remove(id));
    let angle = |degrees: f64| (degrees * TURN).round() as i64;
    world.place_player(
        0,
        fixed(start[0]),
        fixed(start[1]),
        fixed(start[2]),
        Angle(angle(start[3]) as u32),
        angle(start[4]) as i32,
    );
    // Scripts put a body over the floor under its middle, be a higher one beside it.
    if let Some(body) = world.get_mut(own) {
        body.floor_z = body.floor_z.min(body.z);
    }
    let mut out = BufWriter::new(std::io::stdout().lock());
    for line in lines {
        world.run_thinkers(&[parse_command(line)?]);
        world.finish_tic();
        let player = &world.players[0];
        let body = &world.actors[usize::from(player.actor.slot)];
        let [x, y, z] = [body.x, body.y, body.z].map(Fixed::to_f64);
        let [vx, vy, vz] = [body.vx, body.vy, body.vz].map(Fixed::to_f64);
        writeln!(
            out,
            "{x},{y},{z},{},{},{vx},{vy},{vz}",
            f64::from(body.angle.0) / TURN,
            f64::from(player.pitch) / TURN
        )?;
    }
    Ok(())
}
