//! The buffers that are drawn into.

use super::depth::Depths;

/// What a pixel of the class buffer shows where it is no actor.
pub mod class {
    /// A wall, a fence, or nothing at all.
    pub const WALL: u16 = 0;
    /// A floor with a picture of 64 by 64 texels.
    pub const FLOOR: u16 = 1;
    /// A ceiling with one.
    pub const CEILING: u16 = 2;
    /// The sky.
    pub const SKY: u16 = 3;
    /// The status bar.
    pub const STATUS_BAR: u16 = 4;
    /// The player's own weapon.
    pub const WEAPON: u16 = 5;
    /// A floor whose picture is no square of 64 texels: published labels take it for a wall.
    pub const OTHER_FLOOR: u16 = 6;
    /// A ceiling whose picture is none.
    pub const OTHER_CEILING: u16 = 7;
    /// The first actor in the list of labels; the next ones count up.
    pub const FIRST_ACTOR: u16 = 16;
}

/// Colour, and depth and classes where they are asked for; row by row.
#[derive(Clone, Debug, Default)]
pub(super) struct Frame {
    /// Pixels a row.
    pub width: usize,
    /// Palette indices.
    pub colour: Vec<u8>,
    /// Depth, 0 near to 255 far.
    pub depth: Vec<u8>,
    /// Classes and actors.
    pub class: Vec<u16>,
    /// How depth is told.
    pub depths: Depths,
}

impl Frame {
    /// Empties the first `rows` rows.
    pub fn clear<const DEPTH: bool, const CLASS: bool>(&mut self, rows: usize, colour: u8) {
        let pixels = rows * self.width;
        self.colour[..pixels].fill(colour);
        if DEPTH {
            self.depth[..pixels].fill(self.depths.farthest());
        }
        if CLASS {
            self.class[..pixels].fill(class::WALL);
        }
    }
}
