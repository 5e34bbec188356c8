//! What a seg ends and where, as types: each combination is a pass of its own, without branches.

/// From where the columns are clipped.
pub(crate) trait Side {
    /// Whether from below.
    const FLOOR: bool;
}

/// From above.
pub(crate) struct Ceiling;

/// From below.
pub(crate) struct Floor;

impl Side for Ceiling {
    const FLOOR: bool = false;
}

impl Side for Floor {
    const FLOOR: bool = true;
}

/// What is seen there.
pub(crate) trait Parts {
    /// Whether a visplane takes rows.
    const PLANE: bool;
    /// Whether a wall does.
    const WALL: bool;
}

/// A visplane.
pub(crate) struct PlaneOnly;

/// A visplane, then a wall.
pub(crate) struct PlaneAndWall;

/// A wall.
pub(crate) struct WallOnly;

impl Parts for PlaneOnly {
    const PLANE: bool = true;
    const WALL: bool = false;
}

impl Parts for PlaneAndWall {
    const PLANE: bool = true;
    const WALL: bool = true;
}

impl Parts for WallOnly {
    const PLANE: bool = false;
    const WALL: bool = true;
}
