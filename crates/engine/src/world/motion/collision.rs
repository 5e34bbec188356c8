//! Where an actor may be: the test of a position against things and lines, and the move that relies
//! on it.
//!
//! Players, monsters, missiles and items share these rules; their flags, step height and drop-off
//! height make the difference.

use crate::map::SectorId;
use crate::math::Fixed;
use crate::world::parts::actor::Actor;
use crate::world::parts::lines::for_each_line_across;
use crate::world::parts::lines::stops;
use crate::world::state::world::World;
use crate::world::tables::info::ActorFlags;

/// Most items that one test of a position remembers; the recorded scenarios never have this many
/// overlapping.
const TOUCH_LIMIT: usize = 16;

/// Actors with any of these flags may stand on and pass over and under others.
pub(crate) const PASSES: ActorFlags = ActorFlags::PLAYER.with(ActorFlags::MONSTER);

/// What a position is like for an actor.
#[derive(Clone, Copy, Debug)]
pub struct Position {
    /// Nothing solid is in the way, and the lowest ceiling is high enough above the highest floor.
    /// Heights that depend on the actor's own height above ground are tested by the move.
    pub free: bool,
    /// Highest floor under the footprint.
    pub floor_z: Fixed,
    /// Lowest ceiling over it.
    pub ceiling_z: Fixed,
    /// Lowest floor under it.
    pub dropoff_z: Fixed,
    /// Sector under its centre.
    pub sector: SectorId,
    /// The actor in the way: one that blocks, or one low enough to be stepped on.
    pub blocking_actor: Option<usize>,
    /// The line in the way, or the last that narrows the opening.
    pub blocking_line: Option<u32>,
    /// The line whose opening gives the lowest ceiling.
    pub ceiling_line: Option<u32>,
    /// The items that the footprint touches.
    touched: [u16; TOUCH_LIMIT],
    touched_count: usize,
}

/// How a move ended.
#[derive(Clone, Copy, Debug)]
pub struct Move {
    /// The actor is at the new place.
    pub moved: bool,
    /// It would have fitted at another height: floaters then climb or sink.
    pub fits_higher: bool,
    /// What the place is like.
    pub position: Position,
}

/// The height gap between two sectors where a line parts them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Opening {
    /// The lower ceiling.
    pub top: Fixed,
    /// The higher floor.
    pub bottom: Fixed,
    /// The lower floor.
    pub low_floor: Fixed,
}

impl World {
    /// The opening of a two-sided line.
    pub(crate) fn opening(&self, front: SectorId, back: SectorId) -> Opening {
        let ceilings = [front, back].map(|sector| self.sectors[sector.0 as usize].ceiling);
        let floors = [front, back].map(|sector| self.floor_of(sector));
        Opening {
            top: ceilings[0].min(ceilings[1]),
            bottom: floors[0].max(floors[1]),
            low_floor: floors[0].min(floors[1]),
        }
    }

    /// What (x, y) is like for the actor in `slot`, at its present height. Changes nothing.
    #[must_use]
    pub fn check_position(&self, slot: usize, x: Fixed, y: Fixed) -> Position {
        self.check_walk(slot, x, y, false)
    }

    /// The same; a monster that is `walking` may leave a solid actor that it overlaps, one that is
    /// put there or thrown may not. Players always may.
    fn check_walk(&self, slot: usize, x: Fixed, y: Fixed, walking: bool) -> Position {
        let actor = &self.actors[slot];
        let sector = self.map.sector_at(x, y);
        let floor = self.floor_of(sector);
        let mut position = Position {
            free: true,
            floor_z: floor,
            ceiling_z: self.sectors[sector.0 as usize].ceiling,
            dropoff_z: floor,
            sector,
            blocking_actor: None,
            blocking_line: None,
            ceiling_line: None,
            touched: [0; TOUCH_LIMIT],
            touched_count: 0,
        };
        let stepped_on = self.check_actors(slot, x, y, walking, &mut position);
        if position.free {
            self.check_lines(actor, x, y, &mut position);
            if position.free && position.ceiling_z - position.floor_z < actor.height {
                position.free = false;
            }
            if position.free && stepped_on.is_some() {
                position.free = false;
                position.blocking_actor = stepped_on;
            }
        }
        position
    }

