//! Asks eight drawsegs at once with vectors of 64 bytes.

use crate::render::buffers::drawsegs::overlap::reaches::{DrawSegBounds, MEET_BLOCK};
use crate::simd::lookup::first_of_eight;
use std::arch::x86_64::*;

/// [`list`](super::list), eight at once.
#[target_feature(enable = "avx512f,avx512vl")]
pub(crate) fn list(
    reaches: &DrawSegBounds,
    [first, end]: [u32; 2],
    inverse: i64,
    met: &mut [u32],
) -> usize {
    let [first, end] = [first, end].map(|column| _mm256_set1_epi32(column as i32));
    let inverse = _mm512_set1_epi64(inverse);
    let mut index = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    let blocks = reaches
        .firsts
        .as_chunks::<MEET_BLOCK>()
        .0
        .iter()
        .zip(reaches.ends.as_chunks::<MEET_BLOCK>().0);
    let blocks = blocks.zip(reaches.nears.as_chunks::<MEET_BLOCK>().0);
    let mut count = 0;
    for (from, ((firsts, ends), nears)) in (0..reaches.count).step_by(MEET_BLOCK).zip(blocks) {
        // SAFETY: 32 bytes are readable behind each of these references, 64 behind the last one.
        let (firsts, ends, nears) = unsafe {
            let [firsts, ends] =
                [firsts, ends].map(|list| _mm256_loadu_si256(list.as_ptr().cast()));
            (firsts, ends, _mm512_loadu_si512(nears.as_ptr().cast()))
        };
        let meets = _mm256_mask_cmplt_epu32_mask(first_of_eight(reaches.count - from), firsts, end);
        let meets = _mm256_mask_cmpgt_epu32_mask(meets, ends, first);
        let meets = _mm512_mask_cmpge_epi64_mask(meets, nears, inverse);
        let to: &mut [u32; MEET_BLOCK] =
            met[count..].first_chunk_mut().expect("the list is padded");
        // SAFETY: 32 bytes are writable behind the reference.
        unsafe {
            _mm256_storeu_si256(to.as_mut_ptr().cast(), _mm256_maskz_compress_epi32(meets, index))
        }
        count += meets.count_ones() as usize;
        index = _mm256_add_epi32(index, _mm256_set1_epi32(MEET_BLOCK as i32));
    }
    count
}
