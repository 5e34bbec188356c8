//! The beginning of an episode: the level is set, things are put down, the agent enters. And how
//! things are put down later.

use super::model::{Facing, Goal, Height, Place, Spawn};
use super::placing::{body, drawn_place, move_player};
use super::program::Program;
use super::rules::OwnRules;
use super::walkers::Walker;
use crate::scenarios::common::stage;
use hasard_engine::math::{Angle, Fixed};
use hasard_engine::world::{ActorId, ActorKind, World};
use std::sync::atomic::Ordering;

/// Tries to find a free place for a thing.
const TRIES: u32 = 200;
/// Most slots of things in a world: what more would come is left out.
const MOST_THINGS: usize = 4_000;

/// The thing id of what stood in the map before the rules opened: nobody asks for it by the name of
/// a spawn, and no spawn brings it back.
const OF_THE_MAP: i32 = i32::MAX;

impl OwnRules {
    /// The map opens, and the agent enters.
    pub(super) fn open(&mut self, program: &Program, world: &mut World) {
        disown(program, world);
        if let Some(layout) = &program.layout {
            layout.apply(world, program.test_seeds);
        }
        for tile in &program.loose {
            let height = Fixed::from_int(world.rng.between(tile.floor[0], tile.floor[1]));
            // What a layout has closed from floor to ceiling stays closed.
            let state = world.sector_mut(tile.sector);
            if program.layout.is_none() || state.floor < state.ceiling {
                state.floor = height;
            }
        }
        if program.layout.is_some() || !program.loose.is_empty() {
            stand_up(world);
        }
        for (tag, amplitude, frequency) in &program.waggles {
            world.floor_waggle(*tag, *amplitude, *frequency, 0, 0);
        }
        for index in 0..program.plan.spawns.len() {
            // Where one finds no room, the next would find none either.
            let _ = (0..program.plan.spawns[index].count)
                .try_for_each(|_| self.put(program, index as u8, world).map(drop));
        }
        for light in &program.plan.lights {
            for tag in &program.tags[usize::from(light.zone)] {
                if light.glow {
                    world.light_glow(*tag, light.bright, light.dark, light.bright_tics);
                } else {
                    world.light_strobe(
                        *tag,
                        light.bright,
                        light.dark,
                        light.bright_tics,
                        light.dark_tics,
                    );
                }
            }
        }
        if !enter(program, &mut self.tries, world)
            && let Some(unplaced) = &self.unplaced
        {
            unplaced.agent.store(true, Ordering::Relaxed);
        }
    }

    /// Puts down a thing of a spawn; none where there is no room.
    pub(super) fn put(
        &mut self,
        program: &Program,
        index: u8,
        world: &mut World,
    ) -> Option<ActorId> {
        let spawn = &program.plan.spawns[usize::from(index)];
        let full = world.actors.len() >= MOST_THINGS && world.living().count() >= MOST_THINGS;
        // With fewer slots than that there is nothing to count.
        let most =
            world.actors.len() >= spawn.most as usize && living(spawn, index, world) >= spawn.most;
        if full || most || spawn.kinds.is_empty() {
            return None;
        }
        let kind = drawn_kind(spawn, world);
        let tid = if spawn.marked { i32::from(index) + 1 } else { 0 };
        for _ in 0..TRIES.min(self.tries) {
            self.tries -= 1;
            let Some([x, y, z]) =
                drawn_place(program, spawn.place, spawn.height, spawn.rock, world)
            else {
                continue;
            };
            let Some(id) = world.spawn_checked(kind, x, y, z, tid) else { continue };
            if let Some(actor) = world.get_mut(id) {
                actor.health = spawn.health.unwrap_or(actor.health);
                actor.speed = spawn.speed.map_or(actor.speed, Fixed::from_int);
            }
            if spawn.goal != Goal::None {
                self.walkers.push(Walker::new(id, index));
            }
            return Some(id);
        }
        if let Some(unplaced) = &self.unplaced {
            unplaced.spawns.fetch_or(1 << index, Ordering::Relaxed);
        }
        None
    }
}

