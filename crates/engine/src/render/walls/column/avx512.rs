//! Columns of textures 64 or 128 texels high, 64 rows at a time: a column of the frame is one
//! vector, the texture one or two, the light table four: nothing is fetched texel by texel.

use crate::render::blocks::ROW_BLOCK;
use crate::render::walls::column::data::Column;
use crate::simd::lookup::avx512::{load, load_table, look_up_block};
use std::arch::x86_64::*;

/// The highest byte of each of sixteen numbers, twice.
static HIGHEST_BYTES: [u8; 64] = {
    let mut pick = [0; 64];
    let mut lane = 0;
    while lane < 64 {
        pick[lane] = 4 * (lane as u8 % 32) + 3;
        lane += 1;
    }
    pick
};

/// Draws rows `top..bottom` of a column of a texture `2^BITS` texels high.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
pub(crate) fn draw<const BITS: u32>(
    column: &Column,
    pixels: &mut [u8],
    rows: &[u32],
    top: usize,
    bottom: usize,
) {
    let (pixels, _) = pixels.as_chunks_mut::<ROW_BLOCK>();
    let (rows, _) = rows.as_chunks::<ROW_BLOCK>();
    let blocks = top / ROW_BLOCK..bottom.div_ceil(ROW_BLOCK);
    for (block, (pixels, rows)) in
        blocks.clone().zip(pixels[blocks.clone()].iter_mut().zip(&rows[blocks]))
    {
        let texels = texels_avx512::<BITS>(column, rows);
        let lit = look_up_block(load_table(column.table), texels);
        let above = top.saturating_sub(block * ROW_BLOCK);
        let below = ((block + 1) * ROW_BLOCK).saturating_sub(bottom);
        let mask = (u64::MAX << above) & (u64::MAX >> below);
        // SAFETY: 64 bytes are writable behind the reference.
        unsafe { _mm512_mask_storeu_epi8(pixels.as_mut_ptr().cast(), mask, lit) }
    }
}

/// The texels of 64 rows.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
fn texels_avx512<const BITS: u32>(column: &Column, rows: &[u32; ROW_BLOCK]) -> __m512i {
    let positions = highest_bytes(column.at, column.step, rows);
    // Bits that a byte gets from its neighbour are above those that the permutations look at.
    let (blocks, _) = column.texels.as_chunks::<64>();
    if BITS == 7 {
        _mm512_permutex2var_epi8(
            load(&blocks[0]),
            _mm512_srli_epi16(positions, 1),
            load(&blocks[1]),
        )
    } else {
        _mm512_permutexvar_epi8(_mm512_srli_epi16(positions, 2), load(&blocks[0]))
    }
}

/// The highest byte of the texture positions of 64 rows.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512vbmi")]
pub(crate) fn highest_bytes(at: u32, step: u32, rows: &[u32; ROW_BLOCK]) -> __m512i {
    let (at, step) = (_mm512_set1_epi32(at as i32), _mm512_set1_epi32(step as i32));
    let (quarters, _) = rows.as_chunks::<16>();
    let positions = |quarter: usize| {
        // SAFETY: 64 bytes are readable behind the reference.
        let rows = unsafe { _mm512_loadu_si512(quarters[quarter].as_ptr().cast()) };
        _mm512_add_epi32(at, _mm512_mullo_epi32(step, rows))
    };
    let pick = load(&HIGHEST_BYTES);
    let low = _mm512_permutex2var_epi8(positions(0), pick, positions(1));
    let high = _mm512_permutex2var_epi8(positions(2), pick, positions(3));
    _mm512_mask_blend_epi8(0xFFFF_FFFF_0000_0000, low, high)
}
