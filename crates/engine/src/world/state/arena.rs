//! The arena: actors by slot, their generations, who runs when, and the grid by which things find
//! each other.

use crate::math::{Angle, Fixed};
use crate::world::parts::actor::{Actor, ActorId, NO_BLOCK, NONE};
use crate::world::state::world::World;
use crate::world::tables::heading::Heading;
use crate::world::tables::info::ActorFlags;
use crate::world::tables::kinds::ActorKind;
use crate::world::tables::states::Phase;

/// Actors with any of these flags are not in the thing grid: nothing ever meets them.
pub(crate) const NOT_LISTED: ActorFlags = ActorFlags::NO_INTERACTION.with(ActorFlags::MISSILE);

/// Most actors of a world; slots are 16 bits, the last value means none.
const SLOT_LIMIT: usize = NONE as usize;

/// Largest radius of an actor (32, the big tree): boxes are searched that much wider, because the
/// grid lists an actor only in the block of its centre.
const LARGEST_RADIUS: Fixed = Fixed::from_int(32);

impl World {
    /// Creates an actor at (x, y, z) without any test. It first runs at the end of the current tic,
    /// with everything else created in it. Its floor is that of the sector under its centre.
    ///
    /// With 65,535 actors alive the last slot is taken over, so that a runaway script cannot bring
    /// the world down.
    pub fn spawn(&mut self, kind: ActorKind, x: Fixed, y: Fixed, z: Fixed) -> ActorId {
        let info = kind.info();
        let slot = self.take_slot();
        let generation = self.actors[slot].generation;
        let sector = self.map.sector_at(x, y);
        let (floor, ceiling) = (self.floor_of(sector), self.sectors[sector.0 as usize].ceiling);
        self.actors[slot] = Actor {
            kind,
            generation,
            removed: false,
            x,
            y,
            z,
            vx: Fixed::ZERO,
            vy: Fixed::ZERO,
            vz: Fixed::ZERO,
            angle: Angle::EAST,
            radius: Fixed::from_int(info.radius),
            height: Fixed::from_int(info.height),
            floor_z: floor,
            ceiling_z: ceiling,
            dropoff_z: floor,
            sector,
            flags: info.flags,
            max_step: Fixed::from_int(24),
            max_dropoff: Fixed::from_int(24),
            mass: info.mass,
            speed: Fixed::from_int(info.speed),
            health: info.health,
            tid: 0,
            phase: Phase::Idle,
            step: 0,
            tics: -1,
            spawn_tic: self.tic,
            origin: None,
            goal: None,
            pursuing: false,
            arrived: false,
            heading: Heading::East,
            steps_left: 0,
            in_float: false,
            avoids_ledge: false,
            next_goal: 0,
            player: u8::MAX,
            block: NO_BLOCK,
            block_next: NONE,
            block_previous: NONE,
        };
        self.link(slot);
        self.forget_footing(slot);
        let id = ActorId { slot: slot as u16, generation };
        self.fresh.push(id);
        self.start_animation(slot);
        id
    }

    /// Removes an actor at once; its id means nothing any more. Unknown ids are ignored.
    pub fn remove(&mut self, id: ActorId) {
        if self.get(id).is_none() {
            return;
        }
        let slot = usize::from(id.slot);
        self.end_trail(slot);
        self.unlink(slot);
        self.actors[slot].removed = true;
        self.actors[slot].generation = id.generation.wrapping_add(1);
        self.awake[slot] = false;
        self.free_slots.push(id.slot);
    }

    /// The actor that `id` names, unless it was removed.
    #[must_use]
    pub fn get(&self, id: ActorId) -> Option<&Actor> {
        self.actors
            .get(usize::from(id.slot))
            .filter(|actor| !actor.removed && actor.generation == id.generation)
    }

