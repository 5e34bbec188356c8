//! What of each column is still open while the world is drawn front to back.

use super::narrow::padded;

/// For each frame column, the rows that nothing has covered yet.
#[derive(Debug, Default)]
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
        while self.first < self.end {
            let rest = self.open[self.first / 64] >> (self.first % 64);
            if rest != 0 {
                self.first += rest.trailing_zeros() as usize;
                break;
            }
            self.first = (self.first / 64 + 1) * 64;
        }
        while self.first < self.end {
            let last = self.end - 1;
            let rest = self.open[last / 64] << (63 - last % 64);
            if rest != 0 {
                self.end -= rest.leading_zeros() as usize;
                break;
            }
            self.end = last / 64 * 64;
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
        self.top[first..end].fill(0);
        self.bottom[first..end].fill(0);
        for_each_word(first, end, |word, mask| {
            self.closed += (self.open[word] & mask).count_ones() as usize;
            self.open[word] &= !mask;
        });
    }

    /// Notes which columns of `first..end` have no open row left.
    #[inline]
    pub fn note_closed(&mut self, first: usize, end: usize) {
        for_each_word(first, end, |word, mask| {
            let from = word * 64 + mask.trailing_zeros() as usize;
            let count = mask.count_ones() as usize;
            let rows = self.top[from..from + count].iter().zip(&self.bottom[from..from + count]);
            // Which columns close cannot be foretold: bits without a branch, and then those that closed just now.
            let closed = rows.rev().fold(0, |bits, (top, bottom)| bits << 1 | u64::from(top >= bottom));
            let mut newly = (closed << (from % 64)) & self.open[word];
            self.open[word] &= !newly;
            self.closed += newly.count_ones() as usize;
            while newly != 0 {
                let x = word * 64 + newly.trailing_zeros() as usize;
                (self.top[x], self.bottom[x]) = (0, 0);
                newly &= newly - 1;
            }
        });
    }
}

/// Each word of bits that has some of the columns `first..end`, with a mask of these.
#[inline(always)]
fn for_each_word(first: usize, end: usize, mut visit: impl FnMut(usize, u64)) {
    let mut from = first;
    while from < end {
        let until = end.min((from / 64 + 1) * 64);
        visit(from / 64, (u64::MAX >> (64 - (until - from))) << (from % 64));
        from = until;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notes_are_those_of_single_columns() {
        let mut rng = crate::math::Rng::new(20);
        for width in [128, 160, 100, 64, 1001] {
            let mut openings = Openings::default();
            openings.reset(width, 60);
            let mut open = vec![true; width];
            for _ in 0..200 {
                let first = rng.below(width as u32) as usize;
                let end = first + 1 + rng.below((width - first) as u32) as usize;
                if rng.below(8) == 0 {
                    openings.close(first, end);
                    open[first..end].fill(false);
                } else {
                    for x in (first..end).filter(|_| rng.below(9) == 0) {
                        if open[x] {
                            (openings.top[x], openings.bottom[x]) = (30, 29);
                        }
                        open[x] = false;
                    }
                    openings.note_closed(first, end);
                }
                assert!((0..width).all(|x| openings.any_open(x, x + 1) == open[x]));
                assert!((0..width).all(|x| open[x] || (openings.top[x], openings.bottom[x]) == (0, 0)));
                let range = open.iter().position(|&open| open).zip(open.iter().rposition(|&open| open));
                let (first, end) = openings.range();
                assert_eq!(range.is_none(), first >= end);
                assert!(range.is_none_or(|(one, last)| (one, last + 1) == (first, end)));
                assert_eq!(openings.closed, open.iter().filter(|&&open| !open).count());
            }
        }
    }

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
