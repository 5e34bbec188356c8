//! The depth of midtextures as ViZDoom writes it, by what was seen of it
//! (`docs/results/pixels.md`).
//!
//! It draws four columns at once, one whose number divides by four and the three after it: the rows
//! that the four have in common together, the others column by column. Of those others a piece that
//! is a single row is written not its own depth but the last one written before the four.

use super::quads::QuadPieces;

/// The four columns at hand, and what was written before them.
#[derive(Clone, Debug, Default)]
pub(super) struct MidtextureDepth {
    /// None at first: then single rows are written their own.
    last_written: Option<u8>,
    /// Which of four that are drawn at once the column at hand is.
    in_four: Option<usize>,
    pieces: QuadPieces,
    /// Start of the run of texels that the last piece of each column shows: pieces of two runs may
    /// touch.
    runs: [u16; 4],
    depths: [u8; 4],
}

impl MidtextureDepth {
    /// Begins a frame.
    pub fn reset(&mut self) {
        self.last_written = None;
    }

    /// Notes the depth of something that is drawn otherwise.
    pub fn note(&mut self, depth: u8) {
        self.last_written = Some(depth);
    }

    /// Begins a column, and with the first one another four.
    pub fn begin_column(&mut self, in_four: Option<usize>) {
        self.in_four = in_four;
        if in_four == Some(0) {
            self.pieces.clear();
        }
    }

    /// Whether the column at hand is drawn with three others at once.
    pub fn is_in_four(&self) -> bool {
        self.in_four.is_some()
    }

    /// Adds a row to the column at hand, if it is one of four, below those that it has.
    pub fn add(&mut self, row: u16, run: u16, depth: u8) {
        let Some(column) = self.in_four else { return };
        let pieces = self.pieces.of(column);
        match pieces.last_mut() {
            Some([_, last]) if *last + 1 == row && self.runs[column] == run => *last = row,
            _ => pieces.push([row, row]),
        }
        (self.runs[column], self.depths[column]) = (run, depth);
    }

    /// Ends the column at hand, and with the last one the four: gives column, row and depth of the
    /// rows that are written another one than their own to `put`.
    pub fn end_column(&mut self, mut put: impl FnMut(usize, u16, u8)) {
        if self.in_four != Some(3) {
            return;
        }
        let written = self.last_written;
        let last_column = self.pieces.draw(|column, [first, last]| {
            if let Some(written) = written.filter(|_| first == last) {
                put(column, first, written);
            }
        });
        if let Some(column) = last_column {
            self.last_written = Some(self.depths[column]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::published_depth::quads::Piece;

    /// What is written of four columns of pieces, each in a run of its own, of depth 10 to 13,
    /// after a depth of 7.
    fn written(columns: [&[Piece]; 4]) -> (Vec<(usize, u16)>, Option<u8>) {
        let mut midtextures = MidtextureDepth::default();
        midtextures.note(7);
        for (column, pieces) in columns.iter().enumerate() {
            midtextures.begin_column(Some(column));
            for (run, &[first, last]) in pieces.iter().enumerate() {
                (first..=last).for_each(|row| midtextures.add(row, run as u16, 10 + column as u8));
            }
        }
        let mut list = Vec::new();
        midtextures.end_column(|column, row, depth| {
            assert_eq!(depth, 7);
            list.push((column, row));
        });
        (list, midtextures.last_written)
    }

    #[test]
    fn single_rows_that_not_all_columns_have_are_given_an_older_depth() {
        // Rows 3 to 5 are common: of what is above, column 1 has one row and column 2 two; below,
        // column 0 has one.
        assert_eq!(
            written([&[[3, 6]], &[[2, 5]], &[[1, 5]], &[[3, 5]]]),
            (vec![(1, 2), (0, 6)], Some(10))
        );
        // A common row is no single one, and is written last of the fourth column.
        assert_eq!(written([&[[4, 4]], &[[4, 4]], &[[4, 4]], &[[4, 4]]]), (vec![], Some(13)));
        // Without a common row: pieces of two rows keep their depth, though they touch pieces of
        // other runs.
        assert_eq!(
            written([&[[1, 1], [2, 2]], &[[5, 6]], &[], &[]]),
            (vec![(0, 1), (0, 2)], Some(11))
        );
        assert_eq!(written([&[], &[], &[], &[]]), (vec![], Some(7)));
    }

    #[test]
    fn pieces_without_a_common_row_end_where_the_next_ones_begin() {
        // Column 1's first piece goes down into the rows of column 0's second, which all have in
        // common.
        let (list, _) = written([&[[1, 1], [4, 6]], &[[3, 6]], &[[4, 6]], &[[4, 6]]]);
        assert_eq!(list, [(0, 1), (1, 3)]);
    }
}