    /// The actor that `id` names, to change it. Wakes it, so that whatever was changed takes
    /// effect. Change positions by [`World::set_position`], never directly: the grid would not
    /// know.
    pub fn get_mut(&mut self, id: ActorId) -> Option<&mut Actor> {
        self.get(id)?;
        self.wake_slot(usize::from(id.slot));
        Some(&mut self.actors[usize::from(id.slot)])
    }

    /// The id of the actor in a slot that is not free.
    #[must_use]
    pub fn id_of(&self, slot: usize) -> ActorId {
        ActorId { slot: slot as u16, generation: self.actors[slot].generation }
    }

    /// Every actor, in slot order.
    pub fn living(&self) -> impl Iterator<Item = (ActorId, &Actor)> + '_ {
        let ids = self.actors.iter().enumerate().filter(|(_, actor)| !actor.removed);
        ids.map(|(slot, actor)| {
            (ActorId { slot: slot as u16, generation: actor.generation }, actor)
        })
    }

    /// The actors with a thing id, in slot order.
    pub fn tagged_actors(&self, tid: i32) -> impl Iterator<Item = ActorId> + '_ {
        self.living().filter(move |(_, actor)| actor.tid == tid).map(|(id, _)| id)
    }

    /// Has an actor run from its next turn on, after its velocity, state or floor was changed.
    /// Actors at rest whose animation is timed are skipped.
    pub(crate) fn wake_slot(&mut self, slot: usize) {
        // Players run apart, what is fresh runs at the end of the tic.
        if self.actors[slot].player == u8::MAX && !self.awake[slot] && !self.is_fresh(slot) {
            self.awake[slot] = true;
        }
    }

    /// The first slot from `from` on whose actor runs every tic. Which ones do cannot be
    /// predicted: eight at a time, without a branch for each.
    #[inline]
    pub(crate) fn next_awake(&self, mut from: usize) -> Option<usize> {
        while let Some(eight) = self.awake[from..].first_chunk::<8>() {
            let word = u64::from_le_bytes(eight.map(u8::from));
            if word != 0 {
                return Some(from + word.trailing_zeros() as usize / 8);
            }
            from += 8;
        }
        self.awake[from..].iter().position(|&awake| awake).map(|more| from + more)
    }

    /// Whether a slot's actor was created in this tic and has not run yet.
    fn is_fresh(&self, slot: usize) -> bool {
        self.fresh[self.fresh_run..].iter().any(|id| usize::from(id.slot) == slot)
    }

    fn take_slot(&mut self) -> usize {
        if let Some(slot) = self.free_slots.pop() {
            return usize::from(slot);
        }
        if self.actors.len() == SLOT_LIMIT {
            self.remove(self.id_of(SLOT_LIMIT - 1));
            return self.free_slots.pop().map_or(SLOT_LIMIT - 1, usize::from);
        }
        self.actors.push(Actor::VACANT);
        self.awake.push(false);
        self.actors.len() - 1
    }

    /// Enters an actor into the block of its centre.
    pub(crate) fn link(&mut self, slot: usize) {
        let actor = &self.actors[slot];
        if actor.flags.any(NOT_LISTED) {
            return;
        }
        let block = self.block_of(actor.x, actor.y);
        let head = std::mem::replace(&mut self.grid[block as usize], slot as u16);
        if head != NONE {
            self.actors[usize::from(head)].block_previous = slot as u16;
        }
        let actor = &mut self.actors[slot];
        (actor.block, actor.block_next, actor.block_previous) = (block, head, NONE);
    }

    /// Takes an actor out of its block.
    pub(crate) fn unlink(&mut self, slot: usize) {
        let actor = &self.actors[slot];
        if actor.block == NO_BLOCK {
            return;
        }
        let (block, next, previous) = (actor.block, actor.block_next, actor.block_previous);
        if previous == NONE {
            self.grid[block as usize] = next;
        } else {
            self.actors[usize::from(previous)].block_next = next;
        }
        if next != NONE {
            self.actors[usize::from(next)].block_previous = previous;
        }
        self.actors[slot].block = NO_BLOCK;
        self.forget_footing(slot);
    }

    /// Moves an actor in the plane, keeping the grid and its sector true; heights are the caller's.
    pub(crate) fn relocate(
        &mut self,
        slot: usize,
        x: Fixed,
        y: Fixed,
        sector: crate::map::SectorId,
    ) {
        self.forget_footing(slot);
        let same_block = self.block_of(x, y) == self.actors[slot].block;
        if !same_block {
            self.unlink(slot);
        }
        let actor = &mut self.actors[slot];
        (actor.x, actor.y, actor.sector) = (x, y, sector);
        if !same_block {
            self.link(slot);
        }
    }

    /// The block of a point; those outside the map count to the blocks of its rim.
    fn block_of(&self, x: Fixed, y: Fixed) -> u32 {
        let (column, row) = self.clamped_block(x, y);
        (row * self.map.blockmap.columns + column) as u32
    }

    fn clamped_block(&self, x: Fixed, y: Fixed) -> (i32, i32) {
        let blocks = &self.map.blockmap;
        let column = blocks.column_of(x).clamp(0, blocks.columns - 1);
        (column, blocks.row_of(y).clamp(0, blocks.rows - 1))
    }

    /// The slots of actors whose footprint may overlap the square of half side `reach` around (x,
    /// y): block by block, in each the most recently entered first. The caller compares distances.
    pub(crate) fn near(&self, x: Fixed, y: Fixed, reach: Fixed) -> Near<'_> {
        let reach = reach + LARGEST_RADIUS;
        let (west, south) = self.clamped_block(x - reach, y - reach);
        let (east, north) = self.clamped_block(x + reach, y + reach);
        let mut near =
            Near { world: self, west, east, north, column: west, row: south, next: NONE };
        near.next = near.head();
        near
    }
}

