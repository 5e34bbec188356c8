//! What of each column is still open while the world is drawn front to back.

use crate::render::blocks::padded;

/// For each frame column, the rows that nothing has covered yet.
#[derive(Clone, Debug, Default)]
pub(crate) struct ColumnClip {
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

impl ColumnClip {
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

    /// How many columns are closed.
    #[inline]
    pub fn closed(&self) -> usize {
        self.closed
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

    /// The first open rows of the columns from `first` on, one past the last ones, and which of
    /// them are open.
    #[inline(always)]
    pub fn from(&mut self, first: usize) -> (&mut [i16], &mut [i16], OpenColumns<'_>) {
        let open = OpenColumns { bits: &mut self.open, closed: &mut self.closed, first };
        (&mut self.top[first..], &mut self.bottom[first..], open)
    }
}

/// Which columns are open, counted from one of them.
pub(crate) struct OpenColumns<'a> {
    /// A bit for each column of the frame.
    pub bits: &'a mut [u64],
    /// How many are closed.
    pub closed: &'a mut usize,
    /// The column that is counted from.
    pub first: usize,
}

impl OpenColumns<'_> {
    /// Closes those of the columns from `from` on that `columns` has bits of; all of them are open.
    #[inline(always)]
    pub fn close(&mut self, from: usize, columns: u64) {
        if columns == 0 {
            return;
        }
        *self.closed += columns.count_ones() as usize;
        let (word, shift) = ((self.first + from) / 64, (self.first + from) % 64);
        self.bits[word] &= !(columns << shift);
        let beyond = columns >> 1 >> (63 - shift);
        if beyond != 0 {
            self.bits[word + 1] &= !beyond;
        }
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
    fn bits_are_those_of_single_columns() {
        let mut rng = crate::math::Rng::new(20);
        for width in [128, 160, 100, 64, 1001] {
            let mut clip = ColumnClip::default();
            clip.reset(width, 60);
            let mut open = vec![true; width];
            for _ in 0..200 {
                let first = rng.below(width as u32) as usize;
                let end = first + 1 + rng.below((width - first) as u32) as usize;
                if rng.below(8) == 0 {
                    clip.close(first, end);
                    open[first..end].fill(false);
                } else {
                    let count = (end - first).min(16);
                    let chosen = (0..count).filter(|i| open[first + i] && rng.below(9) == 0);
                    let bits = chosen.fold(0, |bits, i| bits | 1 << i);
                    // Counted from a column further left.
                    let from = rng.below(first as u32 + 1) as usize;
                    clip.from(from).2.close(first - from, bits);
                    (0..count).filter(|i| bits >> i & 1 != 0).for_each(|i| open[first + i] = false);
                }
                assert!((0..width).all(|x| clip.any_open(x, x + 1) == open[x]));
                let range =
                    open.iter().position(|&open| open).zip(open.iter().rposition(|&open| open));
                let (first, end) = clip.range();
                assert_eq!(range.is_none(), first >= end);
                assert!(range.is_none_or(|(one, last)| (one, last + 1) == (first, end)));
                assert_eq!(clip.closed, open.iter().filter(|&&open| !open).count());
            }
        }
    }

    #[test]
    fn ranges_see_exactly_their_columns() {
        let mut clip = ColumnClip::default();
        clip.reset(160, 100);
        clip.close(0, 160);
        let (first, end) = clip.range();
        assert!(first >= end);
        for column in 0..160 {
            clip.reset(160, 100);
            clip.close(0, column);
            clip.close(column + 1, 160);
            assert_eq!(clip.range(), (column, column + 1));
            for (first, end) in [(0, 160), (column, column + 1), (0, column + 1), (column, 160)] {
                assert!(clip.any_open(first, end), "{column} in {first}..{end}");
            }
            assert!(column == 0 || !clip.any_open(0, column));
            assert!(column == 159 || !clip.any_open(column + 1, 160));
        }
    }
}
