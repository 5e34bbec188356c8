//! The world itself: its state and its start.

use crate::map::Map;
use crate::math::{Fixed, Rng};
use crate::simd::prefetch;
use crate::world::parts::actor::{Actor, ActorId, NONE};
use crate::world::parts::crossing::Crossing;
use crate::world::parts::event::Event;
use crate::world::parts::lights::Lights;
use crate::world::parts::movers::Movers;
use crate::world::parts::player::Player;
use crate::world::parts::riders::{Footing, Riders};
use crate::world::parts::sector::{SectorDamage, SectorState};
use crate::world::parts::soot::Soot;
use crate::world::parts::trail::Trail;
use crate::world::tables::kinds::ActorKind;
use std::sync::Arc;

/// The whole state of one running map.
#[derive(Debug)]
pub struct World {
    /// The map, shared by every world that uses it.
    pub map: Arc<Map>,
    /// What changes of each sector, by [`SectorId`](crate::map::SectorId): floors and lights as
    /// they were when they were last looked at, see [`World::sector`].
    pub(in crate::world) sectors: Vec<SectorState>,
    /// What each sector's floor does to players who stand on it, by
    /// [`SectorId`](crate::map::SectorId).
    pub(in crate::world) sector_damages: Vec<SectorDamage>,
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
    pub(in crate::world) awake: Vec<bool>,
    /// Free slots, the last freed on top.
    pub(in crate::world) free_slots: Vec<u16>,
    /// Actors created in this tic, in order.
    pub(in crate::world) fresh: Vec<ActorId>,
    /// How many of `fresh` have run.
    pub(in crate::world) fresh_run: usize,
    /// First slot of each block.
    pub(in crate::world) grid: Vec<u16>,
    /// Moving floors and ceilings.
    pub(in crate::world) movers: Movers,
    /// Changing lights.
    pub(in crate::world) lights: Lights,
    /// The sectors under each slot's actor, where remembered. Follows from positions, so it is no
    /// state of its own.
    pub(in crate::world) footings: Vec<Footing>,
    /// Scratch: the actors on moving sectors.
    pub(in crate::world) riders: Riders,
    /// Space for searches along a path; empty between uses in meaning, not in capacity.
    pub(in crate::world) scratch_crossings: Vec<Crossing>,
    /// Space for the victims of a blast.
    pub(in crate::world) scratch_slots: Vec<u16>,
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
            grid: vec![NONE; blocks],
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
}
