//! The directions in which monsters step.

use crate::math::{Angle, Fixed};

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
pub(in crate::world) const DIAGONAL: i32 = 46341;
