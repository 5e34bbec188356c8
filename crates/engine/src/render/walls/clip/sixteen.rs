//! Rows of sixteen columns in a vector of 32 bytes. What differs between the two families is how
//! the 64-bit positions of edges become rows: `avx2` and `avx512`.
//!
//! The functions may only be called where the instructions are; the dispatch does so in functions
//! that are compiled for them. They are inlined there, which is why they are no `unsafe` functions
//! of their own.

use crate::render::blocks::COLUMN_BLOCK;
use crate::render::view::line::Edge;
use crate::render::view::tables::RowScale;
use crate::render::walls::clip::parts::{Parts, Side};
use crate::render::walls::clip::pass::{ClipLists, clip_by};
use crate::render::walls::clip::rows::Rows;
use crate::render::walls::clip::{avx2, avx512};
use std::arch::x86_64::*;
use std::ops::Range;

/// Rows of sixteen columns; `AVX512` has wider vectors for positions.
#[derive(Clone, Copy)]
pub(crate) struct Wide<const AVX512: bool>(__m256i);

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
        Wide(unsafe {
            if AVX512 { avx512::rows(scale, edge, base) } else { avx2::rows(scale, edge, base) }
        })
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
        Wide::load(
            YES_NO[COLUMN_BLOCK - count.min(COLUMN_BLOCK)..]
                .first_chunk()
                .expect("at most a block is left out"),
        )
    }
}

/// With vectors of 32 bytes.
pub(crate) type Avx2 = Wide<false>;

/// With vectors of 64 bytes.
pub(crate) type Avx512 = Wide<true>;

/// [`clip_by`] compiled for vectors of 32 bytes.
#[target_feature(enable = "avx2")]
pub(crate) fn clip_avx2<S: Side, P: Parts>(
    lists: &mut ClipLists,
    columns: Range<usize>,
    plane: u16,
    edges: [Edge; 2],
) -> bool {
    clip_by::<Avx2, S, P>(lists, columns, plane, edges)
}

/// [`clip_by`] compiled for vectors of 64 bytes.
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
pub(crate) fn clip_avx512<S: Side, P: Parts>(
    lists: &mut ClipLists,
    columns: Range<usize>,
    plane: u16,
    edges: [Edge; 2],
) -> bool {
    clip_by::<Avx512, S, P>(lists, columns, plane, edges)
}
