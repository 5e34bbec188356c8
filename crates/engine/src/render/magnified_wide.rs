//! Tall columns of a wall so near that they show few texels, with 32-byte vectors: those texels are lit once, for as many
//! columns as show them, and the rows pick from them. The plain twin is in `column`, where a test compares them.

use super::column::Column;
use std::arch::x86_64::*;

/// Texels that the rows pick from.
const WINDOW: usize = 32;
/// Windows begin at multiples of this, so that neighbouring columns have the same one.
const START: usize = 4;
/// Rows from which on it is worth the while.
const LEAST_ROWS: usize = 24;
/// Rows that are drawn at once.
const GROUP: usize = 32;

/// A window of a texture's column in some light: of the last tall column of a wall that was drawn so.
#[derive(Default)]
pub(super) struct LitTexels {
    /// Where the texture's column and the light table lie, and the window's first texel; nowhere at first.
    of: (usize, usize, usize),
    texels: [u8; WINDOW],
}

impl LitTexels {
    /// Makes it the window from texel `start` on, a multiple of [`START`].
    fn light(&mut self, texels: &[u8], table: &[u8; 256], start: usize) {
        let of = (texels.as_ptr().addr(), table.as_ptr().addr(), start);
        if self.of == of {
            return;
        }
        self.of = of;
        // Where the texture repeats, a four ends.
        for (i, four) in self.texels.as_chunks_mut::<START>().0.iter_mut().enumerate() {
            let from: &[u8; START] = texels[(start + i * START) & (texels.len() - 1)..].first_chunk().expect("a whole four");
            for (lit, &texel) in four.iter_mut().zip(from) {
                *lit = table[usize::from(texel)];
            }
        }
    }
}

/// Draws rows `top..bottom` of a column of a texture `2^BITS` texels high, if that is done best in this way; returns
/// whether it was.
#[inline]
#[target_feature(enable = "avx2")]
pub(super) fn draw<const BITS: u32>(
    column: &Column,
    lit: &mut LitTexels,
    pixels: &mut [u8],
    rows: &[u32],
    top: usize,
    bottom: usize,
) -> bool {
    if bottom < top + LEAST_ROWS {
        return false;
    }
    // Texels between those of the first and the last row, rounded up.
    let spanned = (u64::from(column.step) * u64::from(rows[bottom - 1] - rows[top])) >> (32 - BITS);
    if spanned + 1 > (WINDOW - START) as u64 {
        return false;
    }
    let first = column.at.wrapping_add(column.step.wrapping_mul(rows[top])) >> (32 - BITS);
    let start = first as usize & !(START - 1);
    lit.light(&column.texels[..1 << BITS], column.table, start);
    let (at, step) = (_mm256_set1_epi32(column.at as i32), _mm256_set1_epi32(column.step as i32));
    let (halves, _) = lit.texels.as_chunks::<16>();
    // SAFETY: 16 bytes are readable behind each reference.
    let half = |i: usize| _mm256_broadcastsi128_si256(unsafe { _mm_loadu_si128(halves[i].as_ptr().cast()) });
    let (low, high) = (half(0), half(1));
    let (shift, start) = (_mm_cvtsi32_si128(32 - BITS as i32), _mm256_set1_epi8(start as i8));
    let (pixels, _) = pixels.as_chunks_mut::<GROUP>();
    let (rows, _) = rows.as_chunks::<GROUP>();
    for group in top / GROUP..bottom.div_ceil(GROUP) {
        let texels = {
            let (eights, _) = rows[group].as_chunks::<8>();
            let position = |eight: &[u32; 8]| {
                // SAFETY: 32 bytes are readable behind the reference.
                let rows = unsafe { _mm256_loadu_si256(eight.as_ptr().cast()) };
                _mm256_srl_epi32(_mm256_add_epi32(at, _mm256_mullo_epi32(step, rows)), shift)
            };
            let low = _mm256_packs_epi32(position(&eights[0]), position(&eights[1]));
            let high = _mm256_packs_epi32(position(&eights[2]), position(&eights[3]));
            // Fours of rows now lie 0, 2, 4, 6, 1, 3, 5, 7.
            let order = _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7);
            _mm256_permutevar8x32_epi32(_mm256_packus_epi16(low, high), order)
        };
        // Rows that are not shown may be beyond the window, and the highest bit of an index would pick nothing.
        let index = _mm256_and_si256(_mm256_sub_epi8(texels, start), _mm256_set1_epi8(WINDOW as i8 - 1));
        let lower = _mm256_shuffle_epi8(low, index);
        let upper = _mm256_shuffle_epi8(high, index);
        let picked = _mm256_blendv_epi8(lower, upper, _mm256_slli_epi16(index, 3));
        let bounded = |row: usize| _mm256_set1_epi8((row as isize - (group * GROUP) as isize).clamp(0, GROUP as isize) as i8);
        // SAFETY: 32 bytes are readable behind the reference.
        let here = unsafe { _mm256_loadu_si256(COUNTED.as_ptr().cast()) };
        let shown = _mm256_andnot_si256(_mm256_cmpgt_epi8(bounded(top), here), _mm256_cmpgt_epi8(bounded(bottom), here));
        let pixels = pixels[group].as_mut_ptr().cast();
        // SAFETY: 32 bytes are readable and writable behind the reference.
        unsafe {
            let before = _mm256_loadu_si256(pixels);
            _mm256_storeu_si256(pixels, _mm256_blendv_epi8(before, picked, shown));
        }
    }
    true
}

/// From 0 to one less than a group.
static COUNTED: [u8; GROUP] = {
    let mut list = [0; GROUP];
    let mut i = 0;
    while i < GROUP {
        list[i] = i as u8;
        i += 1;
    }
    list
};
