//! What happened during a tic, for scenario rules and statistics.

use crate::math::Fixed;
use crate::world::parts::actor::ActorId;
use crate::world::tables::kinds::ActorKind;
use crate::world::tables::kinds::DamageKind;

/// One happening; `World::events` lists them in order until the caller clears it.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum Event {
    /// A player took an item, which is gone from the world now.
    PickedUp {
        /// Index of the player.
        player: usize,
        /// What was taken.
        kind: ActorKind,
        /// The item's thing id.
        tid: i32,
        /// Where it lay.
        x: Fixed,
        /// Where it lay.
        y: Fixed,
    },
    /// An actor lost health.
    Hurt {
        /// Who.
        victim: ActorId,
        /// Health points lost.
        amount: i32,
        /// Who did it, if anybody.
        source: Option<ActorId>,
        /// By what.
        by: DamageKind,
    },
    /// An actor's health reached 0; raised at the killing blow, before any animation.
    Died {
        /// Who.
        victim: ActorId,
        /// What it was.
        kind: ActorKind,
        /// Its thing id.
        tid: i32,
        /// The actor that is to blame, if any.
        source: Option<ActorId>,
    },
    /// A player's feet came to the floor after a time in the air.
    Landed {
        /// Index of the player.
        player: usize,
        /// Vertical speed on touching, map units per tic, negative.
        speed: Fixed,
    },
    /// A player's weapon fired.
    Fired {
        /// Index of the player.
        player: usize,
    },
}
