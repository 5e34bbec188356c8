//! Texture positions four at a time, which the compiler takes apart again unless the vectors are
//! spelt out.

use crate::render::blocks::CHUNK;
use crate::render::planes::row::data::RowWalk;
use std::arch::x86_64::{
    _mm_add_epi32, _mm_cvtsi32_si128, _mm_cvtsi128_si64, _mm_or_si128, _mm_packs_epi32,
    _mm_set_epi32, _mm_set1_epi32, _mm_sll_epi32, _mm_srl_epi32, _mm_unpackhi_epi64,
};

/// Fills whole chunks, the first of which has the given base columns.
#[target_feature(enable = "sse2")]
#[inline]
pub(crate) fn draw_chunks<const BITS: u32>(
    walk: &RowWalk,
    pixels: &mut [u8],
    columns: &[u32; CHUNK],
    stride: u32,
    fetch: impl Fn(usize) -> u8 + Copy,
) {
    let positions = columns.map(|column| walk.at(column));
    let u = |i: usize| positions[i].0 as i32;
    let v = |i: usize| positions[i].1 as i32;
    let mut us = [_mm_set_epi32(u(3), u(2), u(1), u(0)), _mm_set_epi32(u(7), u(6), u(5), u(4))];
    let mut vs = [_mm_set_epi32(v(3), v(2), v(1), v(0)), _mm_set_epi32(v(7), v(6), v(5), v(4))];
    let u_stride = _mm_set1_epi32(walk.u_step.wrapping_mul(stride) as i32);
    let v_stride = _mm_set1_epi32(walk.v_step.wrapping_mul(stride) as i32);
    let (fraction, side) = (_mm_cvtsi32_si128(32 - BITS as i32), _mm_cvtsi32_si128(BITS as i32));
    for chunk in pixels.chunks_exact_mut(CHUNK) {
        let indices = [0, 1].map(|i| {
            let column = _mm_sll_epi32(_mm_srl_epi32(us[i], fraction), side);
            _mm_or_si128(column, _mm_srl_epi32(vs[i], fraction))
        });
        us = us.map(|u| _mm_add_epi32(u, u_stride));
        vs = vs.map(|v| _mm_add_epi32(v, v_stride));
        // Indices are below 2^15, so that signed saturation leaves them alone.
        let packed = _mm_packs_epi32(indices[0], indices[1]);
        let halves =
            [packed, _mm_unpackhi_epi64(packed, packed)].map(|half| _mm_cvtsi128_si64(half) as u64);
        let (low, high) = chunk.split_at_mut(CHUNK / 2);
        for (pixels, half) in [(low, halves[0]), (high, halves[1])] {
            for (i, pixel) in pixels.iter_mut().enumerate() {
                *pixel = fetch(usize::from((half >> (16 * i)) as u16));
            }
        }
    }
}