impl Actor {
    /// A slot that was never used.
    const VACANT: Actor = Actor {
        kind: ActorKind::Player,
        generation: 0,
        removed: true,
        x: Fixed::ZERO,
        y: Fixed::ZERO,
        z: Fixed::ZERO,
        vx: Fixed::ZERO,
        vy: Fixed::ZERO,
        vz: Fixed::ZERO,
        angle: Angle::EAST,
        radius: Fixed::ZERO,
        height: Fixed::ZERO,
        floor_z: Fixed::ZERO,
        ceiling_z: Fixed::ZERO,
        dropoff_z: Fixed::ZERO,
        sector: crate::map::SectorId(0),
        flags: ActorFlags::NONE,
        max_step: Fixed::ZERO,
        max_dropoff: Fixed::ZERO,
        mass: 0,
        speed: Fixed::ZERO,
        health: 0,
        tid: 0,
        phase: Phase::Idle,
        step: 0,
        tics: -1,
        spawn_tic: 0,
        origin: None,
        goal: None,
        pursuing: false,
        arrived: false,
        heading: Heading::East,
        steps_left: 0,
        in_float: false,
        avoids_ledge: false,
        next_goal: 0,
        player: u8::MAX,
        block: NO_BLOCK,
        block_next: NONE,
        block_previous: NONE,
    };
}

/// Walks the blocks around a place; see [`World::near`].
pub(crate) struct Near<'a> {
    world: &'a World,
    west: i32,
    east: i32,
    north: i32,
    column: i32,
    row: i32,
    next: u16,
}

impl Near<'_> {
    fn head(&self) -> u16 {
        self.world.grid[(self.row * self.world.map.blockmap.columns + self.column) as usize]
    }
}

impl Iterator for Near<'_> {
    type Item = usize;

    fn next(&mut self) -> Option<usize> {
        while self.next == NONE {
            if self.column < self.east {
                self.column += 1;
            } else if self.row < self.north {
                (self.column, self.row) = (self.west, self.row + 1);
            } else {
                return None;
            }
            self.next = self.head();
        }
        let slot = usize::from(self.next);
        self.next = self.world.actors[slot].block_next;
        Some(slot)
    }
}
