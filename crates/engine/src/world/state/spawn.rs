//! Putting actors into the world and at other places, with the scripts' test of room.

use crate::math::{Angle, Fixed};
use crate::world::parts::actor::{Actor, ActorId};
use crate::world::parts::player::Player;
use crate::world::state::world::World;
use crate::world::tables::info::ActorFlags;
use crate::world::tables::kinds::ActorKind;

impl World {
    /// Creates an actor at absolute (x, y, z) if there is room, as the scripts' `Spawn` does: its
    /// square must cut no wall and, if it is solid, no solid actor (over and under is fine); the
    /// opening over all touched sectors must be tall enough; and it must be between floor and
    /// ceiling of the sector under its centre alone. Inside rock, out of everybody's reach, there
    /// is room as well, with floor and ceiling of the nearest piece by the tree: in the original
    /// two to four of a hundred items lie there.
    pub fn spawn_checked(
        &mut self,
        kind: ActorKind,
        x: Fixed,
        y: Fixed,
        z: Fixed,
        tid: i32,
    ) -> Option<ActorId> {
        let id = self.spawn(kind, x, y, z);
        let slot = usize::from(id.slot);
        // Over and under is fine for whatever the scripts put down, as it is for monsters.
        let flags = self.actors[slot].flags;
        self.actors[slot].flags.set(ActorFlags::MONSTER, true);
        let has_room = self.has_room(slot);
        let actor = &mut self.actors[slot];
        (actor.flags, actor.tid) = (flags, tid);
        if has_room {
            return Some(id);
        }
        self.fresh.pop();
        self.remove(id);
        None
    }

    /// Moves an actor to absolute (x, y, z) if there is room by the same test, as the scripts'
    /// `SetActorPosition` does; false if not, and the actor stays. Items at the place are not
    /// picked up by this, and the height is kept: it falls from there.
    pub fn set_position(&mut self, id: ActorId, x: Fixed, y: Fixed, z: Fixed) -> bool {
        let Some(actor) = self.get(id) else { return false };
        let (old_x, old_y, old_z) = (actor.x, actor.y, actor.z);
        let slot = usize::from(id.slot);
        self.put(slot, x, y, z);
        let has_room = self.has_room(slot);
        if !has_room {
            self.put(slot, old_x, old_y, old_z);
        }
        has_room
    }

    /// Places an actor without a test; its floor is that of the sector under its centre.
    fn put(&mut self, slot: usize, x: Fixed, y: Fixed, z: Fixed) {
        let sector = self.map.sector_at(x, y);
        self.relocate(slot, x, y, sector);
        let state = self.sector(sector);
        let actor = &mut self.actors[slot];
        (actor.z, actor.floor_z, actor.dropoff_z, actor.ceiling_z) =
            (z, state.floor, state.floor, state.ceiling);
        self.wake_slot(slot);
    }

    fn has_room(&self, slot: usize) -> bool {
        let Actor { x, y, z, floor_z, ceiling_z, .. } = self.actors[slot];
        self.check_position(slot, x, y).free && z >= floor_z && self.actors[slot].top() <= ceiling_z
    }

    /// Adds a player at (x, y) on the floor, and gives its index.
    pub fn add_player(&mut self, x: Fixed, y: Fixed, angle: Angle) -> usize {
        let index = self.players.len();
        let id = self.spawn(ActorKind::Player, x, y, Fixed::ZERO);
        // Bodies of players run apart from the other actors.
        self.fresh.pop();
        let slot = usize::from(id.slot);
        let position = self.check_position(slot, x, y);
        let body = &mut self.actors[slot];
        body.player = index as u8;
        body.angle = angle;
        body.max_step = Fixed::from_int(24);
        (body.floor_z, body.ceiling_z, body.dropoff_z) =
            (position.floor_z, position.ceiling_z, position.dropoff_z);
        body.z = position.floor_z;
        self.players.push(Player::new(id, position.floor_z));
        index
    }

    /// Puts a player at rest at (x, y, z), facing `angle` with `pitch` (a signed binary angle, down
    /// positive), its eye at rest: for comparisons with recordings that start there.
    pub fn place_player(
        &mut self,
        index: usize,
        x: Fixed,
        y: Fixed,
        z: Fixed,
        angle: Angle,
        pitch: i32,
    ) {
        let id = self.players[index].actor;
        let slot = usize::from(id.slot);
        self.put(slot, x, y, z);
        let position = self.check_position(slot, x, y);
        let body = &mut self.actors[slot];
        (body.floor_z, body.ceiling_z, body.dropoff_z) =
            (position.floor_z, position.ceiling_z, position.dropoff_z);
        (body.vx, body.vy, body.vz) = (Fixed::ZERO, Fixed::ZERO, Fixed::ZERO);
        body.angle = angle;
        self.players[index].come_to_rest(pitch, z);
    }

    /// Thrusts an actor: `force` map units per tic towards a 256th of a turn, each component held
    /// to 30.
    pub fn thrust_thing(&mut self, id: ActorId, byte_angle: i32, force: i32) {
        let direction = Angle::from_turn_65536(byte_angle << 8);
        let limit = Fixed::from_int(30);
        if let Some(actor) = self.get_mut(id) {
            let force = Fixed::from_int(force);
            actor.vx = (actor.vx + force * direction.cos()).clamp(-limit, limit);
            actor.vy = (actor.vy + force * direction.sin()).clamp(-limit, limit);
        }
    }
}
