//! Columns of textures 64 or 128 texels high, many rows at a time; the plain twin is in `column`, where a test compares them.
//!
//! With 64-byte vectors a column of the frame is one vector, the texture one or two, the light table four: nothing is
//! fetched texel by texel. With 32-byte vectors half a column is, and texels are numbers of the picture's own colours (`own_colours`): two small
//! tables in place of one of 256 entries.

use crate::render::blocks::ROW_BLOCK;
use crate::render::lookup::{GROUP, bytes_of, first_bytes, look_up};
use crate::render::output::convert::avx512::{load, load_table, look_up_block};
use crate::render::walls::column::Column;
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
pub(crate) fn avx512<const BITS: u32>(column: &Column, pixels: &mut [u8], rows: &[u32], top: usize, bottom: usize) {
    let (pixels, _) = pixels.as_chunks_mut::<ROW_BLOCK>();
    let (rows, _) = rows.as_chunks::<ROW_BLOCK>();
    let blocks = top / ROW_BLOCK..bottom.div_ceil(ROW_BLOCK);
    for (block, (pixels, rows)) in blocks.clone().zip(pixels[blocks.clone()].iter_mut().zip(&rows[blocks])) {
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
        _mm512_permutex2var_epi8(load(&blocks[0]), _mm512_srli_epi16(positions, 1), load(&blocks[1]))
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

/// A column of a wall whose texels are numbers of its picture's own colours.
pub(crate) struct OwnColumn<'a, const TEXELS: usize, const COLOURS: usize> {
    pub texels: &'a [u8; TEXELS],
    /// These colours in the column's light.
    pub lit: &'a [u8; COLOURS],
    /// As in [`Column`].
    pub at: u32,
    pub step: u32,
}

/// Draws rows `top..bottom` with vectors of 32 bytes: texels and their colours are picked from tables in registers. `pixels` are whole groups.
#[inline]
#[target_feature(enable = "avx2")]
pub(crate) fn avx2<const TEXELS: usize, const COLOURS: usize>(
    column: &OwnColumn<TEXELS, COLOURS>,
    pixels: &mut [u8],
    rows: &[u32],
    top: usize,
    bottom: usize,
) {
    const { assert!(TEXELS == 64 || TEXELS == 128) }
    let (at, step) = (_mm256_set1_epi32(column.at as i32), _mm256_set1_epi32(column.step as i32));
    let mut row = top;
    while row < bottom {
        let start = row.min(pixels.len() - GROUP);
        let group: &[u32; GROUP] = rows[start..].first_chunk().expect("rows are padded");
        let texels = look_up(column.texels, texel_numbers::<TEXELS>(at, step, group));
        let lit = look_up(column.lit, texels);
        let shown = _mm256_andnot_si256(first_bytes(top.saturating_sub(start)), first_bytes(bottom - start));
        let pixels: &mut [u8; GROUP] = pixels[start..].first_chunk_mut().expect("a whole group");
        // SAFETY: 32 bytes are readable and writable behind the reference.
        unsafe {
            let before = _mm256_loadu_si256(pixels.as_ptr().cast());
            _mm256_storeu_si256(pixels.as_mut_ptr().cast(), _mm256_blendv_epi8(before, lit, shown));
        }
        row = start + GROUP;
    }
}

/// Which texels of a column 32 rows show.
#[inline]
#[target_feature(enable = "avx2")]
fn texel_numbers<const TEXELS: usize>(at: __m256i, step: __m256i, rows: &[u32; GROUP]) -> __m256i {
    let (eights, _) = rows.as_chunks::<8>();
    let four = |i: usize| numbers::<TEXELS>(at, step, &eights[i]);
    bytes_of([four(0), four(1), four(2), four(3)])
}

#[inline]
#[target_feature(enable = "avx2")]
fn numbers<const TEXELS: usize>(at: __m256i, step: __m256i, rows: &[u32; 8]) -> __m256i {
    // SAFETY: 32 bytes are readable behind the reference.
    let rows = unsafe { _mm256_loadu_si256(rows.as_ptr().cast()) };
    let position = _mm256_add_epi32(at, _mm256_mullo_epi32(step, rows));
    if TEXELS == 64 { _mm256_srli_epi32(position, 26) } else { _mm256_srli_epi32(position, 25) }
}
