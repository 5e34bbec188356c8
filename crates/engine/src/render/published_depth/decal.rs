//! The depth of soot as ViZDoom writes it (`docs/results/pixels.md`).
//!
//! It draws four columns at once, and none of what draws soot writes a depth of its own: all is
//! written what was written last, at first the depth of the wall's last column. Only a column of a
//! four that is drawn by itself leaves another one, for the quads to come: that of the column as
//! far into the last four of the wall.

use super::quads::QuadPieces;
use crate::render::textures::midtexture::posts_of;
use std::ops::Range;

/// What is written of the soot on a wall.
#[derive(Clone, Debug, Default)]
pub(super) struct DecalDepth {
    written: u8,
    /// Depths that the columns of the wall's last four leave; none if there is no whole one.
    last_quad: Option<[u8; 4]>,
    /// The first column of the four at hand.
    from: Option<usize>,
    pieces: QuadPieces,
}

impl DecalDepth {
    /// Begins a wall, of whose last column `written` was written.
    pub fn begin(&mut self, written: u8, last_quad: Option<[u8; 4]>) {
        self.end();
        (self.written, self.last_quad) = (written, last_quad);
    }

    /// Ends the mark at hand, if there is one, and begins one that covers the columns `covered`.
    pub fn mark(&mut self, covered: Range<usize>) -> DecalMark<'_> {
        self.end();
        DecalMark { wall: self, covered }
    }

    /// The depth of a column of a mark that covers the columns `mark`, which come in their order.
    fn column(&mut self, x: usize, mark: &Range<usize>) -> u8 {
        let from = x - x % 4;
        let four = (mark.start <= from && from + 4 <= mark.end).then_some(from);
        if self.from != four {
            self.end();
            self.from = four;
        }
        self.written
    }

    /// Notes a run of rows of the column at hand.
    fn add(&mut self, x: usize, rows: &Range<usize>) {
        if self.from.is_some() && !rows.is_empty() {
            self.pieces.of(x % 4).push([rows.start as u16, rows.end as u16 - 1]);
        }
    }

    /// Ends a mark.
    fn end(&mut self) {
        if self.from.take().is_some() {
            let mut alone = None;
            self.pieces.draw(|column, _| alone = Some(column));
            self.pieces.clear();
            if let (Some(column), Some(last_quad)) = (alone, self.last_quad) {
                self.written = last_quad[column];
            }
        }
    }
}

/// A mark of soot on a wall.
pub(crate) struct DecalMark<'a> {
    wall: &'a mut DecalDepth,
    covered: Range<usize>,
}

impl DecalMark<'_> {
    /// Writes the depth of a column into `depth`, to the right of those before it: of which texels
    /// it shows, and which rows a run of texels covers.
    pub fn column(
        &mut self,
        x: usize,
        depth: &mut [u8],
        shown: impl Iterator<Item = bool>,
        rows: impl Fn([u16; 2]) -> Range<usize>,
    ) {
        let written = self.wall.column(x, &self.covered);
        for run in posts_of(shown) {
            let rows = rows(run);
            self.wall.add(x, &rows);
            if !rows.is_empty() {
                depth[rows].fill(written);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is written of the columns of a mark with a run of rows each.
    fn written(first: usize, rows: &[Range<usize>], last_quad: Option<[u8; 4]>) -> Vec<u8> {
        let mut depth = DecalDepth::default();
        depth.begin(9, last_quad);
        let mark = first..first + rows.len();
        let written = mark.clone().zip(rows).map(|(x, rows)| {
            let written = depth.column(x, &mark);
            depth.add(x, rows);
            written
        });
        written.collect()
    }

    #[test]
    fn fours_without_a_column_by_itself_go_on_as_before() {
        assert_eq!(written(4, &[const { 2..8 }; 9], Some([1, 2, 3, 4])), [9; 9]);
        assert_eq!(written(3, &[const { 0..0 }; 12], Some([1, 2, 3, 4])), [9; 12]);
    }

    #[test]
    fn the_last_column_by_itself_decides_about_what_comes_after_its_four() {
        // Column 6 begins a row early, column 5 ends a row late: that is drawn after what all
        // share.
        let rows = [2..8, 2..9, 1..8, 2..8, 2..8, 2..8, 2..8, 2..8, 3..7];
        assert_eq!(written(4, &rows, Some([1, 2, 3, 4])), [9, 9, 9, 9, 2, 2, 2, 2, 2]);
        // Before the first four and after the last one columns are drawn one by one, and leave
        // nothing: now column 4 begins early.
        assert_eq!(written(2, &rows, Some([1, 2, 3, 4])), [9, 9, 9, 9, 9, 9, 1, 1, 1]);
        assert_eq!(written(4, &rows, None), [9; 9]);
    }
}
