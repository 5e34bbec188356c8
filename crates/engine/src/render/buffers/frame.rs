//! The buffers that are drawn into.

use crate::render::blocks::ROW_BLOCK;
use crate::render::blocks::column_stride;
use crate::render::buffers::transpose;
use crate::render::buffers::visplane::Span;
use crate::render::buffers::written::{ClassBuffer, DepthBuffer};
use crate::render::view::depth::DepthEncoding;
use crate::render::view::tables::View;
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
pub(crate) struct Frame {
    /// Pixels a row.
    pub width: usize,
    /// Palette indices.
    pub colour: Vec<u8>,
    /// Depth, 0 near to 255 far.
    pub depth: Vec<u8>,
    /// Classes and actors.
    pub class: Vec<u16>,
    /// How depth is written.
    pub depths: DepthEncoding,
}

impl Frame {
    /// Makes it one of a view; the status bar's rows keep their depth and class.
    pub fn fit(&mut self, view: &View, depths: DepthEncoding) {
        let (width, pixels) = (view.width(), view.size().pixels());
        if (self.width, self.colour.len()) != (width, pixels) {
            let (depth, class) = (vec![0; pixels], vec![class::STATUS_BAR; pixels]);
            *self = Frame { width, colour: vec![0; pixels], depth, class, depths };
        }
        self.depths = depths;
    }
}

/// Colour and depth column by column, while walls are drawn.
#[derive(Clone, Debug, Default)]
pub(crate) struct Columns {
    /// From one column to the next.
    stride: usize,
    colour: Vec<u8>,
    depth: Vec<u8>,
}

impl Columns {
    /// Has room for `width` columns of `rows` rows.
    pub fn fit(&mut self, width: usize, rows: usize) {
        self.stride = column_stride(rows);
        self.colour.resize(width * self.stride, 0);
        self.depth.resize(width * self.stride, 0);
    }

    /// Empties them.
    pub fn clear<D: DepthBuffer>(&mut self, depths: DepthEncoding) {
        self.colour.fill(0);
        if D::WRITTEN {
            self.depth.fill(depths.farthest());
        }
    }

    /// The palette indices of a column.
    #[inline]
    pub fn colour_of(&mut self, x: usize) -> &mut [u8] {
        &mut self.colour[x * self.stride..(x + 1) * self.stride]
    }

    /// Whether each column is one block of rows.
    pub fn are_blocks(&self) -> bool {
        self.stride == ROW_BLOCK
    }

    /// The palette indices of all columns, where each is one block of rows.
    #[inline]
    pub fn colour_blocks(&mut self) -> &mut [[u8; ROW_BLOCK]] {
        self.colour.as_chunks_mut().0
    }

    /// The depth of all columns, where each is one block of rows.
    #[inline]
    pub fn depth_blocks(&mut self) -> &mut [[u8; ROW_BLOCK]] {
        self.depth.as_chunks_mut().0
    }

    /// The depth of a column.
    #[inline]
    pub fn depth_of(&mut self, x: usize) -> &mut [u8] {
        &mut self.depth[x * self.stride..(x + 1) * self.stride]
    }

    /// Writes the depth of a pixel, if the column has that row.
    pub fn put_depth(&mut self, x: usize, row: usize, depth: impl FnOnce() -> u8) {
        if let Some(written) = self.depth_of(x).get_mut(row) {
            *written = depth();
        }
    }
}

impl Frame {
    /// Has runs of pixels show a class.
    pub fn classify(&mut self, spans: &[Span], class: u16) {
        for span in spans {
            let row = usize::from(span.row) * self.width;
            self.class[row + usize::from(span.first)..row + usize::from(span.end)].fill(class);
        }
    }

    /// Takes over the walls, which were drawn by columns, into the first `rows` rows; whatever
    /// comes next is drawn by rows.
    pub fn take_walls<D: DepthBuffer, C: ClassBuffer>(
        &mut self,
        simd: Simd,
        columns: &Columns,
        rows: usize,
    ) {
        let Columns { stride, colour, depth } = columns;
        if C::WRITTEN {
            self.class[..rows * self.width].fill(class::WALL);
        }
        transpose::to_rows(simd, colour, *stride, &mut self.colour, self.width, rows);
        if D::WRITTEN {
            transpose::to_rows(simd, depth, *stride, &mut self.depth, self.width, rows);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_depth_of_a_row_past_the_last_one_is_not_written() {
        let mut columns = Columns::default();
        columns.fit(2, 40);
        let rows = columns.depth_of(0).len();
        columns.put_depth(0, rows - 1, || 7);
        columns.put_depth(0, rows, || 9);
        assert_eq!(columns.depth_of(0)[rows - 1], 7);
        assert!(columns.depth_of(1).iter().all(|&depth| depth == 0));
    }
}
