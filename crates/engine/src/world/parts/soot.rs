//! A mark of soot on a wall.

use crate::map::SideId;
use crate::math::Fixed;

/// A mark on one side of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Soot {
    /// The side.
    pub side: SideId,
    /// Its middle lies on the line, or before its start or beyond its end for what has gone on
    /// around a corner.
    pub x: Fixed,
    /// North; as `x`.
    pub y: Fixed,
    /// Height of its middle.
    pub z: Fixed,
    /// Shown the other way round.
    pub mirrored: bool,
    /// Shown upside down.
    pub upturned: bool,
}
