//! Spans row by row with vectors of 64 bytes: which of 64 columns have a row is one mask.

use crate::render::buffers::visplane::{SPAN_BLOCK, Span, VisPlane};
use crate::render::planes::spans::avx2::rows;
use crate::render::planes::spans::rows::{RowSpans, block};
use std::arch::x86_64::*;

/// With vectors of 64 bytes.
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
pub(crate) fn list(plane: &VisPlane, spans: &mut Vec<Span>) -> usize {
    let (first_row, end_row) = rows(plane);
    let mut list = RowSpans { spans, count: 0, row_start: 0, row: 0 };
    for row in first_row..end_row {
        let here = _mm512_set1_epi16(row);
        list.begin(row, plane);
        let mut from = plane.first;
        while from < plane.end {
            let (top, bottom) = block(plane, from);
            let (top, bottom) = (load_avx512(top), load_avx512(bottom));
            let low = _mm512_mask_cmpgt_epi16_mask(
                _mm512_cmple_epi16_mask(top[0], here),
                bottom[0],
                here,
            );
            let high = _mm512_mask_cmpgt_epi16_mask(
                _mm512_cmple_epi16_mask(top[1], here),
                bottom[1],
                here,
            );
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
    unsafe {
        [_mm512_loadu_si512(list.as_ptr().cast()), _mm512_loadu_si512(list.as_ptr().add(32).cast())]
    }
}
