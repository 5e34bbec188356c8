//! What happens when a player's move touches an item.

use crate::world::parts::actor::ActorId;
use crate::world::parts::event::Event;
use crate::world::state::world::World;
use crate::world::tables::info::ActorFlags;

impl World {
    /// Called for every item that a player's body touches where it tries to go, or where it stands
    /// when a floor moves under it; standing still on a still floor takes nothing. Overlapping in
    /// height is part of touching: feet at or above an item's top pass over it, and so a jump
    /// clears items.
    ///
    /// If the player can use the item, it takes effect, is removed and [`Event::PickedUp`] is
    /// raised.
    pub(crate) fn touch_item(&mut self, player: usize, id: ActorId) {
        let Some(item) = self.get(id) else { return };
        if self.players[player].dead {
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
