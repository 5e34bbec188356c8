//! The frame rows of an edge in sixteen columns with vectors of 64 bytes.

use crate::render::blocks::COLUMN_BLOCK;
use crate::render::view::line::{Edge, ROW_BITS};
use crate::render::view::tables::RowScale;
use std::arch::x86_64::*;

/// The frame rows of an edge.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
pub(crate) fn rows(scale: &RowScale, edge: Edge, base: &[u32; COLUMN_BLOCK]) -> __m256i {
    let (at, step) = (_mm512_set1_epi64(edge.at), _mm512_set1_epi64(edge.step));
    let (zero, last) = (_mm512_setzero_si512(), _mm512_set1_epi64(i64::from(scale.last)));
    let (eights, _) = base.as_chunks::<8>();
    let base_rows = |eight: &[u32; 8]| {
        // SAFETY: 32 bytes are readable behind the reference.
        let column = _mm512_cvtepu32_epi64(unsafe { _mm256_loadu_si256(eight.as_ptr().cast()) });
        let row =
            _mm512_srai_epi64(_mm512_add_epi64(at, _mm512_mullo_epi64(step, column)), ROW_BITS);
        _mm512_cvtepi64_epi32(_mm512_min_epi64(_mm512_max_epi64(row, zero), last))
    };
    let base =
        _mm512_inserti32x8(_mm512_castsi256_si512(base_rows(&eights[0])), base_rows(&eights[1]), 1);
    let scaled = _mm512_add_epi32(
        _mm512_mullo_epi32(base, _mm512_set1_epi32(scale.factor)),
        _mm512_set1_epi32(scale.addend),
    );
    _mm512_cvtepi32_epi16(_mm512_srli_epi32(scaled, RowScale::BITS))
}
