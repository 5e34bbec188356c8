//! Floors and ceilings that move, and what that does to the things on them.

use crate::map::SectorId;
use crate::math::Fixed;
use crate::world::parts::movers::Mover;
use crate::world::parts::movers::PlaneMover;

use crate::world::parts::actor::Actor;

use crate::world::parts::sector::Busy;

use crate::world::state::world::World;
use crate::world::tables::info::ActorFlags;

use std::sync::Arc;

/// Actors ride down with floors slower than this (map units per tic); faster ones leave them
/// falling behind.
const RIDE_LIMIT: Fixed = Fixed::from_int(9);

/// Eighths of a map unit per tic, as scripts give speeds.
fn script_speed(eighths: i32) -> Fixed {
    Fixed(eighths.wrapping_mul(1 << 13))
}

impl World {
    /// Lowers the floors of the sectors with a tag by `amount` map units at `speed` eighths of a
    /// map unit per tic. A negative amount raises them at once. Busy floors are left alone.
    pub fn floor_lower_by_value(&mut self, tag: i32, speed: i32, amount: i32) {
        self.start_planes(tag, false, |floor| (true, floor - Fixed::from_int(amount)), speed);
    }

    /// Lowers ceilings likewise; a negative amount raises them at once.
    pub fn ceiling_lower_by_value(&mut self, tag: i32, speed: i32, amount: i32) {
        self.start_planes(tag, true, |ceiling| (true, ceiling - Fixed::from_int(amount)), speed);
    }

    /// Moves the floors of the sectors with a tag to a height, up or down as needed.
    pub fn floor_move_to_value(&mut self, tag: i32, speed: i32, height: i32) {
        let target = Fixed::from_int(height);
        self.start_planes(tag, false, |floor| (target <= floor, target), speed);
    }

    /// Ends whatever the floors of the sectors with a tag still do: they stay at the height that
    /// they have.
    pub fn stop_floors(&mut self, tag: i32) {
        let map = Arc::clone(&self.map);
        let mut planes = false;
        for sector in map.tagged(tag) {
            if self.sector_mut(sector).busy.end(Busy::FLOOR) {
                planes |= !self.movers.stop_swing(sector);
            }
        }
        // In one pass over the planes: there may be as many as there are floors to stop.
        if planes {
            let sectors = &self.sectors;
            let stopped = |SectorId(sector)| {
                !sectors[sector as usize].busy.any(Busy::FLOOR)
                    && map.sectors[sector as usize].tag == tag
            };
            self.movers.stop_planes(stopped);
        }
    }

    fn start_planes(
        &mut self,
        tag: i32,
        ceiling: bool,
        aim: impl Fn(Fixed) -> (bool, Fixed),
        speed: i32,
    ) {
        let map = Arc::clone(&self.map);
        for sector in map.tagged(tag) {
            let state = &mut self.sectors[sector.0 as usize];
            if state.busy.begin(Busy::of_plane(ceiling)) {
                continue;
            }
            let (down, target) = aim(if ceiling { state.ceiling } else { state.floor });
            let speed = script_speed(speed);
            self.movers.add(Mover::Plane(PlaneMover { sector, ceiling, down, speed, target }));
        }
    }

    /// A tic of all movers; those that are done are dropped. Of the swinging floors only those that
    /// somebody touches are run, unless one comes to rest: the others follow when they are looked
    /// at.
    pub(crate) fn run_movers(&mut self) {
        if self.movers.list.is_empty() {
            self.movers.run = 0;
            return;
        }
        self.list_riders();
        self.movers.tics += 1;
        if self.movers.tics >= self.movers.next_end
            || 2 * self.movers.ended > self.movers.list.len()
        {
            self.movers.next_end = u32::MAX;
            self.run_every_mover(0);
        } else {
            self.run_planes_and_ridden_floors();
        }
    }

    /// A tic of the movers that have not run in this one.
    pub(crate) fn run_new_movers(&mut self) {
        if self.movers.wait() {
            self.list_riders();
            self.run_every_mover(self.movers.run);
        }
    }

    /// Runs the movers from number `first` on in their order, and drops those that are done.
    fn run_every_mover(&mut self, first: usize) {
        self.movers.renew_swings();
        let first_plane = self.movers.planes.partition_point(|&index| (index as usize) < first);
        self.movers.planes.truncate(first_plane);
        let mut kept = first;
        for index in first..self.movers.list.len() {
            self.movers.waiting_from = index + 1;
            let mover = self.movers.list[index];
            let goes_on = match mover {
                Mover::Plane(plane) => self.run_plane(&plane),
                Mover::Waggle(_) => self.run_waggle(index),
                Mover::Ended => false,
            };
            match mover {
                _ if goes_on => {
                    self.movers.list[kept] = self.movers.list[index];
                    self.movers.note(kept);
                    kept += 1;
                }
                Mover::Plane(_) => {}
                Mover::Waggle(waggle) => self.movers.swings.clear(waggle.sector),
                Mover::Ended => self.movers.ended -= 1,
            }
        }
        self.movers.list.truncate(kept);
        self.movers.run = kept;
        self.movers.waiting_from = usize::MAX;
    }

