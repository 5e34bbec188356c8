//! Texels of a row of a floor, sixteen at a time.

use crate::render::planes::row::data::RowWalk;
use std::arch::x86_64::*;

/// Pixels of a vector of 64 bytes.
pub(crate) const ROW_VECTOR: usize = 16;

/// Fetches the texels of sixteen pixels, without their light.
#[inline]
#[target_feature(enable = "avx512f")]
pub(crate) fn fetch<const BITS: u32, const TEXELS: usize>(
    walk: &RowWalk,
    unlit: &mut [u8; ROW_VECTOR],
    columns: &[u32; ROW_VECTOR],
    texels: &[u8; TEXELS],
) {
    const { assert!(TEXELS == 1 << (2 * BITS) && (BITS == 6 || BITS == 7)) }
    let splat = |number: u32| _mm512_set1_epi32(number as i32);
    // SAFETY: 64 bytes are readable behind the reference.
    let columns = unsafe { _mm512_loadu_si512(columns.as_ptr().cast()) };
    let at =
        |at: u32, step: u32| _mm512_add_epi32(splat(at), _mm512_mullo_epi32(splat(step), columns));
    let (u, v) = (at(walk.u, walk.u_step), at(walk.v, walk.v_step));
    let index = if BITS == 6 {
        _mm512_or_si512(_mm512_slli_epi32(_mm512_srli_epi32(u, 26), 6), _mm512_srli_epi32(v, 26))
    } else {
        _mm512_or_si512(_mm512_slli_epi32(_mm512_srli_epi32(u, 25), 7), _mm512_srli_epi32(v, 25))
    };
    let mut indices = [0u32; ROW_VECTOR];
    // SAFETY: 64 bytes are writable behind the reference.
    unsafe { _mm512_storeu_si512(indices.as_mut_ptr().cast(), index) }
    for (texel, index) in unlit.iter_mut().zip(indices) {
        *texel = texels[index as usize & (TEXELS - 1)];
    }
}
