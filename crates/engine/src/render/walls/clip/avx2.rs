//! The frame rows of an edge in sixteen columns with vectors of 32 bytes: positions are doubles,
//! which hold them where the edge is exact.

use crate::render::blocks::COLUMN_BLOCK;
use crate::render::view::line::{Edge, ROW_BITS};
use crate::render::view::tables::RowScale;
use std::arch::x86_64::*;

/// The frame rows of an edge that [is exact](Edge::is_exact): of doubles there is a product.
#[inline]
#[target_feature(enable = "avx2")]
pub(crate) fn rows(scale: &RowScale, edge: Edge, base: &[u32; COLUMN_BLOCK]) -> __m256i {
    const LAST_BIT: f64 = 1.0 / (1 << ROW_BITS) as f64;
    let in_rows =
        |number: i64| _mm256_mul_pd(_mm256_set1_pd(number as f64), _mm256_set1_pd(LAST_BIT));
    let (at, step) = (in_rows(edge.at), in_rows(edge.step));
    let (fours, _) = base.as_chunks::<4>();
    let base_rows = |four: &[u32; 4]| {
        // SAFETY: 16 bytes are readable behind the reference.
        let column = _mm256_cvtepi32_pd(unsafe { _mm_loadu_si128(four.as_ptr().cast()) });
        // Towards zero; what is above the first row counts as it.
        _mm256_cvttpd_epi32(_mm256_add_pd(at, _mm256_mul_pd(step, column)))
    };
    let (zero, last) = (_mm256_setzero_si256(), _mm256_set1_epi32(scale.last));
    let (factor, addend) = (_mm256_set1_epi32(scale.factor), _mm256_set1_epi32(scale.addend));
    let frame_rows = |low: __m128i, high: __m128i| {
        let base = _mm256_inserti128_si256(_mm256_castsi128_si256(low), high, 1);
        let base = _mm256_min_epi32(_mm256_max_epi32(base, zero), last);
        _mm256_srli_epi32(
            _mm256_add_epi32(_mm256_mullo_epi32(base, factor), addend),
            RowScale::BITS as i32,
        )
    };
    // Packing works within halves of vectors: 0 and 1, then 2 and 3.
    let even = frame_rows(base_rows(&fours[0]), base_rows(&fours[2]));
    let odd = frame_rows(base_rows(&fours[1]), base_rows(&fours[3]));
    _mm256_packs_epi32(even, odd)
}