/// What stands in the map already is no spawn's, whatever ids it was drawn with.
fn disown(program: &Program, world: &mut World) {
    let taken = |kind: ActorKind, tid: i32| {
        (1..=64).contains(&tid)
            || tid == 0 && program.comes_back.iter().any(|(own, _)| *own == kind)
    };
    let all: Vec<_> = world
        .living()
        .filter(|(_, actor)| taken(actor.kind, actor.tid))
        .map(|(id, _)| id)
        .collect();
    for id in all {
        world.get_mut(id).into_iter().for_each(|actor| actor.tid = OF_THE_MAP);
    }
}

/// Everything stands on its floor again: floors have been set anew beneath it.
fn stand_up(world: &mut World) {
    let all: Vec<_> = world.living().map(|(id, actor)| (id, actor.x, actor.y)).collect();
    for (id, x, y) in all {
        let floor = world.sector(world.map.sector_at(x, y)).floor;
        world.set_position(id, x, y, floor);
    }
}

/// How many things of a spawn there are: those of its kinds, where none says how many may be.
fn living(spawn: &Spawn, index: u8, world: &World) -> u32 {
    let of = |kind: ActorKind, tid: i32| {
        let own = !spawn.marked || tid == i32::from(index) + 1;
        own && spawn.kinds.iter().any(|(own, _)| *own == kind)
    };
    world.living().filter(|(_, actor)| of(actor.kind, actor.tid) && actor.health > 0).count() as u32
}

fn drawn_kind(spawn: &Spawn, world: &mut World) -> ActorKind {
    if let [(kind, _)] = spawn.kinds[..] {
        return kind;
    }
    let total: u32 = spawn.kinds.iter().map(|(_, weight)| weight).sum();
    let mut drawn = world.rng.below(total.max(1));
    for (kind, weight) in &spawn.kinds {
        if drawn < *weight {
            return *kind;
        }
        drawn -= weight;
    }
    spawn.kinds[0].0
}

/// The agent enters: whether there was room where it is to appear.
fn enter(program: &Program, tries: &mut u32, world: &mut World) -> bool {
    let plan = &program.plan.player;
    let placed = match plan.place {
        Some(place) => move_player(program, place, plan.height, tries, world),
        None if program.layout.is_some() => {
            move_player(program, Place::Free, Height::Above(0), tries, world)
        }
        None if program.starts.len() > 1 => {
            let (area, degrees) =
                program.starts[world.rng.below(program.starts.len() as u32) as usize];
            let [x, y] = [(area[0] + area[2]) / 2, (area[1] + area[3]) / 2].map(Fixed::from_int);
            let z = world.sector(world.map.sector_at(x, y)).floor;
            world.set_position(body(world), x, y, z);
            stage::set_angle(world, turned(degrees));
            true
        }
        None => true,
    };
    match plan.facing {
        Facing::Random => {
            let angle = stage::random_angle(world);
            stage::set_angle(world, angle);
        }
        Facing::Degrees(degrees) => stage::set_angle(world, turned(degrees)),
        Facing::Map => {}
    }
    world.clear_inventory(0);
    stage::set_health(world, plan.health);
    let player = &mut world.players[0];
    player.armor = plan.armor;
    player.speed = Fixed::from_f64(plan.speed);
    for weapon in &plan.weapons {
        world.give_weapon(0, *weapon, false);
    }
    for (which, amount) in plan.ammo.iter().enumerate() {
        if let Some(amount) = amount {
            let player = &mut world.players[0];
            player.ammo[which] = *amount;
            player.max_ammo[which] = player.max_ammo[which].max(*amount);
        }
    }
    placed
}

/// An angle in degrees.
fn turned(degrees: i32) -> Angle {
    Angle::from_turn_65536(degrees.rem_euclid(360) * 65536 / 360)
}
