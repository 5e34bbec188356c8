//! Columns of textures 64 or 128 texels high, 32 rows at a time: texels are numbers of the
//! picture's own colours, so that two small tables stand in for one of 256 entries.

use crate::render::walls::column::data::IndexedColumn;
use crate::simd::lookup::avx2::{GROUP, bytes_of, first_bytes, look_up};
use std::arch::x86_64::*;

/// Draws rows `top..bottom` with vectors of 32 bytes: texels and their colours are picked from
/// tables in registers. `pixels` are whole groups.
#[inline]
#[target_feature(enable = "avx2")]
pub(crate) fn draw<const TEXELS: usize, const COLOURS: usize>(
    column: &IndexedColumn<TEXELS, COLOURS>,
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
        let shown = _mm256_andnot_si256(
            first_bytes(top.saturating_sub(start)),
            first_bytes(bottom - start),
        );
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

/// A column whose picture has few colours, made ready here: for tests, on a processor that has the
/// instructions.
#[cfg(test)]
pub(super) fn draw_by_own_colours(
    column: &super::data::Column,
    pixels: &mut [u8],
    rows: &[u32],
    top: usize,
    bottom: usize,
) {
    use super::data::IndexedColumn;
    use crate::render::textures::local_palette::LocalPalette;
    let own = LocalPalette::new(column.texels, &[*column.table]);
    macro_rules! draw {
        ($texels:literal, $colours:literal) => {{
            let (texels, lit) =
                (own.texels.first_chunk().unwrap(), own.lit(0).first_chunk().unwrap());
            let column = IndexedColumn::<$texels, $colours> {
                texels,
                lit,
                at: column.at,
                step: column.step,
            };
            // SAFETY: the processor has the instructions.
            unsafe { draw(&column, pixels, rows, top, bottom) }
        }};
    }
    match (own.texels.len(), own.room) {
        (64, 16) => draw!(64, 16),
        (64, 64) => draw!(64, 64),
        (64, _) => draw!(64, 256),
        (_, 16) => draw!(128, 16),
        (_, 64) => draw!(128, 64),
        _ => draw!(128, 256),
    }
}
