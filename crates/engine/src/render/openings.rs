//! What of each column is still open while the world is drawn front to back.

use super::narrow::padded;

/// For each frame column, the rows that nothing has covered yet.
#[derive(Clone, Debug, Default)]
pub(super) struct Openings {
    /// Columns.
    width: usize,
    /// First open row; padded for blocks of columns.
    pub top: Vec<i16>,
    /// One past the last open row; padded.
    pub bottom: Vec<i16>,
    /// A bit for each column that has an open row.
    open: Vec<u64>,
    /// Number of columns that are closed.
    closed: usize,
    /// No column left of this one is open.
    first: usize,
    /// No column from this one on is open.
    end: usize,
}

impl Openings {
    /// Opens every column.
    pub fn reset(&mut self, width: usize, rows: usize) {
        self.top.clear();
        self.top.resize(padded(width), 0);
        self.width = width;
        self.bottom.clear();
        self.bottom.resize(padded(width), rows as i16);
        self.open.clear();
        self.open.resize(width.div_ceil(64), u64::MAX);
        if !width.is_multiple_of(64) {
            self.open[width / 64] = (1 << (width % 64)) - 1;
        }
        self.closed = 0;
        (self.first, self.end) = (0, width);
    }

    /// Whether any column of `first..end` is open.
    #[inline]
    pub fn any_open(&self, first: usize, end: usize) -> bool {
        if self.closed == 0 {
            return first < end;
        }
        let (mut word, last) = (first / 64, (end - 1) / 64);
        let mut mask = u64::MAX << (first % 64);
        while word < last {
            if self.open[word] & mask != 0 {
                return true;
            }
            mask = u64::MAX;
            word += 1;
        }
        self.open[word] & mask & (u64::MAX >> (63 - (end - 1) % 64)) != 0
    }

    /// The narrowest range that holds every open column.
    #[inline]
    pub fn range(&mut self) -> (usize, usize) {
        while self.first < self.end && self.top[self.first] >= self.bottom[self.first] {
            self.first += 1;
        }
        while self.first < self.end && self.top[self.end - 1] >= self.bottom[self.end - 1] {
            self.end -= 1;
        }
        (self.first, self.end)
    }

    /// Whether so much within the open range is closed that it pays to ask what hides what.
    #[inline]
    pub fn has_holes(&self) -> bool {
        let outside = self.first + self.width - self.end;
        (self.closed - outside) * 4 > self.width
    }

    /// Closes the columns `first..end`.
    pub fn close(&mut self, first: usize, end: usize) {
        for x in first..end {
            self.close_column(x);
        }
    }

    /// Closes a column.
    #[inline]
    pub fn close_column(&mut self, x: usize) {
        self.bottom[x] = 0;
        self.top[x] = 0;
        let (word, bit) = (&mut self.open[x / 64], 1 << (x % 64));
        self.closed += usize::from(*word & bit != 0);
        *word &= !bit;
    }

    /// Notes which columns of `first..end` have no open row left.
    #[inline]
    pub fn note_closed(&mut self, first: usize, end: usize) {
        for x in first..end {
            if self.top[x] >= self.bottom[x] {
                self.close_column(x);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_see_exactly_their_columns() {
        let mut openings = Openings::default();
        openings.reset(160, 100);
        openings.close(0, 160);
        let (first, end) = openings.range();
        assert!(first >= end);
        for column in 0..160 {
            openings.reset(160, 100);
            openings.close(0, column);
            openings.close(column + 1, 160);
            assert_eq!(openings.range(), (column, column + 1));
            for (first, end) in [(0, 160), (column, column + 1), (0, column + 1), (column, 160)] {
                assert!(openings.any_open(first, end), "{column} in {first}..{end}");
            }
            assert!(column == 0 || !openings.any_open(0, column));
            assert!(column == 159 || !openings.any_open(column + 1, 160));
        }
    }
}
