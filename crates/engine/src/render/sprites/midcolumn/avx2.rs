//! 32 rows of a column of a midtexture 64 or 128 texels high, with vectors of 32 bytes.

use crate::render::sprites::midcolumn::data::MidColumn;
use crate::simd::lookup::avx2::{GROUP, bytes_of, look_up};
use std::arch::x86_64::*;
use std::ops::Range;

/// The last row and the last texel that bytes with a sign hold.
const LAST: i64 = i8::MAX as i64;

/// Whether all numbers of a column fit, of which base rows up to `last_row` are asked: doubles hold
/// its texels' positions exactly.
#[inline]
pub(crate) fn fits(column: &MidColumn, last_row: u32) -> bool {
    let positions = (column.at.unsigned_abs() | column.step.unsigned_abs() << (LAST.ilog2() + 1))
        >> (f64::MANTISSA_DIGITS - 1);
    matches!(column.texels.len(), 64 | 128) && i64::from(last_row) <= LAST && positions == 0
}

/// Gives the frame rows of `rows` that show a texel and their colours to `put`.
#[inline]
#[target_feature(enable = "avx2,fma")]
pub(crate) fn draw(
    column: &MidColumn,
    base_rows: &[u32],
    rows: Range<usize>,
    mut put: impl FnMut(usize, u8),
) {
    let mut row = rows.start;
    while row < rows.end {
        let (colours, mut shown) =
            block(column, base_rows[row..].first_chunk().expect("lists by row are padded"));
        shown &= u32::MAX >> GROUP.saturating_sub(rows.end - row);
        while shown != 0 {
            let i = shown.trailing_zeros() as usize;
            put(row + i, colours[i]);
            shown &= shown - 1;
        }
        row += GROUP;
    }
}

/// The colours of 32 base rows, and a bit for each that shows.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn block(column: &MidColumn, base_rows: &[u32; GROUP]) -> ([u8; GROUP], u32) {
    let (eights, _) = base_rows.as_chunks::<8>();
    let rows = |i: usize| texel_rows(column, &eights[i]);
    let texel_rows = bytes_of([rows(0), rows(1), rows(2), rows(3)]);
    let texels = match column.local_texels.first_chunk::<128>() {
        Some(texels) => look_up(texels, texel_rows),
        None => {
            look_up(column.local_texels.first_chunk::<64>().expect("64 or 128 texels"), texel_rows)
        }
    };
    let lit = match column.lit.len() {
        16 => look_up::<16>(column.lit.first_chunk().expect("as many"), texels),
        64 => look_up::<64>(column.lit.first_chunk().expect("as many"), texels),
        _ => look_up::<256>(column.lit.first_chunk().expect("as many"), texels),
    };
    // SAFETY: 32 bytes are readable behind each reference.
    let base = |i: usize| unsafe { _mm256_loadu_si256(eights[i].as_ptr().cast()) };
    let shown = shown(column, texel_rows, bytes_of([base(0), base(1), base(2), base(3)]));
    let mut colours = [0; GROUP];
    // SAFETY: 32 bytes are writable behind the reference.
    unsafe { _mm256_storeu_si256(colours.as_mut_ptr().cast(), lit) }
    (colours, shown)
}

/// The texture rows of eight base rows.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn texel_rows(column: &MidColumn, base_rows: &[u32; 8]) -> __m256i {
    let (fours, _) = base_rows.as_chunks::<4>();
    let four = |i: usize| {
        const WHOLE: f64 = 1.0 / (1u64 << 32) as f64;
        let in_texels =
            |number: i64| _mm256_mul_pd(_mm256_set1_pd(number as f64), _mm256_set1_pd(WHOLE));
        let (at, step) = (in_texels(column.at), in_texels(column.step));
        // SAFETY: 16 bytes are readable behind the reference.
        let row = _mm256_cvtepi32_pd(unsafe { _mm_loadu_si128(fours[i].as_ptr().cast()) });
        // Towards zero; what is above the first texel counts as it.
        _mm256_cvttpd_epi32(_mm256_fmadd_pd(step, row, at))
    };
    let rows = _mm256_inserti128_si256(_mm256_castsi128_si256(four(0)), four(1), 1);
    let last = _mm256_set1_epi32(column.texels.len() as i32 - 1);
    _mm256_min_epi32(_mm256_max_epi32(rows, _mm256_setzero_si256()), last)
}

/// A bit for each of 32 base rows: whether its texel is in a run that begins there or above.
#[inline]
#[target_feature(enable = "avx2")]
fn shown(column: &MidColumn, texel_rows: __m256i, base_rows: __m256i) -> u32 {
    let splat = |row: i64| _mm256_set1_epi8(row.clamp(-1, LAST) as i8);
    let mut shown = _mm256_setzero_si256();
    for &run in column.runs {
        let [before, last] = run.map(|texel| splat(i64::from(texel) - 1));
        // A byte is as large as rows become: none is at `LAST` or below that begins beyond it.
        let first_row = column.hung.first_row(run);
        let inside = _mm256_andnot_si256(
            _mm256_cmpgt_epi8(texel_rows, last),
            _mm256_cmpgt_epi8(texel_rows, before),
        );
        let begun = _mm256_cmpgt_epi8(base_rows, splat(first_row.saturating_sub(1)));
        shown = _mm256_or_si256(shown, _mm256_and_si256(inside, begun));
    }
    _mm256_movemask_epi8(shown) as u32
}