    /// Tests the things around. Clears `free` where something blocks for certain; gives the highest
    /// thing low enough to be stepped on.
    fn check_actors(
        &self,
        slot: usize,
        x: Fixed,
        y: Fixed,
        walking: bool,
        position: &mut Position,
    ) -> Option<usize> {
        let actor = &self.actors[slot];
        let is_player = actor.player_index().is_some();
        let may_part = is_player || (walking && actor.flags.any(ActorFlags::MONSTER));
        // Players test a taller body, so that they notice what they could step up on.
        let top = actor.top() + if is_player { actor.max_step } else { Fixed::ZERO };
        let mut step: Option<usize> = None;
        for other_slot in self.near(x, y, actor.radius) {
            let other = &self.actors[other_slot];
            if other_slot == slot
                || !other
                    .flags
                    .any(ActorFlags::SOLID.with(ActorFlags::ITEM).with(ActorFlags::SHOOTABLE))
                || !actor.would_overlap(other, x, y)
            {
                continue;
            }
            if !self.actor_blocks(actor, other, x, y, top, may_part, position, other_slot) {
                continue;
            }
            let steps_on = !actor.flags.any(ActorFlags::FLOAT.with(ActorFlags::MISSILE))
                && other.player_index().is_none()
                && other.top() - actor.z <= actor.max_step;
            if steps_on {
                if step.is_none_or(|step| other.z > self.actors[step].z) {
                    step = Some(other_slot);
                }
            } else if is_player && top - other.z <= actor.max_step && step.is_none() {
                // Over the head, within the pretended height: no obstacle unless there is something
                // to step on.
            } else {
                position.free = false;
                position.blocking_actor = Some(other_slot);
                return None;
            }
        }
        step
    }

    /// Whether `other` is in the way of `actor` at (x, y). Notes items on the way.
    #[allow(clippy::too_many_arguments, reason = "one step of check_actors, apart only for length")]
    fn actor_blocks(
        &self,
        actor: &Actor,
        other: &Actor,
        x: Fixed,
        y: Fixed,
        top: Fixed,
        may_part: bool,
        position: &mut Position,
        other_slot: usize,
    ) -> bool {
        let is_player = actor.player_index().is_some();
        if actor.flags.any(ActorFlags::MISSILE) {
            return self.stops_missile(actor, other, other_slot);
        }
        // Solids that overlap already may move apart.
        let mut parting = false;
        if other.flags.any(ActorFlags::SOLID) && may_part {
            if (x, y) == (actor.x, actor.y) {
                parting = true;
            } else if actor.would_overlap(other, actor.x, actor.y) {
                let distance = |x: Fixed, y: Fixed| approximate_distance(other.x - x, other.y - y);
                parting = distance(x, y) > distance(actor.x, actor.y)
                    && top > other.z
                    && actor.z < other.top();
            }
        }
        if actor.flags.any(PASSES) && (actor.z >= other.top() || top <= other.z) {
            return false;
        }
        if other.flags.any(ActorFlags::ITEM) {
            let reachable = other.z < top - actor.max_step;
            if is_player && reachable && position.touched_count < TOUCH_LIMIT {
                position.touched[position.touched_count] = other_slot as u16;
                position.touched_count += 1;
            }
            return false;
        }
        other.flags.any(ActorFlags::SOLID) && actor.flags.any(ActorFlags::SOLID) && !parting
    }

    /// Whether a missile meets `other`: overlapping in height too, not its thrower, and solid or
    /// shootable.
    fn stops_missile(&self, missile: &Actor, other: &Actor, other_slot: usize) -> bool {
        missile.z <= other.top()
            && missile.top() >= other.z
            && missile.origin != Some(self.id_of(other_slot))
            && other.flags.any(ActorFlags::SOLID.with(ActorFlags::SHOOTABLE))
    }

    /// Narrows the opening by every line that cuts the footprint, and notes one that blocks.
    fn check_lines(&self, actor: &Actor, x: Fixed, y: Fixed, position: &mut Position) {
        for_each_line_across(&self.map, x, y, actor.radius, |index, line| {
            let Some(back) = line.back_sector else {
                position.free = false;
                position.blocking_line = Some(index);
                return;
            };
            if stops(line.flags, actor) {
                position.free = false;
                position.blocking_line = Some(index);
                return;
            }
            let opening = self.opening(line.front_sector, back);
            if opening.top < position.ceiling_z {
                position.ceiling_z = opening.top;
                position.ceiling_line = Some(index);
                position.blocking_line = Some(index);
            }
            if opening.bottom > position.floor_z {
                position.floor_z = opening.bottom;
                position.blocking_line = Some(index);
            }
            position.dropoff_z = position.dropoff_z.min(opening.low_floor);
        });
    }

