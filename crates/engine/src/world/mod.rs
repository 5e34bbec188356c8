//! A world: everything that changes during an episode, as plain data. `Clone` is a snapshot.
//!
//! One tic is [`World::run_thinkers`] (players, then actors, then sector movers), the caller's
//! script phase, then [`World::finish_tic`] (what was created during the tic is run once, and time
//! advances): the order of work of the original engine, with the scripts in the caller's hands.

// Physics and pixels are whole numbers: a floating-point operation here is a mistake.
#![cfg_attr(not(test), deny(clippy::float_arithmetic))]

mod actor;
mod actor_info;
mod arena;
mod by_sector;
mod collision;
mod command;
mod damage;
mod event;
mod explosion;
mod face;
mod floor_waggle;
mod hash;
mod hitscan;
mod inventory;
mod left_out;
mod light;
mod map_lights;
mod missile;
mod monster;
mod movement;
mod mover;
mod patrol;
#[cfg(test)]
mod patrol_tests;
mod pickup;
mod player;
mod riders;
mod sector;
mod sight;
mod slide;
mod soot;
mod spawn;
mod states;
mod think;
mod trail;
mod view;
mod waggle;
mod weapon;
mod weapon_info;

pub use actor::{Actor, ActorId, ActorKind};
pub use actor_info::{ActorFlags, ActorInfo};
pub use collision::{Move, Position, approximate_distance};
pub use command::{Buttons, Command};
pub use event::{DamageKind, Event};
pub use explosion::BLAST;
pub use face::{Face, FaceState};
pub use hash::Fingerprint;
pub use inventory::{BLUE_SKULL, YELLOW_CARD};
pub use patrol::Heading;
pub use player::{Player, PlayerSprite, SPAWN_FREEZE_TICS, Weapon};
pub use sector::{Busy, SectorDamage, SectorState};
pub use soot::Soot;
pub use states::{Action, Animation, Frame, OPAQUE, Phase, Picture, Then, animation, is_timed};
pub use think::PITCH_DOWN;
pub use trail::{Chance, Lots, SQUARES, Shade, Shed, Square, Trail};
pub use weapon::{Hands, WeaponState};
pub use weapon_info::ammo;

use crate::map::Map;
use crate::math::{Fixed, Rng};
use crate::simd::prefetch;
use light::Lights;
use mover::Movers;
use riders::{Footing, Riders};
use std::sync::Arc;

/// The whole state of one running map.
#[derive(Debug)]
pub struct World {
    /// The map, shared by every world that uses it.
    pub map: Arc<Map>,
    /// What changes of each sector, by [`SectorId`](crate::map::SectorId): floors and lights as
    /// they were when they were last looked at, see [`World::sector`].
    sectors: Vec<SectorState>,
    /// What each sector's floor does to players who stand on it, by
    /// [`SectorId`](crate::map::SectorId).
    sector_damages: Vec<SectorDamage>,
    /// Actor slots; removed actors leave a free slot ([`Actor::removed`]). Change actors by
    /// [`World::get_mut`].
    pub actors: Vec<Actor>,
    /// The players; each owns one actor.
    pub players: Vec<Player>,
    /// The world's only randomness.
    pub rng: Rng,
    /// Completed tics; while a tic runs, its number.
    pub tic: u32,
    /// What happened since the caller last cleared it, in order. Clear it between the scripts and
    /// [`World::finish_tic`]: what is new can act there already (a rocket that bursts in its first tic), and that is for
    /// the scripts of the next tic.
    pub events: Vec<Event>,
    /// Soot on walls, the oldest first.
    pub soot: Vec<Soot>,
    /// Trails of rockets of which squares may be left, the oldest first.
    pub trails: Vec<Trail>,
    /// Rockets shed squares as they fly (Collateral Damage with its published maps and pictures,
    /// whose settings draw them).
    pub rockets_shed: bool,
    /// Monsters and weapons do not search for targets vertically or sideways (Collateral Damage).
    pub no_autoaim: bool,
    /// Killed soldiers drop their weapon or clip.
    pub monsters_drop_items: bool,
    /// Whether each slot's actor runs every tic; false for those at rest, players' bodies, fresh
    /// actors and free slots.
    awake: Vec<bool>,
    /// Free slots, the last freed on top.
    free_slots: Vec<u16>,
    /// Actors created in this tic, in order.
    fresh: Vec<ActorId>,
    /// How many of `fresh` have run.
    fresh_run: usize,
    /// First slot of each block.
    grid: Vec<u16>,
    /// Moving floors and ceilings.
    movers: Movers,
    /// Changing lights.
    lights: Lights,
    /// The sectors under each slot's actor, where remembered. Follows from positions, so it is no
    /// state of its own.
    footings: Vec<Footing>,
    /// Scratch: the actors on moving sectors.
    riders: Riders,
    /// Space for searches along a path; empty between uses in meaning, not in capacity.
    scratch_crossings: Vec<sight::Crossing>,
    /// Space for the victims of a blast.
    scratch_slots: Vec<u16>,
}

