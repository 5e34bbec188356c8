//! Palette look-ups with 512-bit vectors, for processors that look up 64 bytes of a 256-byte table at once (AVX-512
//! VBMI: Ice Lake and Zen 4 onward).
//!
//! This file is `unsafe` because vector loads and stores take pointers, and because these functions must not run on a
//! processor without the instructions. The first is confined to [`load`] and [`store`], which take references to whole
//! 64-byte arrays; the second to [`Wide::of`], the only way to get a [`Wide`]. The plain twins are in `convert`,
//! where a test compares them.

use crate::simd::{Level, Simd};
use std::arch::x86_64::{
    __m512i, _mm512_loadu_si512, _mm512_mask_blend_epi8, _mm512_mask_blend_epi16, _mm512_mask_permutexvar_epi8,
    _mm512_movepi8_mask, _mm512_permutex2var_epi8, _mm512_storeu_si512,
};

/// Proof that the processor has the instructions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wide(());

/// Bytes that are looked up at once.
const LANES: usize = 64;

impl Wide {
    /// Whether these instructions are to be used; whoever has such a [`Simd`] asked the processor.
    pub fn of(simd: Simd) -> Option<Wide> {
        (simd.level() == Level::Avx512).then_some(Wide(()))
    }

    /// Looks up whole blocks of 64 indices; returns how many indices that were.
    pub fn look_up(self, table: &[u8; 256], indices: &[u8], out: &mut [u8]) -> usize {
        // SAFETY: a `Wide` exists only where the instructions do.
        unsafe { look_up(table, indices, out) }
    }

    /// Looks up whole blocks of 64 indices in three tables and writes the results in turn; returns how many indices
    /// that were.
    pub fn interleaved(self, tables: &[[u8; 256]; 3], indices: &[u8], out: &mut [u8]) -> usize {
        // SAFETY: a `Wide` exists only where the instructions do.
        unsafe { interleaved(tables, indices, out) }
    }

    /// The same with a fourth byte of its own a pixel.
    pub fn with_depth(self, tables: &[[u8; 256]; 3], indices: &[u8], depth: &[u8], out: &mut [u8]) -> usize {
        // SAFETY: a `Wide` exists only where the instructions do.
        unsafe { with_depth(tables, indices, depth, out) }
    }
}

#[inline]
#[target_feature(enable = "avx512f")]
pub(crate) fn load(bytes: &[u8; LANES]) -> __m512i {
    // SAFETY: 64 bytes are readable behind a reference to 64 bytes; the load needs no alignment.
    unsafe { _mm512_loadu_si512(bytes.as_ptr().cast()) }
}

#[inline]
#[target_feature(enable = "avx512f")]
pub(crate) fn store(bytes: &mut [u8; LANES], vector: __m512i) {
    // SAFETY: 64 bytes are writable behind a reference to 64 bytes; the store needs no alignment.
    unsafe { _mm512_storeu_si512(bytes.as_mut_ptr().cast(), vector) }
}

/// A table of 256 bytes in registers.
#[inline]
#[target_feature(enable = "avx512f")]
pub(crate) fn load_table(table: &[u8; 256]) -> [__m512i; 4] {
    let (blocks, _) = table.as_chunks::<LANES>();
    [load(&blocks[0]), load(&blocks[1]), load(&blocks[2]), load(&blocks[3])]
}

#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512vbmi")]
pub(crate) fn look_up_block(table: [__m512i; 4], indices: __m512i) -> __m512i {
    // Each permutation looks at the lower 7 bits and covers one half of the table; the highest bit chooses between them.
    let low = _mm512_permutex2var_epi8(table[0], indices, table[1]);
    let high = _mm512_permutex2var_epi8(table[2], indices, table[3]);
    _mm512_mask_blend_epi8(_mm512_movepi8_mask(indices), low, high)
}

