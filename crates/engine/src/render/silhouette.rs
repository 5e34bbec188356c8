//! What the walls leave for the sprites: which segs hide things behind them, and in which rows.

use super::narrow::{BLOCK, padded};
use super::wall::SeenLine;
use crate::math::Fixed;

/// A seg that hides part of what is behind it, or that has a masked texture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Silhouette {
    /// First frame column.
    pub first: usize,
    /// One past the last.
    pub end: usize,
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

/// What decides in most cases that a silhouette and a sprite have nothing to do with each other, on its own: a frame has
/// dozens of silhouettes, and each sprite asks all of them.
#[derive(Clone, Copy, Debug)]
struct Reach {
    first: u32,
    end: u32,
    /// Inverse distance of the nearer end; the greatest number if it has a masked texture.
    near: i64,
}

/// The silhouettes of a frame, near to far as the walk found them.
#[derive(Debug, Default)]
pub(super) struct Silhouettes {
    pub list: Vec<Silhouette>,
    /// As many.
    reaches: Vec<Reach>,
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
        self.reaches.clear();
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
        for from in (0..count).step_by(BLOCK) {
            copy_block(&mut self.tops[rows + from..], &tops[from..]);
            copy_block(&mut self.bottoms[rows + from..], &bottoms[from..]);
        }
        if silhouette.masked {
            self.drawn.resize(self.used, false);
            self.masked.push(self.list.len() as u32);
        }
        let near = if silhouette.masked { i64::MAX } else { silhouette.inverses[1] };
        self.reaches.push(Reach { first: silhouette.first as u32, end: silhouette.end as u32, near });
        self.list.push(silhouette);
    }

    /// Lists the silhouettes that share a column with a sprite of the columns `first..end`, and stand before it in part or have a
    /// masked texture; `inverse` is its inverse distance. Which ones do cannot be foretold: it is found without a branch. Gives
    /// how many there are; they are [`Silhouettes::met`].
    pub fn meet(&mut self, first: usize, end: usize, inverse: i64) -> usize {
        self.met.resize(self.reaches.len(), 0);
        let (first, end) = (first as u32, end as u32);
        let mut count = 0;
        for (index, reach) in (0..).zip(&self.reaches) {
            self.met[count] = index;
            count += usize::from((reach.first < end) & (reach.end > first) & (reach.near >= inverse));
        }
        count
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
    let to: &mut [i16; BLOCK] = to.first_chunk_mut().expect("lists are padded");
    *to = *from.first_chunk().expect("lists are padded");
}
