//! What a frame is asked for.

/// Which buffers are drawn beside the colours.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Buffers {
    /// Depth, 0 near to 255 far.
    pub depth: bool,
    /// What each pixel shows, and the list of actors in view.
    pub labels: bool,
}