#[target_feature(enable = "avx512f,avx512bw,avx512vbmi")]
fn look_up(table: &[u8; 256], indices: &[u8], out: &mut [u8]) -> usize {
    let table = load_table(table);
    let (blocks, _) = indices.as_chunks::<LANES>();
    let (out_blocks, _) = out.as_chunks_mut::<LANES>();
    for (to, from) in out_blocks.iter_mut().zip(blocks) {
        store(to, look_up_block(table, load(from)));
    }
    blocks.len().min(out_blocks.len()) * LANES
}

/// Three tables in registers.
#[inline]
#[target_feature(enable = "avx512f")]
fn load_tables([red, green, blue]: &[[u8; 256]; 3]) -> [[__m512i; 4]; 3] {
    [load_table(red), load_table(green), load_table(blue)]
}

/// What each of three tables has for 64 indices.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512vbmi")]
fn look_up_channels([red, green, blue]: [[__m512i; 4]; 3], indices: __m512i) -> [__m512i; 3] {
    [look_up_block(red, indices), look_up_block(green, indices), look_up_block(blue, indices)]
}

/// For each of the three output blocks, which lane of red or green (plus 64) goes where, and where blue goes.
const WEAVE: [([u8; LANES], u64, [u8; LANES]); 3] = {
    let mut weave = [([0; LANES], 0, [0; LANES]); 3];
    let mut at = 0;
    while at < 3 * LANES {
        let (block, lane, pixel) = (at / LANES, at % LANES, (at / 3) as u8);
        match at % 3 {
            0 => weave[block].0[lane] = pixel,
            1 => weave[block].0[lane] = pixel + LANES as u8,
            _ => {
                weave[block].1 |= 1 << lane;
                weave[block].2[lane] = pixel;
            }
        }
        at += 1;
    }
    weave
};

#[target_feature(enable = "avx512f,avx512bw,avx512vbmi")]
fn interleaved(tables: &[[u8; 256]; 3], indices: &[u8], out: &mut [u8]) -> usize {
    let tables = load_tables(tables);
    let (blocks, _) = indices.as_chunks::<LANES>();
    let (out_blocks, _) = out.as_chunks_mut::<LANES>();
    let (triples, _) = out_blocks.as_chunks_mut::<3>();
    for (triple, from) in triples.iter_mut().zip(blocks) {
        let from = load(from);
        let [red, green, blue] = look_up_channels(tables, from);
        for (to, (red_green, blue_lanes, blue_from)) in triple.iter_mut().zip(&WEAVE) {
            let woven = _mm512_permutex2var_epi8(red, load(red_green), green);
            store(to, _mm512_mask_permutexvar_epi8(woven, *blue_lanes, load(blue_from), blue));
        }
    }
    blocks.len().min(triples.len()) * LANES
}

/// For each of the four output blocks, which lane of the first or the second (plus 64) of two bytes goes where.
const PAIRS: [[u8; LANES]; 4] = {
    let mut pairs = [[0; LANES]; 4];
    let mut at = 0;
    while at < 4 * LANES {
        pairs[at / LANES][at % LANES] = (at / 4 + at % 2 * LANES) as u8;
        at += 1;
    }
    pairs
};

#[target_feature(enable = "avx512f,avx512bw,avx512vbmi")]
fn with_depth(tables: &[[u8; 256]; 3], indices: &[u8], depth: &[u8], out: &mut [u8]) -> usize {
    let tables = load_tables(tables);
    let ((blocks, _), (depths, _)) = (indices.as_chunks::<LANES>(), depth.as_chunks::<LANES>());
    let (out_blocks, _) = out.as_chunks_mut::<LANES>();
    let (fours, _) = out_blocks.as_chunks_mut::<4>();
    for ((four, from), depth) in fours.iter_mut().zip(blocks).zip(depths) {
        let (from, depth) = (load(from), load(depth));
        let [red, green, blue] = look_up_channels(tables, from);
        for (to, pairs) in four.iter_mut().zip(&PAIRS) {
            let pairs = load(pairs);
            let (first, second) = (_mm512_permutex2var_epi8(red, pairs, green), _mm512_permutex2var_epi8(blue, pairs, depth));
            store(to, _mm512_mask_blend_epi16(0xaaaa_aaaa, first, second));
        }
    }
    blocks.len().min(fours.len()) * LANES
}