    /// Moves an actor to (x, y) if it may be there: players climb steps and walk over low things,
    /// `dropoff` lets it leave the ground. Items on the way are picked up even where the move
    /// fails. Height changes later, in the vertical move.
    pub fn try_move(&mut self, slot: usize, x: Fixed, y: Fixed, dropoff: bool) -> Move {
        // Monsters walk with `dropoff` unset; what moves by its velocity has it set.
        let position = self.check_walk(slot, x, y, !dropoff);
        self.touch_items(slot, &position);
        let (moved, fits_higher) = self.may_enter(slot, dropoff, &position);
        if moved {
            self.relocate(slot, x, y, position.sector);
            let actor = &mut self.actors[slot];
            (actor.floor_z, actor.ceiling_z) = (position.floor_z, position.ceiling_z);
            actor.dropoff_z = position.dropoff_z;
        }
        Move { moved, fits_higher, position }
    }

    /// Whether the move may happen, and whether the opening at least is tall enough.
    fn may_enter(&self, slot: usize, dropoff: bool, position: &Position) -> (bool, bool) {
        let actor = &self.actors[slot];
        if !position.free {
            let Some(other) = position.blocking_actor.map(|other| &self.actors[other]) else {
                return (false, false);
            };
            let ceiling = self.sectors[other.sector.0 as usize].ceiling.min(position.ceiling_z);
            let may_step_on = actor.player_index().is_some()
                && other.player_index().is_none()
                && other.top() - actor.z <= actor.max_step
                && ceiling - other.top() >= actor.height
                && actor.flags.any(PASSES);
            if !may_step_on {
                return (false, false);
            }
        }
        if position.ceiling_z - position.floor_z < actor.height {
            return (false, false);
        }
        if position.ceiling_z < actor.top() {
            return (false, true);
        }
        if actor.flags.any(ActorFlags::MISSILE) {
            return (position.floor_z <= actor.z, true);
        }
        if position.floor_z - actor.z > actor.max_step {
            return (false, true);
        }
        // The room for a step up is looked for where the actor stands, not where it goes.
        if actor.z < position.floor_z && self.actor_at(slot, position.floor_z).is_some() {
            return (false, true);
        }
        if !dropoff && !actor.flags.any(ActorFlags::DROP_OFF.with(ActorFlags::FLOAT)) {
            let on_actor = actor.flags.any(ActorFlags::ON_ACTOR);
            let floor = if on_actor { actor.z.max(position.floor_z) } else { position.floor_z };
            let too_deep = if actor.avoids_ledge {
                // Backing off from a ledge: anything goes that is not another ledge.
                actor.floor_z - position.floor_z > actor.max_dropoff
                    || actor.dropoff_z - position.dropoff_z > actor.max_dropoff
            } else {
                floor - position.dropoff_z > actor.max_dropoff
            };
            if too_deep {
                return (false, true);
            }
        }
        (true, true)
    }

    /// The highest solid actor that the actor in `slot` would overlap if its feet were at height
    /// `z` over its present place.
    pub(crate) fn actor_at(&self, slot: usize, z: Fixed) -> Option<usize> {
        let actor = &self.actors[slot];
        if actor.flags.any(ActorFlags::ITEM) {
            return None;
        }
        let mut found: Option<usize> = None;
        for other_slot in self.near(actor.x, actor.y, actor.radius) {
            let other = &self.actors[other_slot];
            if other_slot == slot
                || !actor.would_overlap(other, actor.x, actor.y)
                || !other.flags.any(ActorFlags::SOLID)
                || other.flags.any(ActorFlags::ITEM)
                || (actor.flags.any(ActorFlags::MISSILE)
                    && actor.origin == Some(self.id_of(other_slot)))
                || z > other.top()
                || z + actor.height <= other.z
                || found.is_some_and(|found| other.top() < self.actors[found].top())
            {
                continue;
            }
            found = Some(other_slot);
        }
        found
    }

    /// Hands the items that a position touches to the player whose body moves.
    pub(crate) fn touch_items(&mut self, slot: usize, position: &Position) {
        let Some(player) = self.actors[slot].player_index() else { return };
        for &item in &position.touched[..position.touched_count] {
            if !self.actors[usize::from(item)].removed {
                let id = self.id_of(usize::from(item));
                self.touch_item(player, id);
            }
        }
    }
}

/// The distance that the original estimates without a root: the larger component plus half the
/// smaller.
#[must_use]
pub fn approximate_distance(dx: Fixed, dy: Fixed) -> Fixed {
    let (dx, dy) = (dx.abs(), dy.abs());
    dx + dy - (dx.min(dy) >> 1)
}
