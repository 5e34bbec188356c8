//! Turning a picture that lies column by column into one that lies row by row, and back: walls are drawn by columns, floors
//! by rows.

#[cfg(target_arch = "x86_64")]
use crate::simd::Level;
use crate::simd::Simd;

/// Columns that are turned together, so that the lines of their rows stay near.
const STRIP: usize = 16;

/// Writes the `rows` first bytes of each column, which lie `stride` apart, as rows of `width` bytes.
pub(crate) fn to_rows(simd: Simd, columns: &[u8], stride: usize, pixels: &mut [u8], width: usize, rows: usize) {
    let mut first = 0;
    #[cfg(target_arch = "x86_64")]
    if simd != Simd::PLAIN {
        while first + STRIP <= width {
            let strip = &columns[first * stride..(first + STRIP) * stride];
            let pixels = &mut pixels[first..];
            match simd.level() {
                // SAFETY: whoever has this `Simd` has the instructions.
                Level::Avx512 => unsafe { wide::strip_avx512(strip, stride, pixels, width, rows) },
                // SAFETY: as above.
                _ => unsafe { wide::strip(strip, stride, pixels, width, rows) },
            }
            first += STRIP;
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = simd;
    while first + SQUARE <= width {
        for row in (0..rows).step_by(SQUARE) {
            let square =
                turn_square(std::array::from_fn(|i| *columns[(first + i) * stride + row..].first_chunk().expect("padded")));
            let lines = pixels.chunks_exact_mut(width).skip(row).take(SQUARE.min(rows - row));
            for (line, bytes) in lines.zip(square) {
                line[first..first + SQUARE].copy_from_slice(&bytes);
            }
        }
        first += SQUARE;
    }
    while first < width {
        let end = (first + STRIP).min(width);
        for (row, line) in pixels.chunks_exact_mut(width).take(rows).enumerate() {
            for x in first..end {
                line[x] = columns[x * stride + row];
            }
        }
        first = end;
    }
}

/// Side of the squares that are turned without vectors.
const SQUARE: usize = 8;

/// Turns eight columns of eight bytes into rows: swaps single bytes across the diagonals of squares of two, then pairs in
/// squares of four, then halves.
fn turn_square(columns: [[u8; SQUARE]; SQUARE]) -> [[u8; SQUARE]; SQUARE] {
    let mut lines = columns.map(u64::from_le_bytes);
    for (apart, mask) in [(1, 0x00FF_00FF_00FF_00FF), (2, 0x0000_FFFF_0000_FFFF), (4, 0x0000_0000_FFFF_FFFF)] {
        for i in (0..SQUARE).filter(|i| i & apart == 0) {
            let swapped = ((lines[i] >> (8 * apart)) ^ lines[i + apart]) & mask;
            lines[i] ^= swapped << (8 * apart);
            lines[i + apart] ^= swapped;
        }
    }
    lines.map(u64::to_le_bytes)
}

#[cfg(target_arch = "x86_64")]
mod wide {
    use std::arch::x86_64::*;

    /// Rows that are turned at once; columns are padded to whole groups of as many.
    const GROUP: usize = 32;

    /// Weaves the bytes of sixteen vectors: four times over, this turns 16 by 16 bytes in each half of the vectors.
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
                // SAFETY: of each of the `count` rows, which are `width` apart, 16 bytes are in the slice.
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

    /// The same where there are twice as many registers.
    #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
    pub(crate) fn strip_avx512(columns: &[u8], stride: usize, pixels: &mut [u8], width: usize, rows: usize) {
        strip(columns, stride, pixels, width, rows);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rng;

    #[test]
    fn every_byte_comes_to_its_row() {
        let mut rng = Rng::new(8);
        for (width, rows) in [(128, 60), (160, 100), (100, 50), (640, 403), (16, 1)] {
            let stride = usize::next_multiple_of(rows, 64);
            let columns: Vec<u8> = (0..width * stride).map(|_| rng.byte() as u8).collect();
            for simd in Simd::available() {
                let mut pixels = vec![7; width * (rows + 2)];
                to_rows(simd, &columns, stride, &mut pixels, width, rows);
                for (at, &pixel) in pixels.iter().enumerate() {
                    let (x, row) = (at % width, at / width);
                    assert_eq!(pixel, if row < rows { columns[x * stride + row] } else { 7 }, "{simd:?}: {x}, {row}");
                }
            }
        }
    }
}
