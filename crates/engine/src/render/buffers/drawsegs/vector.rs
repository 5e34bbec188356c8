//! Asks eight silhouettes at once whether they have to do with a sprite; the plain twin is in `silhouette`, where a test compares
//! them.

use crate::render::buffers::drawsegs::{MEET_BLOCK, Reaches};
use crate::simd::first_of_eight;
use std::arch::x86_64::*;

/// [`Reaches::meet`] with vectors of 32 bytes.
#[target_feature(enable = "avx2")]
pub(crate) fn meet_avx2(reaches: &Reaches, [first, end]: [u32; 2], inverse: i64, met: &mut [u32]) -> usize {
    let [first, end] = [first, end].map(|column| _mm256_set1_epi32(column as i32));
    let inverse = _mm256_set1_epi64x(inverse);
    let blocks = reaches.firsts.as_chunks::<MEET_BLOCK>().0.iter().zip(reaches.ends.as_chunks::<MEET_BLOCK>().0);
    let blocks = blocks.zip(reaches.nears.as_chunks::<MEET_BLOCK>().0);
    let mut count = 0;
    for (from, ((firsts, ends), nears)) in (0..reaches.count).step_by(MEET_BLOCK).zip(blocks) {
        let (nears, _) = nears.as_chunks::<4>();
        // SAFETY: 32 bytes are readable behind each of these references.
        let (firsts, ends, near, next_near) = unsafe {
            let [firsts, ends] = [firsts, ends].map(|list| _mm256_loadu_si256(list.as_ptr().cast()));
            (firsts, ends, _mm256_loadu_si256(nears[0].as_ptr().cast()), _mm256_loadu_si256(nears[1].as_ptr().cast()))
        };
        let shared = _mm256_and_si256(_mm256_cmpgt_epi32(end, firsts), _mm256_cmpgt_epi32(ends, first));
        let beyond = |nears: __m256i| _mm256_movemask_pd(_mm256_castsi256_pd(_mm256_cmpgt_epi64(inverse, nears)));
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

/// [`Reaches::meet`] with vectors of 64 bytes.
#[target_feature(enable = "avx512f,avx512vl")]
pub(crate) fn meet_avx512(reaches: &Reaches, [first, end]: [u32; 2], inverse: i64, met: &mut [u32]) -> usize {
    let [first, end] = [first, end].map(|column| _mm256_set1_epi32(column as i32));
    let inverse = _mm512_set1_epi64(inverse);
    let mut index = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    let blocks = reaches.firsts.as_chunks::<MEET_BLOCK>().0.iter().zip(reaches.ends.as_chunks::<MEET_BLOCK>().0);
    let blocks = blocks.zip(reaches.nears.as_chunks::<MEET_BLOCK>().0);
    let mut count = 0;
    for (from, ((firsts, ends), nears)) in (0..reaches.count).step_by(MEET_BLOCK).zip(blocks) {
        // SAFETY: 32 bytes are readable behind each of these references, 64 behind the last one.
        let (firsts, ends, nears) = unsafe {
            let [firsts, ends] = [firsts, ends].map(|list| _mm256_loadu_si256(list.as_ptr().cast()));
            (firsts, ends, _mm512_loadu_si512(nears.as_ptr().cast()))
        };
        let meets = _mm256_mask_cmplt_epu32_mask(first_of_eight(reaches.count - from), firsts, end);
        let meets = _mm256_mask_cmpgt_epu32_mask(meets, ends, first);
        let meets = _mm512_mask_cmpge_epi64_mask(meets, nears, inverse);
        let to: &mut [u32; MEET_BLOCK] = met[count..].first_chunk_mut().expect("the list is padded");
        // SAFETY: 32 bytes are writable behind the reference.
        unsafe { _mm256_storeu_si256(to.as_mut_ptr().cast(), _mm256_maskz_compress_epi32(meets, index)) }
        count += meets.count_ones() as usize;
        index = _mm256_add_epi32(index, _mm256_set1_epi32(MEET_BLOCK as i32));
    }
    count
}
