//! Stand-ins for what the files of weapons, items, damage, missiles and monsters bring; each goes when its file comes.

use super::collision::Move;
use super::{ActorId, ActorKind, DamageKind, Event, World};

impl World {
    /// Gives a player what an item of `kind` holds; false if it is refused and stays.
    pub(crate) fn give(&mut self, _player: usize, _kind: ActorKind, _dropped: bool) -> bool {
        true
    }

    /// One tic of a player's power-ups, in the power-up turn between bodies and lights.
    pub(crate) fn tick_powers(&mut self, _player: usize) {}

    /// One tic of a player's weapon: selection, raising and lowering, firing. Reads `players[player].buttons`.
    pub(crate) fn tick_weapon(&mut self, _player: usize) {}

    /// Puts a new actor into its first animation; the end of [`World::spawn`].
    pub(crate) fn start_animation(&mut self, _slot: usize) {}

    /// One tic of an actor's animation, with what it does on entering frames; called every tic after the actor's move,
    /// unless its animation is timed (see [`is_timed`](super::is_timed)). May remove it.
    pub(crate) fn tick_animation(&mut self, _slot: usize) {}

    /// A missile's plane move was refused by `attempt.position.blocking_actor` or a line (`ceiling_line` against sky).
    pub(crate) fn missile_blocked(&mut self, slot: usize, _attempt: &Move) {
        self.remove(self.id_of(slot));
    }

    /// A missile met the floor (or else the ceiling).
    pub(crate) fn missile_hit_plane(&mut self, slot: usize, _floor: bool) {
        self.remove(self.id_of(slot));
    }

    /// Takes `amount` health points off `victim`. `inflictor` is what touched it (a rocket), `source` who is to blame.
    pub fn damage(&mut self, victim: ActorId, _inflictor: Option<ActorId>, source: Option<ActorId>, amount: i32, by: DamageKind) {
        let Some(actor) = self.get_mut(victim) else { return };
        if actor.health <= 0 {
            return;
        }
        actor.health = (actor.health - amount).max(0);
        let (kind, tid, dead, player) = (actor.kind, actor.tid, actor.health == 0, actor.player_index());
        self.events.push(Event::Hurt { victim, amount, source, by });
        if dead {
            if let Some(player) = player {
                self.players[player].dead = true;
            }
            self.events.push(Event::Died { victim, kind, tid, source });
        }
    }
}
