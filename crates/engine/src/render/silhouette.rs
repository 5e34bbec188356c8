//! What the walls leave for the sprites: which segs hide things behind them, and in which rows.

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

/// The silhouettes of a frame, near to far as the walk found them.
#[derive(Clone, Debug, Default)]
pub(super) struct Silhouettes {
    pub list: Vec<Silhouette>,
    /// First open rows, all silhouettes one after another.
    pub tops: Vec<i16>,
    /// One past the last open rows.
    pub bottoms: Vec<i16>,
    /// Columns whose masked texture has been drawn.
    pub drawn: Vec<bool>,
}

impl Silhouettes {
    /// Forgets the last frame.
    pub fn reset(&mut self) {
        self.list.clear();
        self.tops.clear();
        self.bottoms.clear();
        self.drawn.clear();
    }

    /// Adds a silhouette with the rows that are open in its columns.
    pub fn add(&mut self, mut silhouette: Silhouette, tops: &[i16], bottoms: &[i16]) {
        silhouette.rows = self.tops.len();
        self.tops.extend_from_slice(tops);
        self.bottoms.extend_from_slice(bottoms);
        self.drawn.resize(self.tops.len(), false);
        self.list.push(silhouette);
    }
}
