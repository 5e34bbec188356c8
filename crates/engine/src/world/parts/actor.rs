//! Actors: every thing that stands, lies, flies or walks in a world.

use crate::map::SectorId;
use crate::math::{Angle, Fixed};
use crate::world::tables::heading::Heading;
use crate::world::tables::info::ActorFlags;
use crate::world::tables::kinds::ActorKind;
use crate::world::tables::states::Phase;

/// Names an actor: its slot and the slot's generation, so that the name of a removed actor never
/// means another.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct ActorId {
    /// Index into `World::actors`.
    pub slot: u16,
    /// Number of actors that used the slot before.
    pub generation: u16,
}

/// No slot, no player: ends the lists of the thing grid and marks actors that are no player's body.
pub(crate) const NONE: u16 = u16::MAX;

/// Not in the thing grid.
pub(crate) const NO_BLOCK: u32 = u32::MAX;

/// One thing. Positions are of the centre of its square footprint, at its feet.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Actor {
    /// What it is.
    pub kind: ActorKind,
    /// The generation of its slot.
    pub generation: u16,
    /// The slot is free.
    pub removed: bool,
    /// East, map units.
    pub x: Fixed,
    /// North, map units.
    pub y: Fixed,
    /// Height of the feet, map units.
    pub z: Fixed,
    /// Velocity east, map units per tic.
    pub vx: Fixed,
    /// Velocity north, map units per tic.
    pub vy: Fixed,
    /// Velocity up, map units per tic.
    pub vz: Fixed,
    /// Facing.
    pub angle: Angle,
    /// Half the side of the footprint, map units.
    pub radius: Fixed,
    /// Height, map units.
    pub height: Fixed,
    /// Highest floor under the footprint.
    pub floor_z: Fixed,
    /// Lowest ceiling over the footprint.
    pub ceiling_z: Fixed,
    /// Lowest floor under the footprint.
    pub dropoff_z: Fixed,
    /// Sector under the centre.
    pub sector: SectorId,
    /// Properties; those of its kind at first, then changed by death and scripts.
    /// [`ActorFlags::MISSILE`] and [`ActorFlags::NO_INTERACTION`] stay as they are for life: they
    /// decide whether the thing grid lists it.
    pub flags: ActorFlags,
    /// Highest step that it climbs, map units.
    pub max_step: Fixed,
    /// Deepest drop that it walks over, map units; without meaning with [`ActorFlags::DROP_OFF`].
    pub max_dropoff: Fixed,
    /// Mass; thrust is divided by it.
    pub mass: i32,
    /// Map units per step (monsters) or per tic (missiles).
    pub speed: Fixed,
    /// Health points.
    pub health: i32,
    /// Thing id for scripts, 0 for none.
    pub tid: i32,
    /// Which of its animations it is in.
    pub phase: Phase,
    /// Frame of that animation.
    pub step: u8,
    /// Tics left of that frame, -1 for ever.
    pub tics: i16,
    /// The world's tic when it appeared.
    pub spawn_tic: u32,
    /// The actor that fired it (missiles) or killed it (barrels): to blame for what it does, and
    /// never hit by it.
    pub origin: Option<ActorId>,
    /// The patrol point that a monster walks to.
    pub goal: Option<ActorId>,
    /// The monster has set out for its goal.
    pub pursuing: bool,
    /// The monster reached its goal in the last step: the next one only chooses a direction.
    pub arrived: bool,
    /// Direction of a monster's steps.
    pub heading: Heading,
    /// Steps left before a monster chooses a new direction.
    pub steps_left: i32,
    /// A floating monster changed height in its last step because something blocked it.
    pub in_float: bool,
    /// The monster backs off from a ledge: the usual test of drops is replaced (see
    /// `World::try_move`).
    pub avoids_ledge: bool,
    /// Thing id of the patrol point that follows this one, 0 for none.
    pub next_goal: i32,
    /// Index of the player whose body this is; 255 for none.
    pub player: u8,
    /// Its block of the thing grid, `NO_BLOCK` outside it.
    pub(crate) block: u32,
    /// The next slot in its block.
    pub(crate) block_next: u16,
    /// The previous slot in its block.
    pub(crate) block_previous: u16,
}

impl Actor {
    /// Height of the top, map units.
    #[must_use]
    pub fn top(&self) -> Fixed {
        self.z + self.height
    }

    /// Index of the player whose body this is.
    #[must_use]
    pub fn player_index(&self) -> Option<usize> {
        (self.player != u8::MAX).then_some(usize::from(self.player))
    }

    /// Whether the footprint would overlap that of `other` if this actor stood at (`x`, `y`).
    #[must_use]
    pub fn would_overlap(&self, other: &Actor, x: Fixed, y: Fixed) -> bool {
        let reach = self.radius + other.radius;
        (other.x - x).abs() < reach && (other.y - y).abs() < reach
    }
}
