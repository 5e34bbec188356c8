//! Palette look-ups with vectors of 64 bytes.

use crate::simd::lookup::avx512::{LANES, load, load_table, look_up_block, store};
use std::arch::x86_64::{
    __m512i, _mm512_mask_blend_epi16, _mm512_mask_permutexvar_epi8, _mm512_permutex2var_epi8,
};

#[target_feature(enable = "avx512f,avx512bw,avx512vbmi")]
pub(crate) fn look_up(table: &[u8; 256], indices: &[u8], out: &mut [u8]) -> usize {
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

/// For each of the three output blocks, which lane of red or green (plus 64) goes where, and where
/// blue goes.
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
pub(crate) fn interleaved(tables: &[[u8; 256]; 3], indices: &[u8], out: &mut [u8]) -> usize {
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

/// For each of the four output blocks, which lane of the first or the second (plus 64) of two bytes
/// goes where.
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
pub(crate) fn with_depth(
    tables: &[[u8; 256]; 3],
    indices: &[u8],
    depth: &[u8],
    out: &mut [u8],
) -> usize {
    let tables = load_tables(tables);
    let ((blocks, _), (depths, _)) = (indices.as_chunks::<LANES>(), depth.as_chunks::<LANES>());
    let (out_blocks, _) = out.as_chunks_mut::<LANES>();
    let (fours, _) = out_blocks.as_chunks_mut::<4>();
    for ((four, from), depth) in fours.iter_mut().zip(blocks).zip(depths) {
        let (from, depth) = (load(from), load(depth));
        let [red, green, blue] = look_up_channels(tables, from);
        for (to, pairs) in four.iter_mut().zip(&PAIRS) {
            let pairs = load(pairs);
            let (first, second) = (
                _mm512_permutex2var_epi8(red, pairs, green),
                _mm512_permutex2var_epi8(blue, pairs, depth),
            );
            store(to, _mm512_mask_blend_epi16(0xaaaa_aaaa, first, second));
        }
    }
    blocks.len().min(fours.len()) * LANES
}
