//! Asks eight drawsegs at once with vectors of 32 bytes.

use crate::render::buffers::drawsegs::overlap::reaches::{DrawSegBounds, MEET_BLOCK};
use crate::simd::lookup::first_of_eight;
use std::arch::x86_64::*;

/// [`list`](super::list), eight at once.
#[target_feature(enable = "avx2")]
pub(crate) fn list(
    reaches: &DrawSegBounds,
    [first, end]: [u32; 2],
    inverse: i64,
    met: &mut [u32],
) -> usize {
    let [first, end] = [first, end].map(|column| _mm256_set1_epi32(column as i32));
    let inverse = _mm256_set1_epi64x(inverse);
    let blocks = reaches
        .firsts
        .as_chunks::<MEET_BLOCK>()
        .0
        .iter()
        .zip(reaches.ends.as_chunks::<MEET_BLOCK>().0);
    let blocks = blocks.zip(reaches.nears.as_chunks::<MEET_BLOCK>().0);
    let mut count = 0;
    for (from, ((firsts, ends), nears)) in (0..reaches.count).step_by(MEET_BLOCK).zip(blocks) {
        let (nears, _) = nears.as_chunks::<4>();
        // SAFETY: 32 bytes are readable behind each of these references.
        let (firsts, ends, near, next_near) = unsafe {
            let [firsts, ends] =
                [firsts, ends].map(|list| _mm256_loadu_si256(list.as_ptr().cast()));
            (
                firsts,
                ends,
                _mm256_loadu_si256(nears[0].as_ptr().cast()),
                _mm256_loadu_si256(nears[1].as_ptr().cast()),
            )
        };
        let shared =
            _mm256_and_si256(_mm256_cmpgt_epi32(end, firsts), _mm256_cmpgt_epi32(ends, first));
        let beyond = |nears: __m256i| {
            _mm256_movemask_pd(_mm256_castsi256_pd(_mm256_cmpgt_epi64(inverse, nears)))
        };
        let beyond = beyond(near) | beyond(next_near) << 4;
        let mut meets = _mm256_movemask_ps(_mm256_castsi256_ps(shared)) as u8 & !beyond as u8;
        meets &= first_of_eight(reaches.count - from);
        // Few of many.
        while meets != 0 {
            met[count] = from as u32 + meets.trailing_zeros();
            count += 1;
            meets &= meets - 1;
        }
    }
    count
}
