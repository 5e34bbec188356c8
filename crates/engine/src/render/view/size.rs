//! The size of a frame.

use std::fmt;

/// Size of a frame in pixels. 128x72 is special: the learner's nearest-neighbour reduction of
/// 160x120.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct FrameSize {
    /// Columns, 64..=1920.
    pub width: u16,
    /// Rows, 48..=1080.
    pub height: u16,
}

impl FrameSize {
    /// What learners see: every 1.25th column and 5/3rd row of 160x120.
    pub const LEARNER: FrameSize = FrameSize { width: 128, height: 72 };
    /// The original's training resolution.
    pub const CLASSIC: FrameSize = FrameSize { width: 160, height: 120 };

    /// Number of pixels.
    #[must_use]
    pub const fn pixels(self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Whether frames of this size can be drawn.
    ///
    /// # Errors
    /// A width outside 64..=1920 or a height outside 48..=1080.
    pub const fn check(self) -> Result<(), SizeError> {
        let fits =
            self.width >= 64 && self.width <= 1920 && self.height >= 48 && self.height <= 1080;
        if fits { Ok(()) } else { Err(SizeError { size: self }) }
    }
}

impl fmt::Display for FrameSize {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}", self.width, self.height)
    }
}

/// A frame size that cannot be drawn.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct SizeError {
    /// What was asked for.
    pub size: FrameSize,
}

impl fmt::Display for SizeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "frame size {} is outside 64x48 to 1920x1080: choose one within, such as 160x120",
            self.size
        )
    }
}

impl std::error::Error for SizeError {}
