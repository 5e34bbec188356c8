//! Turning a picture that lies column by column into one that lies row by row: walls are drawn by
//! columns, floors by rows.

crate::simd::kernel_files!(avx2, avx512);
mod scalar;
mod strip;

use crate::simd::{Simd, dispatch};
use strip::STRIP;

/// Writes the `rows` first bytes of each column, which lie `stride` apart, as rows of `width`
/// bytes.
pub(crate) fn to_rows(
    simd: Simd,
    columns: &[u8],
    stride: usize,
    pixels: &mut [u8],
    width: usize,
    rows: usize,
) {
    let mut first = 0;
    while first + STRIP <= width {
        let strip = &columns[first * stride..(first + STRIP) * stride];
        let done = dispatch!(simd;
            avx512 => { avx512::strip(strip, stride, &mut pixels[first..], width, rows); true },
            avx2 => { avx2::strip(strip, stride, &mut pixels[first..], width, rows); true },
            scalar => { let _ = strip; false },
        );
        if !done {
            break;
        }
        first += STRIP;
    }
    scalar::from(first, columns, stride, pixels, width, rows);
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
                    assert_eq!(
                        pixel,
                        if row < rows { columns[x * stride + row] } else { 7 },
                        "{simd:?}: {x}, {row}"
                    );
                }
            }
        }
    }
}
