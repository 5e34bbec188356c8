//! Pixels of a row of a floor, eight at a time.

use crate::render::planes::row::data::RowWalk;
use std::arch::x86_64::*;

/// Pixels that are worked out at once: whole groups are written, and what lies behind the last
/// pixel is put back.
pub(crate) const ROW_GROUP: usize = 8;

/// Fills `count` pixels as [`RowWalk::draw`] does, from the texels of a square of side `2^BITS` by
/// a light table. As many pixels as a group has must follow. That all is in one function for the
/// caller's instructions, with the texels fetched here, is half of what is gained: most runs are
/// shorter than three groups.
#[inline]
#[target_feature(enable = "avx2")]
pub(crate) fn draw<const BITS: u32, const TEXELS: usize>(
    walk: &RowWalk,
    pixels: &mut [u8],
    count: usize,
    columns: &[u32; ROW_GROUP],
    stride: u32,
    (texels, table): (&[u8; TEXELS], &[u8; 256]),
) {
    const { assert!(TEXELS == 1 << (2 * BITS) && (BITS == 6 || BITS == 7)) }
    let behind: [u8; ROW_GROUP] = *pixels[count..].first_chunk().expect("pixels follow");
    // SAFETY: 32 bytes are readable behind the reference.
    let columns = unsafe { _mm256_loadu_si256(columns.as_ptr().cast()) };
    let start =
        |at: u32, step: u32| _mm256_add_epi32(splat(at), _mm256_mullo_epi32(splat(step), columns));
    let (mut u, mut v) = (start(walk.u, walk.u_step), start(walk.v, walk.v_step));
    let u_stride = splat(walk.u_step.wrapping_mul(stride));
    let v_stride = splat(walk.v_step.wrapping_mul(stride));
    let (groups, _) = pixels[..count.next_multiple_of(ROW_GROUP)].as_chunks_mut::<ROW_GROUP>();
    for group in groups {
        let index = if BITS == 6 {
            _mm256_or_si256(
                _mm256_slli_epi32(_mm256_srli_epi32(u, 26), 6),
                _mm256_srli_epi32(v, 26),
            )
        } else {
            _mm256_or_si256(
                _mm256_slli_epi32(_mm256_srli_epi32(u, 25), 7),
                _mm256_srli_epi32(v, 25),
            )
        };
        (u, v) = (_mm256_add_epi32(u, u_stride), _mm256_add_epi32(v, v_stride));
        let mut indices = [0u32; ROW_GROUP];
        // SAFETY: 32 bytes are writable behind the reference.
        unsafe { _mm256_storeu_si256(indices.as_mut_ptr().cast(), index) };
        for (pixel, index) in group.iter_mut().zip(indices) {
            *pixel = table[usize::from(texels[index as usize & (TEXELS - 1)])];
        }
    }
    pixels[count..count + ROW_GROUP].copy_from_slice(&behind);
}

#[inline]
#[target_feature(enable = "avx2")]
fn splat(number: u32) -> __m256i {
    _mm256_set1_epi32(number as i32)
}
