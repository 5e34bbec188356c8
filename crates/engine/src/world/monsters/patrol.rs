//! Where monsters walk: goals, directions and what makes them turn.

use crate::math::{Angle, Fixed};
use crate::world::state::actor::{ActorId, ActorKind};
use crate::world::state::world::World;
use crate::world::tables::info::ActorFlags;

/// One of the eight directions in which monsters step, or none.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
#[repr(u8)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Heading {
    #[default]
    East,
    NorthEast,
    North,
    NorthWest,
    West,
    SouthWest,
    South,
    SouthEast,
    None,
}

impl Heading {
    /// The eight directions, counter-clockwise from east.
    pub const ALL: [Heading; 8] = [
        Heading::East,
        Heading::NorthEast,
        Heading::North,
        Heading::NorthWest,
        Heading::West,
        Heading::SouthWest,
        Heading::South,
        Heading::SouthEast,
    ];

    /// The way back.
    #[must_use]
    pub const fn opposite(self) -> Heading {
        match self {
            Heading::None => Heading::None,
            _ => Heading::ALL[(self as usize + 4) % 8],
        }
    }

    /// The angle, if it is a direction.
    #[must_use]
    pub const fn angle(self) -> Option<Angle> {
        match self {
            Heading::None => None,
            _ => Some(Angle((self as u32) << 29)),
        }
    }

    /// A step of length 1.
    #[must_use]
    pub const fn unit(self) -> (Fixed, Fixed) {
        let (zero, one, diagonal) = (Fixed::ZERO, Fixed::ONE, Fixed(DIAGONAL));
        let (minus_one, minus_diagonal) = (Fixed(-(1 << 16)), Fixed(-DIAGONAL));
        match self {
            Heading::East => (one, zero),
            Heading::NorthEast => (diagonal, diagonal),
            Heading::North => (zero, one),
            Heading::NorthWest => (minus_diagonal, diagonal),
            Heading::West => (minus_one, zero),
            Heading::SouthWest => (minus_diagonal, minus_diagonal),
            Heading::South => (zero, minus_one),
            Heading::SouthEast => (diagonal, minus_diagonal),
            Heading::None => (zero, zero),
        }
    }
}

/// Each component of a diagonal step: the square root of a half, in 65536ths.
const DIAGONAL: i32 = 46341;

impl World {
    /// The first patrol point with a thing id.
    #[must_use]
    pub fn patrol_point(&self, tid: i32) -> Option<ActorId> {
        self.living()
            .find(|(_, actor)| tid != 0 && actor.kind == ActorKind::PatrolPoint && actor.tid == tid)
            .map(|(id, _)| id)
    }

    /// Sends every living monster with thing id `tid` to the patrol point with thing id `goal_tid`;
    /// to none where there is no such point: it will stand. Scripts' `Thing_SetGoal`.
    pub fn set_goal(&mut self, tid: i32, goal_tid: i32) {
        let goal = self.patrol_point(goal_tid);
        for actor in self.actors.iter_mut().filter(|actor| !actor.removed && actor.tid == tid) {
            if actor.flags.any(ActorFlags::MONSTER) && actor.flags.any(ActorFlags::SHOOTABLE) {
                (actor.goal, actor.pursuing) = (goal, false);
            }
        }
    }

    /// The same for one monster.
    pub fn set_goal_of(&mut self, monster: ActorId, goal: Option<ActorId>) {
        if let Some(actor) = self.get_mut(monster) {
            (actor.goal, actor.pursuing) = (goal, false);
        }
    }
}
