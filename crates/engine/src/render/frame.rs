//! The buffers that are drawn into.

use super::column::{ROW_BLOCK, ROW_GROUP};
use super::depth::Depths;
use super::turn;
use crate::simd::Simd;

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
    /// What is drawn by columns.
    pub columns: Columns,
}

/// Colour and depth column by column, while walls are drawn.
#[derive(Clone, Debug, Default)]
pub(super) struct Columns {
    /// From one column to the next.
    stride: usize,
    colour: Vec<u8>,
    depth: Vec<u8>,
}

/// From one column to the next: whole blocks of rows.
pub(super) fn column_stride(rows: usize) -> usize {
    rows.next_multiple_of(ROW_BLOCK)
}

impl Columns {
    /// Room for `width` columns of `rows` rows.
    pub fn new(width: usize, rows: usize) -> Columns {
        let stride = column_stride(rows);
        Columns { stride, colour: vec![0; width * stride + ROW_GROUP], depth: vec![0; width * stride] }
    }

    /// The palette indices of a column, and a group of the next one's.
    #[inline]
    pub fn colour_of(&mut self, x: usize) -> &mut [u8] {
        &mut self.colour[x * self.stride..(x + 1) * self.stride + ROW_GROUP]
    }

    /// The depth of a column.
    #[inline]
    pub fn depth_of(&mut self, x: usize) -> &mut [u8] {
        &mut self.depth[x * self.stride..(x + 1) * self.stride]
    }
}

impl Frame {
    /// Empties the first `rows` rows: walls come next, by columns.
    pub fn clear<const DEPTH: bool, const CLASS: bool>(&mut self, rows: usize) {
        self.columns.colour.fill(0);
        if DEPTH {
            self.columns.depth.fill(self.depths.farthest());
        }
        if CLASS {
            self.class[..rows * self.width].fill(class::WALL);
        }
    }

    /// All walls are drawn: whatever comes next is drawn by rows.
    pub fn end_walls<const DEPTH: bool>(&mut self, simd: Simd, rows: usize) {
        let Columns { stride, colour, depth } = &self.columns;
        turn::to_rows(simd, colour, *stride, &mut self.colour, self.width, rows);
        if DEPTH {
            turn::to_rows(simd, depth, *stride, &mut self.depth, self.width, rows);
        }
    }
}