impl World {
    /// A world at tic 0 of a map: sectors as the map says, one player at each player start (editor
    /// numbers 1 to 4), and every thing whose editor number the engine knows.
    #[must_use]
    pub fn new(map: Arc<Map>, seed: u64) -> World {
        let sectors = map.sectors.iter().map(SectorState::new).collect();
        let blocks = (map.blockmap.columns * map.blockmap.rows) as usize;
        let mut world = World {
            map: Arc::clone(&map),
            sectors,
            sector_damages: map.sectors.iter().map(SectorDamage::new).collect(),
            actors: Vec::new(),
            players: Vec::new(),
            rng: Rng::new(seed),
            tic: 0,
            events: Vec::new(),
            soot: Vec::new(),
            trails: Vec::new(),
            rockets_shed: false,
            no_autoaim: false,
            monsters_drop_items: false,
            awake: Vec::new(),
            free_slots: Vec::new(),
            fresh: Vec::new(),
            fresh_run: 0,
            grid: vec![actor::NONE; blocks],
            movers: Movers::default(),
            lights: Lights::default(),
            footings: Vec::new(),
            riders: Riders::default(),
            scratch_crossings: Vec::new(),
            scratch_slots: Vec::new(),
        };
        world.start_lights_of_map();
        for number in 1..=4 {
            for thing in map.things.iter().filter(|thing| thing.kind == number) {
                world.add_player(thing.x, thing.y, thing.angle);
            }
        }
        for thing in map.things.iter().filter(|thing| thing.kind > 4) {
            let Some(kind) = ActorKind::from_editor_number(thing.kind) else { continue };
            let id = world.spawn(kind, thing.x, thing.y, Fixed::ZERO);
            let actor = &mut world.actors[usize::from(id.slot)];
            (actor.z, actor.angle) = (actor.floor_z + thing.height, thing.angle);
            (actor.tid, actor.next_goal) = (thing.id, thing.args[0]);
        }
        world
    }

    /// Asks the processor for what tics and frames read of the world. Of a batch that is stepped in
    /// turn no nearest cache holds all worlds, and what a tic reads, it reads here and there: asked
    /// for at once, it arrives while the first tic runs.
    pub fn prefetch(&self) {
        prefetch(&self.actors[..]);
        prefetch(&self.awake[..]);
        prefetch(&self.sectors[..]);
        prefetch(&self.footings[..]);
        prefetch(&self.grid[..]);
        self.movers.prefetch();
        self.lights.prefetch();
    }

    /// The first part of a tic: players think and move, then power-ups, lights, all other actors in
    /// slot order, and moving floors and ceilings. Player `i` obeys `commands[i]`, nothing if that
    /// is missing.
    pub fn run_thinkers(&mut self, commands: &[Command]) {
        for index in 0..self.players.len() {
            let command = commands.get(index).copied().unwrap_or_default();
            self.think_player(index, &command);
        }
        for index in 0..self.players.len() {
            self.run_player_body(index);
        }
        for index in 0..self.players.len() {
            self.tick_powers(index);
        }
        self.run_lights();
        let mut from = 0;
        while let Some(slot) = self.next_awake(from) {
            self.run_actor(slot);
            from = slot + 1;
        }
        self.run_movers();
    }

    /// The last part of a tic, after the caller's scripts: what was created during the tic is run
    /// once, until nothing new comes; then time advances.
    pub fn finish_tic(&mut self) {
        while self.fresh_run < self.fresh.len() || self.movers.wait() || self.lights.wait() {
            self.run_new_lights();
            while self.fresh_run < self.fresh.len() {
                let id = self.fresh[self.fresh_run];
                self.fresh_run += 1;
                if self.get(id).is_some() {
                    self.run_actor(usize::from(id.slot));
                }
            }
            self.run_new_movers();
        }
        self.fresh.clear();
        self.fresh_run = 0;
        self.tic += 1;
    }

    /// One tic of an actor that is no player's body: move, then animation; then it sleeps if
    /// nothing moves it.
    fn run_actor(&mut self, slot: usize) {
        let id = self.id_of(slot);
        if !self.actors[slot].at_rest() {
            self.move_actor(slot);
        }
        if self.get(id).is_none() {
            return;
        }
        let Actor { kind, phase, .. } = self.actors[slot];
        let timed = is_timed(kind, phase);
        if !timed {
            self.tick_animation(slot);
        }
        if self.get(id).is_some() {
            self.awake[slot] = !timed || !self.actors[slot].at_rest();
        }
    }

    /// One tic of a player's body.
    fn run_player_body(&mut self, index: usize) {
        let player = &self.players[index];
        let slot = usize::from(player.actor.slot);
        let full_height = ActorKind::Player.height();
        if !player.dead {
            self.actors[slot].height = full_height * player.crouch;
        }
        self.move_actor(slot);
        self.tick_animation(slot);
    }
}
