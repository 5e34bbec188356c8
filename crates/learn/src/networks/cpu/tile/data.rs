//! What a tile is made of, for every family of kernels.

/// Columns of a tile; widths of results are multiples of it.
pub const PANEL: usize = 32;

/// What becomes of a tile's sums.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Finish {
    /// They begin at zero and are written down.
    Set,
    /// They go on from what is there.
    Continue,
    /// They begin at zero and are added to what is there.
    Add,
}

/// Strides of a tile.
#[derive(Clone, Copy)]
pub(crate) struct Tile {
    /// Inner indices of a part.
    pub inner: usize,
    /// Parts of the inner dimension: each begins so far behind the one before in the left factor,
    /// and right behind it in the right one.
    pub parts: usize,
    pub left_part: usize,
    pub row_stride: usize,
    pub left_inner: usize,
    pub right_inner: usize,
    pub out_stride: usize,
    pub finish: Finish,
    /// How far behind the right factor lies what will be read in its place soon.
    pub next: usize,
    /// What of that is fetched on the way.
    pub ahead: Ahead,
}

/// The part of the next panel that a tile fetches while it works on this one; a bit for each half,
/// as kernels are made for it.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Ahead {
    Nothing = 0,
    LeftHalf = 1,
    RightHalf = 2,
    Everything = 3,
}

impl Ahead {
    /// What a tile fetches which ends at row `end` of `rows`: the last two of a panel share the
    /// next, so that it comes no faster than it has to.
    pub fn at(first: usize, end: usize, rows: usize) -> Ahead {
        match (end == rows, first > 0) {
            (true, false) => Ahead::Everything,
            (true, true) => Ahead::RightHalf,
            // Tiles differ by one row at most.
            (false, _) if 2 * end - first + 1 >= rows => Ahead::LeftHalf,
            _ => Ahead::Nothing,
        }
    }
}

pub(super) const LEFT: u8 = Ahead::LeftHalf as u8;

pub(super) const RIGHT: u8 = Ahead::RightHalf as u8;
