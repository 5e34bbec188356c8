//! What a straight path crosses, and where.

/// Length of a path in units of [`Crossing::at`].
pub(in crate::world) const WHOLE_PATH: i64 = 1 << 30;

/// What a path crosses.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(in crate::world) enum Crossed {
    /// An actor's box, by slot.
    Actor(u16),
    /// A line, by index.
    Line(u32),
}

/// A crossing and how far along the path it is.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(in crate::world) struct Crossing {
    /// Part of the path before it, of [`WHOLE_PATH`].
    pub at: i64,
    /// What is crossed.
    pub what: Crossed,
}
