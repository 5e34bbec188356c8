//! Spans as vector code finds them: row by row, the columns of a row as a mask of bits.

use crate::render::buffers::visplane::{SPAN_BLOCK, Span, VisPlane};
use std::ops::Range;

/// The rows of a block of columns.
#[inline(always)]
pub(crate) fn block(plane: &VisPlane, from: usize) -> (&[i16; SPAN_BLOCK], &[i16; SPAN_BLOCK]) {
    let [top, bottom] = [&plane.top, &plane.bottom]
        .map(|list| list[from..].first_chunk().expect("lists are padded"));
    (top, bottom)
}

/// Takes the lowest run of bits out of a mask.
#[inline(always)]
pub(crate) fn next_run(mask: &mut u64) -> Range<usize> {
    // Adding to the lowest bit of a run carries to the place behind the run.
    let behind = mask.wrapping_add(*mask & mask.wrapping_neg());
    let run = mask.trailing_zeros() as usize..behind.trailing_zeros() as usize;
    *mask &= behind;
    run
}

/// Spans as they are found, row by row and from left to right.
pub(crate) struct RowSpans<'a> {
    pub spans: &'a mut Vec<Span>,
    pub count: usize,
    /// How many there were before the row at hand.
    pub row_start: usize,
    pub row: u16,
}

impl RowSpans<'_> {
    #[inline(always)]
    pub fn begin(&mut self, row: i16, plane: &VisPlane) {
        (self.row, self.row_start) = (row as u16, self.count);
        // Every second column may be a span of its own.
        let most = self.count + (plane.end - plane.first + SPAN_BLOCK) / 2 + 1;
        if self.spans.len() < most {
            self.spans.resize(2 * most, Span::default());
        }
    }

    /// Adds the columns of a mask, the lowest bit of which is column `from`.
    #[inline(always)]
    pub fn add(&mut self, from: usize, mut mask: u64) {
        let spans = &mut self.spans[..];
        if mask & 1 != 0
            && self.count > self.row_start
            && usize::from(spans[self.count - 1].end) == from
        {
            // It goes on from the block before.
            let more = mask.trailing_ones();
            spans[self.count - 1].end += more as u16;
            mask &= mask.wrapping_add(1);
        }
        while mask != 0 {
            let run = next_run(&mut mask);
            spans[self.count] = Span {
                row: self.row,
                first: (from + run.start) as u16,
                end: (from + run.end) as u16,
            };
            self.count += 1;
        }
    }
}
