//! 64 rows of a column of a texture with holes, up to 128 texels high: the texels are two or four vectors of words. The
//! plain twin is in `masked_column`, where a test compares them.

use super::convert_wide::{load_table, look_up_block, store};
use super::masked_column::{MASKED_BLOCK, MaskedColumn};
use std::arch::x86_64::*;

/// Most texels of a column.
pub(super) const MOST_TEXELS: usize = 128;

/// The colours of 64 base rows, and a bit for each that shows.
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
pub(super) fn block(column: &MaskedColumn, base_rows: &[u32; MASKED_BLOCK]) -> ([u8; MASKED_BLOCK], u64) {
    let (halves, _) = base_rows.as_chunks::<32>();
    let rows = [texel_rows(column, &halves[0]), texel_rows(column, &halves[1])];
    let [low, high] = rows.map(|rows| look_up(column.texels, rows));
    let shown = [shown(column, rows[0], words(&halves[0])), shown(column, rows[1], words(&halves[1]))];
    let indices = _mm512_inserti64x4(_mm512_castsi256_si512(_mm512_cvtepi16_epi8(low)), _mm512_cvtepi16_epi8(high), 1);
    let mut colours = [0; MASKED_BLOCK];
    store(&mut colours, look_up_block(load_table(column.table), indices));
    (colours, u64::from(shown[0]) | u64::from(shown[1]) << 32)
}

/// The texture rows of 32 base rows, as words.
#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
fn texel_rows(column: &MaskedColumn, base_rows: &[u32; 32]) -> __m512i {
    let (eights, _) = base_rows.as_chunks::<8>();
    let low = _mm256_inserti128_si256(_mm256_castsi128_si256(eight(column, &eights[0])), eight(column, &eights[1]), 1);
    let high = _mm256_inserti128_si256(_mm256_castsi128_si256(eight(column, &eights[2])), eight(column, &eights[3]), 1);
    _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1)
}

#[inline]
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
fn eight(column: &MaskedColumn, base_rows: &[u32; 8]) -> __m128i {
    let row = widened(base_rows);
    let change = _mm512_mullo_epi64(_mm512_set1_epi64(column.step), row);
    let v = _mm512_srai_epi64(_mm512_add_epi64(_mm512_set1_epi64(column.at), change), 32);
    let last = _mm512_set1_epi64(column.texels.len() as i64 - 1);
    _mm512_cvtepi64_epi16(_mm512_max_epi64(_mm512_min_epi64(v, last), _mm512_setzero_si512()))
}

#[inline]
#[target_feature(enable = "avx512f")]
fn widened(base_rows: &[u32; 8]) -> __m512i {
    // SAFETY: 32 bytes are readable behind the reference.
    _mm512_cvtepu32_epi64(unsafe { _mm256_loadu_si256(base_rows.as_ptr().cast()) })
}

/// A bit for each of 32 base rows: whether its texel is in a run that begins there or above.
#[inline]
#[target_feature(enable = "avx512f,avx512bw")]
fn shown(column: &MaskedColumn, texel_rows: __m512i, base_rows: __m512i) -> u32 {
    let splat = |row: i64| _mm512_set1_epi16(row.clamp(0, i64::from(i16::MAX)) as i16);
    column.runs.iter().fold(0, |shown, &run| {
        let [start, end] = run.map(|texel| splat(i64::from(texel)));
        let inside = _mm512_mask_cmplt_epi16_mask(_mm512_cmple_epi16_mask(start, texel_rows), texel_rows, end);
        shown | _mm512_mask_cmple_epi16_mask(inside, splat(column.hung.first_row(run)), base_rows)
    })
}

/// Base rows as words, none of which is the greatest.
#[inline]
#[target_feature(enable = "avx512f")]
fn words(base_rows: &[u32; 32]) -> __m512i {
    // SAFETY: 64 bytes are readable behind each reference.
    let [low, high] = [0, 16].map(|from| unsafe { _mm512_loadu_si512(base_rows[from..].as_ptr().cast()) });
    _mm512_inserti64x4(_mm512_castsi256_si512(_mm512_cvtepi32_epi16(low)), _mm512_cvtepi32_epi16(high), 1)
}

/// What a list of a column has for the texels of 32 rows.
#[inline]
#[target_feature(enable = "avx512f,avx512bw")]
fn look_up(column: &[u16], rows: __m512i) -> __m512i {
    let low = _mm512_permutex2var_epi16(part(column, 0), rows, part(column, 32));
    if column.len() <= 64 {
        return low;
    }
    let high = _mm512_permutex2var_epi16(part(column, 64), rows, part(column, 96));
    _mm512_mask_blend_epi16(_mm512_test_epi16_mask(rows, _mm512_set1_epi16(64)), low, high)
}

/// The texels from `from` on, as many as there are.
#[inline]
#[target_feature(enable = "avx512f,avx512bw")]
fn part(texels: &[u16], from: usize) -> __m512i {
    let texels = &texels[from.min(texels.len())..];
    let there = if texels.len() >= 32 { u32::MAX } else { (1 << texels.len()) - 1 };
    // SAFETY: only the texels that are there are read.
    unsafe { _mm512_maskz_loadu_epi16(there, texels.as_ptr().cast()) }
}
