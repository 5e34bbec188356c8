//! Sixteen columns at a time for `narrow`: 256-bit vectors of rows. What differs between the two families is how the
//! 64-bit positions of edges are computed.
//!
//! The functions may only be called where the instructions are; `narrow` does so in functions that are compiled for them.
//! They are inlined there, which is why they are no `unsafe` functions of their own.

use crate::render::blocks::COLUMN_BLOCK;
use crate::render::view::line::{Edge, ROW_BITS};
use crate::render::view::tables::RowScale;
use crate::render::walls::clip::Rows;
use std::arch::x86_64::*;

/// Rows of sixteen columns; `AVX512` has wider vectors for positions.
#[derive(Clone, Copy)]
pub(crate) struct Wide<const AVX512: bool>(__m256i);

/// With vectors of 32 bytes.
pub(crate) type Avx2 = Wide<false>;
/// With vectors of 64 bytes.
pub(crate) type Avx512 = Wide<true>;

/// Sixteen times yes, sixteen times no.
static YES_NO: [i16; 2 * COLUMN_BLOCK] = {
    let mut list = [0; 2 * COLUMN_BLOCK];
    let mut i = 0;
    while i < COLUMN_BLOCK {
        list[i] = -1;
        i += 1;
    }
    list
};

impl<const AVX512: bool> Rows for Wide<AVX512> {
    const COUNT: usize = COLUMN_BLOCK;
    type Block<T> = [T; COLUMN_BLOCK];

    #[inline(always)]
    fn blocks<T>(list: &[T]) -> &[[T; COLUMN_BLOCK]] {
        list.as_chunks().0
    }

    #[inline(always)]
    fn blocks_mut<T>(list: &mut [T]) -> &mut [[T; COLUMN_BLOCK]] {
        list.as_chunks_mut().0
    }

    #[inline(always)]
    fn of_edge(scale: &RowScale, edge: Edge, base: &[u32; COLUMN_BLOCK]) -> Self {
        // SAFETY: the instructions are there, see above.
        Wide(unsafe { if AVX512 { rows_avx512(scale, edge, base) } else { rows_avx2(scale, edge, base) } })
    }

    #[inline(always)]
    fn load(block: &[i16; COLUMN_BLOCK]) -> Self {
        // SAFETY: 32 bytes are readable behind the reference; the instructions are there.
        Wide(unsafe { _mm256_loadu_si256(block.as_ptr().cast()) })
    }

    #[inline(always)]
    fn store(self, block: &mut [i16; COLUMN_BLOCK]) {
        // SAFETY: 32 bytes are writable behind the reference; the instructions are there.
        unsafe { _mm256_storeu_si256(block.as_mut_ptr().cast(), self.0) }
    }

    #[inline(always)]
    fn at_least(self, other: Self) -> Self {
        // SAFETY: the instructions are there, as in all that follow.
        Wide(unsafe { _mm256_max_epi16(self.0, other.0) })
    }

    #[inline(always)]
    fn at_most(self, other: Self) -> Self {
        // SAFETY: as above.
        Wide(unsafe { _mm256_min_epi16(self.0, other.0) })
    }

    #[inline(always)]
    fn is_less(self, than: Self) -> Self {
        // SAFETY: as above.
        Wide(unsafe { _mm256_cmpgt_epi16(than.0, self.0) })
    }

    #[inline(always)]
    fn and(self, other: Self) -> Self {
        // SAFETY: as above.
        Wide(unsafe { _mm256_and_si256(self.0, other.0) })
    }

    #[inline(always)]
    fn and_not(self, other: Self) -> Self {
        // SAFETY: as above.
        Wide(unsafe { _mm256_andnot_si256(other.0, self.0) })
    }

    #[inline(always)]
    fn choose(self, yes: Self, no: Self) -> Self {
        // SAFETY: as above.
        Wide(unsafe { _mm256_blendv_epi8(no.0, yes.0, self.0) })
    }

    #[inline(always)]
    fn any(self) -> bool {
        // SAFETY: as above.
        unsafe { _mm256_testz_si256(self.0, self.0) == 0 }
    }

    #[inline(always)]
    fn bits(self) -> u64 {
        // SAFETY: as above.
        let bits = unsafe {
            let halves = (_mm256_castsi256_si128(self.0), _mm256_extracti128_si256(self.0, 1));
            _mm_movemask_epi8(_mm_packs_epi16(halves.0, halves.1))
        };
        bits as u64
    }

    #[inline(always)]
    fn first(count: usize) -> Self {
        Wide::load(YES_NO[COLUMN_BLOCK - count.min(COLUMN_BLOCK)..].first_chunk().expect("at most a block is left out"))
    }
}

/// The frame rows of an edge that [is exact](Edge::is_exact): of doubles there is a product.
#[inline]
#[target_feature(enable = "avx2")]
fn rows_avx2(scale: &RowScale, edge: Edge, base: &[u32; COLUMN_BLOCK]) -> __m256i {
    const LAST_BIT: f64 = 1.0 / (1 << ROW_BITS) as f64;
    let in_rows = |number: i64| _mm256_mul_pd(_mm256_set1_pd(number as f64), _mm256_set1_pd(LAST_BIT));
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
        _mm256_srli_epi32(_mm256_add_epi32(_mm256_mullo_epi32(base, factor), addend), RowScale::BITS as i32)
    };
    // Packing works within halves of vectors: 0 and 1, then 2 and 3.
    let even = frame_rows(base_rows(&fours[0]), base_rows(&fours[2]));
    let odd = frame_rows(base_rows(&fours[1]), base_rows(&fours[3]));
    _mm256_packs_epi32(even, odd)
}

/// The frame rows of an edge.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
fn rows_avx512(scale: &RowScale, edge: Edge, base: &[u32; COLUMN_BLOCK]) -> __m256i {
    let (at, step) = (_mm512_set1_epi64(edge.at), _mm512_set1_epi64(edge.step));
    let (zero, last) = (_mm512_setzero_si512(), _mm512_set1_epi64(i64::from(scale.last)));
    let (eights, _) = base.as_chunks::<8>();
    let base_rows = |eight: &[u32; 8]| {
        // SAFETY: 32 bytes are readable behind the reference.
        let column = _mm512_cvtepu32_epi64(unsafe { _mm256_loadu_si256(eight.as_ptr().cast()) });
        let row = _mm512_srai_epi64(_mm512_add_epi64(at, _mm512_mullo_epi64(step, column)), ROW_BITS);
        _mm512_cvtepi64_epi32(_mm512_min_epi64(_mm512_max_epi64(row, zero), last))
    };
    let base = _mm512_inserti32x8(_mm512_castsi256_si512(base_rows(&eights[0])), base_rows(&eights[1]), 1);
    let scaled = _mm512_add_epi32(_mm512_mullo_epi32(base, _mm512_set1_epi32(scale.factor)), _mm512_set1_epi32(scale.addend));
    _mm512_cvtepi32_epi16(_mm512_srli_epi32(scaled, RowScale::BITS))
}
