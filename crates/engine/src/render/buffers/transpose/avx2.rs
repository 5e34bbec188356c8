//! Sixteen columns at a time with vectors of 32 bytes.

use std::arch::x86_64::*;

/// Rows that are turned at once; columns are padded to whole groups of as many.
const GROUP: usize = 32;

/// Weaves the bytes of sixteen vectors: four times over, this turns 16 by 16 bytes in each half of
/// the vectors.
#[inline]
#[target_feature(enable = "avx2")]
fn weave(v: &[__m256i; 16]) -> [__m256i; 16] {
    let mut woven = *v;
    for j in 0..8 {
        woven[2 * j] = _mm256_unpacklo_epi8(v[j], v[j + 8]);
        woven[2 * j + 1] = _mm256_unpackhi_epi8(v[j], v[j + 8]);
    }
    woven
}

/// Sixteen columns.
#[inline]
#[target_feature(enable = "avx2")]
pub(crate) fn strip(columns: &[u8], stride: usize, pixels: &mut [u8], width: usize, rows: usize) {
    let (groups, _) = columns.as_chunks::<GROUP>();
    // How many groups a column has, which is how far apart its neighbours' lie.
    let apart = stride / GROUP;
    for first in (0..rows).step_by(GROUP) {
        let groups = &groups[first / GROUP..];
        let mut v = [_mm256_setzero_si256(); 16];
        for (v, bytes) in v.iter_mut().zip(groups.iter().step_by(apart)) {
            // SAFETY: 32 bytes are readable behind the reference.
            *v = unsafe { _mm256_loadu_si256(bytes.as_ptr().cast()) };
        }
        let v = weave(&weave(&weave(&weave(&v))));
        let count = GROUP.min(rows - first);
        let pixels = &mut pixels[first * width..][..(count - 1) * width + 16];
        let mut row = pixels.as_mut_ptr();
        for v in &v[..count.min(16)] {
            // SAFETY: of each of the `count` rows, which are `width` apart, 16 bytes are in the
            // slice.
            unsafe { _mm_storeu_si128(row.cast(), _mm256_castsi256_si128(*v)) }
            row = row.wrapping_add(width);
        }
        for v in &v[..count.max(16) - 16] {
            // SAFETY: as above.
            unsafe { _mm_storeu_si128(row.cast(), _mm256_extracti128_si256(*v, 1)) }
            row = row.wrapping_add(width);
        }
    }
}