    /// Runs the planes and the swinging floors that somebody touches, in the order of the movers.
    fn run_planes_and_ridden_floors(&mut self) {
        let ended = self.movers.ended;
        let (mut planes, mut swings) = (0, 0);
        loop {
            let plane = self.movers.planes.get(planes).map(|&index| index as usize);
            let Some(index) = plane.into_iter().chain(self.riders.ridden(swings)).min() else {
                break;
            };
            self.movers.waiting_from = index + 1;
            if let Mover::Plane(plane) = self.movers.list[index] {
                planes += 1;
                if !self.run_plane(&plane) {
                    self.movers.end(index);
                }
            } else {
                swings += 1;
                self.run_waggle(index);
            }
        }
        if self.movers.ended > ended {
            self.movers.forget_ended_planes();
        }
        self.movers.run = self.movers.list.len();
        self.movers.waiting_from = usize::MAX;
    }

    /// One tic of a plane; false when it has arrived.
    fn run_plane(&mut self, mover: &PlaneMover) -> bool {
        let state = &self.sectors[mover.sector.0 as usize];
        let height = if mover.ceiling { state.ceiling } else { state.floor };
        let next = if mover.down { height - mover.speed } else { height + mover.speed };
        let arrives = if mover.down { next <= mover.target } else { next >= mover.target };
        let next = if arrives { mover.target } else { next };
        self.shift_plane(mover.sector, mover.ceiling, next);
        if arrives {
            let state = &mut self.sectors[mover.sector.0 as usize];
            state.busy.end(Busy::of_plane(mover.ceiling));
        }
        !arrives
    }

    /// Sets a floor or ceiling and carries, drops or pushes the actors that touch the sector. If
    /// something does not fit any more, the plane goes back; false then.
    pub(crate) fn shift_plane(&mut self, sector: SectorId, ceiling: bool, height: Fixed) -> bool {
        let old = self.set_plane(sector, ceiling, height);
        if old == height || self.adjust_actors(sector, ceiling, height - old) {
            return true;
        }
        self.set_plane(sector, ceiling, old);
        self.adjust_actors(sector, ceiling, old - height);
        false
    }

    fn set_plane(&mut self, sector: SectorId, ceiling: bool, height: Fixed) -> Fixed {
        let state = &mut self.sectors[sector.0 as usize];
        std::mem::replace(if ceiling { &mut state.ceiling } else { &mut state.floor }, height)
    }

    /// Re-evaluates every actor that touches a sector whose floor or ceiling moved by `change`;
    /// false if one does not fit.
    fn adjust_actors(&mut self, sector: SectorId, ceiling: bool, change: Fixed) -> bool {
        let mut fits = true;
        let mut next = self.riders.first(sector);
        while let Some(entry) = next {
            let slot;
            (slot, next) = self.riders.entry(entry);
            // An item may have been picked up by the player before it.
            if !self.actors[slot].removed {
                fits &= self.adjust_actor(slot, ceiling, change);
            }
        }
        fits
    }

    /// Gives one actor its new floor and ceiling, and moves it with the floor; false if it does not
    /// fit.
    fn adjust_actor(&mut self, slot: usize, ceiling: bool, change: Fixed) -> bool {
        let Actor { x, y, .. } = self.actors[slot];
        let is_player = self.actors[slot].player_index().is_some();
        let (floor_z, ceiling_z, dropoff_z) = match self.planes_under(slot) {
            Some(planes) if !is_player => planes,
            _ => {
                let position = self.check_position(slot, x, y);
                self.touch_items(slot, &position);
                (position.floor_z, position.ceiling_z, position.dropoff_z)
            }
        };
        let old_z = self.actors[slot].z;
        let actor = &mut self.actors[slot];
        let old_floor = std::mem::replace(&mut actor.floor_z, floor_z);
        (actor.ceiling_z, actor.dropoff_z) = (ceiling_z, dropoff_z);
        if !ceiling && old_floor != actor.floor_z {
            if change < Fixed::ZERO {
                let falls = actor.vz == Fixed::ZERO && !actor.flags.any(ActorFlags::NO_GRAVITY);
                let rides = actor.vz == Fixed::ZERO
                    && actor.flags.any(ActorFlags::NO_GRAVITY)
                    && actor.z == old_floor;
                if rides || (falls && -change < RIDE_LIMIT && actor.z - actor.floor_z <= -change) {
                    actor.z = actor.floor_z;
                }
            } else if actor.z < actor.floor_z {
                actor.z = actor.floor_z;
            }
        } else if ceiling && actor.top() > actor.ceiling_z {
            actor.z = (actor.ceiling_z - actor.height).max(actor.floor_z);
        }
        let fits = actor.ceiling_z - actor.floor_z >= actor.height
            || !actor.flags.any(ActorFlags::SHOOTABLE);
        if (actor.z, actor.floor_z) != (old_z, old_floor) {
            self.wake_slot(slot);
        }
        fits
    }
}
