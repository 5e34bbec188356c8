//! Spans of a plane row by row: which columns of a row belong to the plane is a mask of bits, 64 columns at a time. The
//! plain twin, column by column, is in `plane`, where a test compares them.

use crate::render::buffers::visplane::{Plane, SPAN_BLOCK, Span};
use std::arch::x86_64::*;
use std::ops::Range;

/// With vectors of 64 bytes.
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
pub(crate) fn spans_avx512(plane: &Plane, spans: &mut Vec<Span>) -> usize {
    let (first_row, end_row) = rows(plane);
    let mut list = RowSpans { spans, count: 0, row_start: 0, row: 0 };
    for row in first_row..end_row {
        let here = _mm512_set1_epi16(row);
        list.begin(row, plane);
        let mut from = plane.first;
        while from < plane.end {
            let (top, bottom) = block(plane, from);
            let (top, bottom) = (load_avx512(top), load_avx512(bottom));
            let low = _mm512_mask_cmpgt_epi16_mask(_mm512_cmple_epi16_mask(top[0], here), bottom[0], here);
            let high = _mm512_mask_cmpgt_epi16_mask(_mm512_cmple_epi16_mask(top[1], here), bottom[1], here);
            list.add(from, u64::from(low) | u64::from(high) << 32);
            from += SPAN_BLOCK;
        }
    }
    list.count
}

#[inline]
#[target_feature(enable = "avx512f")]
pub(crate) fn load_avx512(list: &[i16; SPAN_BLOCK]) -> [__m512i; 2] {
    // SAFETY: 128 bytes are readable behind the reference.
    unsafe { [_mm512_loadu_si512(list.as_ptr().cast()), _mm512_loadu_si512(list.as_ptr().add(32).cast())] }
}

/// With vectors of 32 bytes.
#[target_feature(enable = "avx2")]
pub(crate) fn spans_avx2(plane: &Plane, spans: &mut Vec<Span>) -> usize {
    let (first_row, end_row) = rows(plane);
    let mut list = RowSpans { spans, count: 0, row_start: 0, row: 0 };
    for row in first_row..end_row {
        list.begin(row, plane);
        let mut from = plane.first;
        while from < plane.end {
            let (top, bottom) = block(plane, from);
            list.add(from, columns_avx2(top, bottom, row));
            from += SPAN_BLOCK;
        }
    }
    list.count
}

/// Which of 64 columns, given by their first rows and by one past the last, have a row.
#[inline]
#[target_feature(enable = "avx2")]
fn columns_avx2(top: &[i16; SPAN_BLOCK], bottom: &[i16; SPAN_BLOCK], row: i16) -> u64 {
    let here = _mm256_set1_epi16(row);
    u64::from(half_avx2(top, bottom, 0, here)) | u64::from(half_avx2(top, bottom, 32, here)) << 32
}

/// Which of the 32 columns from `from` on have the row `here`.
#[inline]
#[target_feature(enable = "avx2")]
fn half_avx2(top: &[i16; SPAN_BLOCK], bottom: &[i16; SPAN_BLOCK], from: usize, here: __m256i) -> u32 {
    // SAFETY: 64 bytes are readable from `from`, 0 or 32, on.
    let (top, next_top) = unsafe { load_avx2(top.as_ptr().add(from)) };
    // SAFETY: as above.
    let (bottom, next_bottom) = unsafe { load_avx2(bottom.as_ptr().add(from)) };
    let one = _mm256_andnot_si256(_mm256_cmpgt_epi16(top, here), _mm256_cmpgt_epi16(bottom, here));
    let next = _mm256_andnot_si256(_mm256_cmpgt_epi16(next_top, here), _mm256_cmpgt_epi16(next_bottom, here));
    // Packing works within halves of vectors: the quarters come as 0, 2, 1, 3.
    _mm256_movemask_epi8(_mm256_permute4x64_epi64(_mm256_packs_epi16(one, next), 0b11_01_10_00)) as u32
}

/// # Safety
/// 64 bytes must be readable.
#[inline]
#[target_feature(enable = "avx2")]
unsafe fn load_avx2(list: *const i16) -> (__m256i, __m256i) {
    // SAFETY: the caller's promise.
    unsafe { (_mm256_loadu_si256(list.cast()), _mm256_loadu_si256(list.add(16).cast())) }
}

/// The rows of a block of columns.
#[inline(always)]
fn block(plane: &Plane, from: usize) -> (&[i16; SPAN_BLOCK], &[i16; SPAN_BLOCK]) {
    let [top, bottom] = [&plane.top, &plane.bottom].map(|list| list[from..].first_chunk().expect("lists are padded"));
    (top, bottom)
}

/// The first row of a plane, and one past the last; not below the first where the plane has no row.
#[inline]
#[target_feature(enable = "avx2")]
pub(crate) fn rows(plane: &Plane) -> (i16, i16) {
    let none = _mm256_set1_epi16(i16::MAX);
    let (mut first, mut end) = (none, _mm256_setzero_si256());
    let lists = plane.top[plane.first..].chunks_exact(16).zip(plane.bottom[plane.first..].chunks_exact(16));
    // Beyond its last column a plane has no rows.
    for (top, bottom) in lists.take((plane.end - plane.first).div_ceil(16)) {
        // SAFETY: 32 bytes are readable behind both references.
        let [top, bottom] = [top, bottom].map(|list| unsafe { _mm256_loadu_si256(list.as_ptr().cast()) });
        first = _mm256_min_epi16(first, _mm256_blendv_epi8(none, top, _mm256_cmpgt_epi16(bottom, top)));
        end = _mm256_max_epi16(end, bottom);
    }
    // Of numbers that are not negative there is an instruction for the least of eight.
    let least = |sixteen: __m256i| {
        let eight = _mm_min_epi16(_mm256_castsi256_si128(sixteen), _mm256_extracti128_si256(sixteen, 1));
        _mm_cvtsi128_si32(_mm_minpos_epu16(eight)) as i16
    };
    (least(first), i16::MAX - least(_mm256_sub_epi16(none, end)))
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
struct RowSpans<'a> {
    spans: &'a mut Vec<Span>,
    count: usize,
    /// How many there were before the row at hand.
    row_start: usize,
    row: u16,
}

impl RowSpans<'_> {
    #[inline(always)]
    fn begin(&mut self, row: i16, plane: &Plane) {
        (self.row, self.row_start) = (row as u16, self.count);
        // Every second column may be a span of its own.
        let most = self.count + (plane.end - plane.first + SPAN_BLOCK) / 2 + 1;
        if self.spans.len() < most {
            self.spans.resize(2 * most, Span::default());
        }
    }

    /// Adds the columns of a mask, the lowest bit of which is column `from`.
    #[inline(always)]
    fn add(&mut self, from: usize, mut mask: u64) {
        let spans = &mut self.spans[..];
        if mask & 1 != 0 && self.count > self.row_start && usize::from(spans[self.count - 1].end) == from {
            // It goes on from the block before.
            let more = mask.trailing_ones();
            spans[self.count - 1].end += more as u16;
            mask &= mask.wrapping_add(1);
        }
        while mask != 0 {
            let run = next_run(&mut mask);
            spans[self.count] = Span { row: self.row, first: (from + run.start) as u16, end: (from + run.end) as u16 };
            self.count += 1;
        }
    }
}
