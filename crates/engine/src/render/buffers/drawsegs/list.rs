//! What the walls leave for the sprites: which segs hide things behind them, and in which rows.

use crate::math::Fixed;
use crate::render::blocks::{COLUMN_BLOCK, padded};
use crate::render::buffers::drawsegs::overlap::{self, reaches::DrawSegBounds};
use crate::render::view::line::ProjectedLine;
use crate::simd::Simd;

/// A seg that hides part of what is behind it, or that has a masked texture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DrawSeg {
    /// First frame column.
    pub first: usize,
    /// One past the last.
    pub end: usize,
    /// First base column and one past the last of the whole seg.
    pub base_ends: [i64; 2],
    /// Its line on the screen.
    pub line: ProjectedLine,
    /// The same as drawn between the whole columns of its ends.
    pub ends: ProjectedLine,
    /// Index of the seg.
    pub seg: u32,
    /// Inverse distances of the farther and the nearer end.
    pub inverses: [i64; 2],
    /// Things whose picture ends above this height are not hidden below; `None` hides nothing
    /// below.
    pub floor: Option<Fixed>,
    /// Things whose picture ends below this height are not hidden above; `None` hides nothing
    /// above.
    pub ceiling: Option<Fixed>,
    /// Everything behind is hidden.
    pub solid: bool,
    /// It has a masked texture in its opening.
    pub masked: bool,
    /// Where its open rows begin in the pools.
    pub rows: usize,
}

/// The drawsegs of a frame, near to far as the walk found them.
#[derive(Debug, Default)]
pub(crate) struct DrawSegs {
    pub list: Vec<DrawSeg>,
    /// As many.
    reaches: DrawSegBounds,
    /// Those that the sprite at hand has to do with; see [`DrawSegs::meet`].
    met: Vec<u32>,
    /// Those with a masked texture.
    masked: Vec<u32>,
    /// First open rows, all drawsegs one after another; there is room for more than are used.
    pub tops: Vec<i16>,
    /// One past the last open rows.
    pub bottoms: Vec<i16>,
    /// How many rows are used.
    used: usize,
    /// Columns whose masked texture has been drawn, as far as the last masked drawseg.
    pub drawn: Vec<bool>,
}

impl DrawSegs {
    /// Forgets the last frame.
    pub fn reset(&mut self) {
        self.list.clear();
        self.reaches.count = 0;
        self.masked.clear();
        self.used = 0;
        self.drawn.clear();
    }

    /// Adds a drawseg with the rows that are open in its columns: `tops` and `bottoms` begin there
    /// and are padded, so that few columns are copied without a call.
    pub fn add(&mut self, mut drawseg: DrawSeg, tops: &[i16], bottoms: &[i16]) {
        let (rows, count) = (self.used, drawseg.end - drawseg.first);
        drawseg.rows = rows;
        self.used += count;
        if self.tops.len() < padded(self.used) {
            self.tops.resize(2 * padded(self.used), 0);
            self.bottoms.resize(2 * padded(self.used), 0);
        }
        for from in (0..count).step_by(COLUMN_BLOCK) {
            copy_block(&mut self.tops[rows + from..], &tops[from..]);
            copy_block(&mut self.bottoms[rows + from..], &bottoms[from..]);
        }
        if drawseg.masked {
            self.drawn.resize(self.used, false);
            self.masked.push(self.list.len() as u32);
        }
        let near = if drawseg.masked { i64::MAX } else { drawseg.inverses[1] };
        self.reaches.push(drawseg.first, drawseg.end, near);
        self.list.push(drawseg);
    }

    /// Lists the drawsegs that share a column with a sprite of the columns `first..end`, and stand
    /// before it in part or have a masked texture; `inverse` is its inverse distance. Gives how
    /// many there are; they are [`DrawSegs::met`].
    pub fn meet(&mut self, simd: Simd, first: usize, end: usize, inverse: i64) -> usize {
        self.met.resize(self.reaches.nears.len(), 0);
        overlap::list(&self.reaches, simd, [first as u32, end as u32], inverse, &mut self.met)
    }

    /// Indices of the drawsegs with a masked texture, near to far.
    pub fn masked(&self) -> &[u32] {
        &self.masked
    }

    /// Index of the drawseg that was met at place `at`, near to far.
    pub fn met(&self, at: usize) -> usize {
        self.met[at] as usize
    }
}

#[inline(always)]
fn copy_block(to: &mut [i16], from: &[i16]) {
    let to: &mut [i16; COLUMN_BLOCK] = to.first_chunk_mut().expect("lists are padded");
    *to = *from.first_chunk().expect("lists are padded");
}
