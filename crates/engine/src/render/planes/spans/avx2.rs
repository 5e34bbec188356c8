//! Spans row by row with vectors of 32 bytes.

use crate::render::buffers::visplane::{SPAN_BLOCK, Span, VisPlane};
use crate::render::planes::spans::rows::{RowSpans, block};
use std::arch::x86_64::*;

/// With vectors of 32 bytes.
#[target_feature(enable = "avx2")]
pub(crate) fn list(plane: &VisPlane, spans: &mut Vec<Span>) -> usize {
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
fn half_avx2(
    top: &[i16; SPAN_BLOCK],
    bottom: &[i16; SPAN_BLOCK],
    from: usize,
    here: __m256i,
) -> u32 {
    // SAFETY: 64 bytes are readable from `from`, 0 or 32, on.
    let (top, next_top) = unsafe { load_avx2(top.as_ptr().add(from)) };
    // SAFETY: as above.
    let (bottom, next_bottom) = unsafe { load_avx2(bottom.as_ptr().add(from)) };
    let one = _mm256_andnot_si256(_mm256_cmpgt_epi16(top, here), _mm256_cmpgt_epi16(bottom, here));
    let next = _mm256_andnot_si256(
        _mm256_cmpgt_epi16(next_top, here),
        _mm256_cmpgt_epi16(next_bottom, here),
    );
    // Packing works within halves of vectors: the quarters come as 0, 2, 1, 3.
    _mm256_movemask_epi8(_mm256_permute4x64_epi64(_mm256_packs_epi16(one, next), 0b11_01_10_00))
        as u32
}

/// # Safety
/// 64 bytes must be readable.
#[inline]
#[target_feature(enable = "avx2")]
unsafe fn load_avx2(list: *const i16) -> (__m256i, __m256i) {
    // SAFETY: the caller's promise.
    unsafe { (_mm256_loadu_si256(list.cast()), _mm256_loadu_si256(list.add(16).cast())) }
}

/// The first row of a plane, and one past the last; not below the first where the plane has no row.
#[inline]
#[target_feature(enable = "avx2")]
pub(crate) fn rows(plane: &VisPlane) -> (i16, i16) {
    let none = _mm256_set1_epi16(i16::MAX);
    let (mut first, mut end) = (none, _mm256_setzero_si256());
    let lists =
        plane.top[plane.first..].chunks_exact(16).zip(plane.bottom[plane.first..].chunks_exact(16));
    // Beyond its last column a plane has no rows.
    for (top, bottom) in lists.take((plane.end - plane.first).div_ceil(16)) {
        // SAFETY: 32 bytes are readable behind both references.
        let [top, bottom] =
            [top, bottom].map(|list| unsafe { _mm256_loadu_si256(list.as_ptr().cast()) });
        first =
            _mm256_min_epi16(first, _mm256_blendv_epi8(none, top, _mm256_cmpgt_epi16(bottom, top)));
        end = _mm256_max_epi16(end, bottom);
    }
    // Of numbers that are not negative there is an instruction for the least of eight.
    let least = |sixteen: __m256i| {
        let eight =
            _mm_min_epi16(_mm256_castsi256_si128(sixteen), _mm256_extracti128_si256(sixteen, 1));
        _mm_cvtsi128_si32(_mm_minpos_epu16(eight)) as i16
    };
    (least(first), i16::MAX - least(_mm256_sub_epi16(none, end)))
}
