//! What the walls leave for the sprites: which segs hide things behind them, and in which rows.

use crate::math::Fixed;
use crate::render::blocks::{COLUMN_BLOCK, padded};
use crate::render::buffers::drawsegs::overlap::{self, reaches::Reaches};
use crate::render::view::line::SeenLine;
use crate::simd::Simd;

/// A seg that hides part of what is behind it, or that has a masked texture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Silhouette {
    /// First frame column.
    pub first: usize,
    /// One past the last.
    pub end: usize,
    /// First base column and one past the last of the whole seg.
    pub base_ends: [i64; 2],
    /// Its line on the screen.
    pub line: SeenLine,
    /// The same as drawn between the whole columns of its ends.
    pub ends: SeenLine,
    /// Index of the seg.
    pub seg: u32,
    /// Inverse distances of the farther and the nearer end.
    pub inverses: [i64; 2],
    /// Things whose picture ends above this height are not hidden below; `None` hides nothing below.
    pub floor: Option<Fixed>,
    /// Things whose picture ends below this height are not hidden above; `None` hides nothing above.
    pub ceiling: Option<Fixed>,
    /// Everything behind is hidden.
    pub solid: bool,
    /// It has a masked texture in its opening.
    pub masked: bool,
    /// Where its open rows begin in the pools.
    pub rows: usize,
}

/// The silhouettes of a frame, near to far as the walk found them.
#[derive(Debug, Default)]
pub(crate) struct Silhouettes {
    pub list: Vec<Silhouette>,
    /// As many.
    reaches: Reaches,
    /// Those that the sprite at hand has to do with; see [`Silhouettes::meet`].
    met: Vec<u32>,
    /// Those with a masked texture.
    masked: Vec<u32>,
    /// First open rows, all silhouettes one after another; there is room for more than are used.
    pub tops: Vec<i16>,
    /// One past the last open rows.
    pub bottoms: Vec<i16>,
    /// How many rows are used.
    used: usize,
    /// Columns whose masked texture has been drawn, as far as the last masked silhouette.
    pub drawn: Vec<bool>,
}

impl Silhouettes {
    /// Forgets the last frame.
    pub fn reset(&mut self) {
        self.list.clear();
        self.reaches.count = 0;
        self.masked.clear();
        self.used = 0;
        self.drawn.clear();
    }

    /// Adds a silhouette with the rows that are open in its columns: `tops` and `bottoms` begin there and are padded, so
    /// that few columns are copied without a call.
    pub fn add(&mut self, mut silhouette: Silhouette, tops: &[i16], bottoms: &[i16]) {
        let (rows, count) = (self.used, silhouette.end - silhouette.first);
        silhouette.rows = rows;
        self.used += count;
        if self.tops.len() < padded(self.used) {
            self.tops.resize(2 * padded(self.used), 0);
            self.bottoms.resize(2 * padded(self.used), 0);
        }
        for from in (0..count).step_by(COLUMN_BLOCK) {
            copy_block(&mut self.tops[rows + from..], &tops[from..]);
            copy_block(&mut self.bottoms[rows + from..], &bottoms[from..]);
        }
        if silhouette.masked {
            self.drawn.resize(self.used, false);
            self.masked.push(self.list.len() as u32);
        }
        let near = if silhouette.masked { i64::MAX } else { silhouette.inverses[1] };
        self.reaches.push(silhouette.first, silhouette.end, near);
        self.list.push(silhouette);
    }

    /// Lists the silhouettes that share a column with a sprite of the columns `first..end`, and stand before it in part or have a
    /// masked texture; `inverse` is its inverse distance. Gives how many there are; they are [`Silhouettes::met`].
    pub fn meet(&mut self, simd: Simd, first: usize, end: usize, inverse: i64) -> usize {
        self.met.resize(self.reaches.nears.len(), 0);
        overlap::list(&self.reaches, simd, [first as u32, end as u32], inverse, &mut self.met)
    }

    /// Indices of the silhouettes with a masked texture, near to far.
    pub fn masked(&self) -> &[u32] {
        &self.masked
    }

    /// Index of the silhouette that was met at place `at`, near to far.
    pub fn met(&self, at: usize) -> usize {
        self.met[at] as usize
    }
}

#[inline(always)]
fn copy_block(to: &mut [i16], from: &[i16]) {
    let to: &mut [i16; COLUMN_BLOCK] = to.first_chunk_mut().expect("lists are padded");
    *to = *from.first_chunk().expect("lists are padded");
}
