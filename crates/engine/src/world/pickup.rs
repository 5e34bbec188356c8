//! What happens when a player's move touches an item.

use super::{ActorFlags, ActorId, Event, World};
use crate::math::Fixed;

/// Deepest that an item may lie below the feet that pick it up, unless it is taller itself.
const REACH_DOWN: Fixed = Fixed::from_int(32);

impl World {
    /// Called for every item that a player's attempted move touches: if it is within reach in height and the player
    /// can use it, it takes effect, is removed and [`Event::PickedUp`] is raised.
    pub(crate) fn touch_item(&mut self, player: usize, id: ActorId) {
        let Some(item) = self.get(id) else { return };
        let body = &self.actors[usize::from(self.players[player].actor.slot)];
        let rise = item.z - body.z;
        if rise > body.height || rise < -item.height.max(REACH_DOWN) || self.players[player].dead {
            return;
        }
        let (kind, tid, x, y) = (item.kind, item.tid, item.x, item.y);
        let dropped = item.flags.any(ActorFlags::DROPPED);
        if !self.give(player, kind, dropped) {
            return;
        }
        self.players[player].bonus_count = 6;
        self.remove(id);
        self.events.push(Event::PickedUp { player, kind, tid, x, y });
    }
}
