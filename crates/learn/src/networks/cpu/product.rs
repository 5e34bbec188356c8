//! Matrix products: one register tile under all of them.
//!
//! A tile keeps up to 12 rows x 32 columns of the result in registers and walks the inner dimension once. Both factors
//! are read in place through strides, so a convolution is a product whose rows overlap in memory, a weight gradient is
//! a product with rows and inner dimension exchanged, and nothing but weights is ever repacked. On this project's
//! machines a tile runs at over 90 % of what the multiply-add units can do, for all the shapes of the network.
//!
//! The unsafe code stays in this file: [`multiply`] asserts that every address it will touch lies inside its slices,
//! and the tests compare each level with plain loops.

use super::simd::Level;

/// Columns of a tile; widths of results are multiples of it.
pub const PANEL: usize = 32;

/// Left factor: element (row, inner) is `data[row * row_stride + inner * inner_stride]`.
#[derive(Clone, Copy)]
pub struct Left<'a> {
    /// The elements.
    pub data: &'a [f32],
    /// Distance of two rows.
    pub row_stride: usize,
    /// Distance of two inner indices.
    pub inner_stride: usize,
}

/// Right factor: element (inner, 32 panel + column) is `data[panel * panel_stride + inner * inner_stride + column]`.
#[derive(Clone, Copy)]
pub struct Right<'a> {
    /// The elements.
    pub data: &'a [f32],
    /// Distance of two panels of 32 columns.
    pub panel_stride: usize,
    /// Distance of two inner indices.
    pub inner_stride: usize,
}

impl<'a> Right<'a> {
    /// A matrix of `width` columns stored row by row.
    #[must_use]
    pub fn rows(data: &'a [f32], width: usize) -> Right<'a> {
        Right { data, panel_stride: PANEL, inner_stride: width }
    }

    /// A matrix of `inner` rows stored panel after panel, as [`pack`] does.
    #[must_use]
    pub fn panels(data: &'a [f32], inner: usize) -> Right<'a> {
        Right { data, panel_stride: inner * PANEL, inner_stride: PANEL }
    }
}

/// Size of a product: `rows` x `columns`, summed over `inner`.
#[derive(Clone, Copy, Debug)]
pub struct Size {
    /// Rows of the result.
    pub rows: usize,
    /// Columns of the result, a multiple of [`PANEL`].
    pub columns: usize,
    /// Terms of each sum.
    pub inner: usize,
}

/// Bytes of the left factor that stay in the second-level cache while the panels of the right one pass by.
const BLOCK_BYTES: usize = 384 * 1024;

/// `out = left * right`, or `out += left * right`; row `i` of the result starts at `out[i * out_stride]`.
///
/// # Panics
/// If the size reaches outside a slice, or `columns` is no multiple of [`PANEL`].
pub fn multiply(size: Size, left: Left<'_>, right: Right<'_>, out: &mut [f32], out_stride: usize, accumulate: bool) {
    multiply_with(Level::detect(), size, left, right, out, out_stride, accumulate);
}

fn multiply_with(
    level: Level,
    size: Size,
    left: Left<'_>,
    right: Right<'_>,
    out: &mut [f32],
    out_stride: usize,
    accumulate: bool,
) {
    let Size { rows, columns, inner } = size;
    if rows == 0 || columns == 0 || inner == 0 {
        assert!(inner > 0 || accumulate, "an empty sum must be asked for as an accumulation");
        return;
    }
    assert!(columns.is_multiple_of(PANEL), "product of {columns} columns, not a multiple of {PANEL}");
    assert!((rows - 1) * left.row_stride + (inner - 1) * left.inner_stride < left.data.len(), "left factor too short");
    let last_panel = columns / PANEL - 1;
    assert!(
        last_panel * right.panel_stride + (inner - 1) * right.inner_stride + PANEL <= right.data.len(),
        "right factor too short"
    );
    assert!((rows - 1) * out_stride + columns <= out.len() && (rows == 1 || out_stride >= columns), "result too short");
    let tallest = match level {
        Level::Avx512 => 12,
        Level::Avx2 => 3,
        Level::Portable => 4,
    };
    let block = (BLOCK_BYTES / 4 / inner).next_multiple_of(tallest).min(rows);
    let mut first = 0;
    while first < rows {
        let end = (first + block).min(rows);
        for panel in 0..=last_panel {
            let mut row = first;
            while row < end {
                // Tiles of nearly equal height: 16 rows are 8 + 8 rather than 12 + 4, which keeps the units busy.
                let left_rows = end - row;
                let height = left_rows.div_ceil(left_rows.div_ceil(tallest));
                let tile = Tile {
                    inner,
                    row_stride: left.row_stride,
                    left_inner: left.inner_stride,
                    right_inner: right.inner_stride,
                    out_stride,
                    accumulate,
                };
                // SAFETY: the assertions above bound every element of the tile: rows `row..row + height` of the left
                // factor and of the result, panel `panel` of the right factor and of the result, all inner indices.
                // The level was detected on this processor, or is one that it includes.
                unsafe {
                    tile.run(
                        level,
                        height,
                        left.data.as_ptr().add(row * left.row_stride),
                        right.data.as_ptr().add(panel * right.panel_stride),
                        out.as_mut_ptr().add(row * out_stride + panel * PANEL),
                    );
                }
                row += height;
            }
        }
        first = end;
    }
}

/// Strides of a tile.
#[derive(Clone, Copy)]
struct Tile {
    inner: usize,
    row_stride: usize,
    left_inner: usize,
    right_inner: usize,
    out_stride: usize,
    accumulate: bool,
}

impl Tile {
    /// # Safety
    /// All elements of the tile must lie inside the allocations behind the pointers; the processor must have `level`.
    #[inline]
    unsafe fn run(self, level: Level, height: usize, left: *const f32, right: *const f32, out: *mut f32) {
        macro_rules! heights {
            ($function:ident: $($height:literal)*) => {
                match height {
                    // SAFETY: as the caller promised.
                    $($height => unsafe { $function::<$height>(self, left, right, out) },)*
                    _ => unreachable!("tile height"),
                }
            };
        }
        match level {
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => heights!(tile_avx512: 1 2 3 4 5 6 7 8 9 10 11 12),
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => heights!(tile_avx2: 1 2 3),
            _ => heights!(tile_portable: 1 2 3 4),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f")]
unsafe fn tile_avx512<const ROWS: usize>(tile: Tile, mut left: *const f32, mut right: *const f32, out: *mut f32) {
    use std::arch::x86_64::{_mm512_fmadd_ps, _mm512_loadu_ps, _mm512_set1_ps, _mm512_setzero_ps, _mm512_storeu_ps};
    // SAFETY: see `Tile::run`.
    unsafe {
        let mut sums = [[_mm512_setzero_ps(); 2]; ROWS];
        if tile.accumulate {
            for (row, pair) in sums.iter_mut().enumerate() {
                for (half, sum) in pair.iter_mut().enumerate() {
                    *sum = _mm512_loadu_ps(out.add(row * tile.out_stride + 16 * half));
                }
            }
        }
        for _ in 0..tile.inner {
            let low = _mm512_loadu_ps(right);
            let high = _mm512_loadu_ps(right.add(16));
            for (row, pair) in sums.iter_mut().enumerate() {
                let factor = _mm512_set1_ps(*left.add(row * tile.row_stride));
                pair[0] = _mm512_fmadd_ps(factor, low, pair[0]);
                pair[1] = _mm512_fmadd_ps(factor, high, pair[1]);
            }
            left = left.wrapping_add(tile.left_inner);
            right = right.wrapping_add(tile.right_inner);
        }
        for (row, pair) in sums.iter().enumerate() {
            for (half, sum) in pair.iter().enumerate() {
                _mm512_storeu_ps(out.add(row * tile.out_stride + 16 * half), *sum);
            }
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
unsafe fn tile_avx2<const ROWS: usize>(tile: Tile, mut left: *const f32, mut right: *const f32, out: *mut f32) {
    use std::arch::x86_64::{_mm256_fmadd_ps, _mm256_loadu_ps, _mm256_set1_ps, _mm256_setzero_ps, _mm256_storeu_ps};
    // SAFETY: see `Tile::run`.
    unsafe {
        let mut sums = [[_mm256_setzero_ps(); 4]; ROWS];
        if tile.accumulate {
            for (row, quads) in sums.iter_mut().enumerate() {
                for (quarter, sum) in quads.iter_mut().enumerate() {
                    *sum = _mm256_loadu_ps(out.add(row * tile.out_stride + 8 * quarter));
                }
            }
        }
        for _ in 0..tile.inner {
            let mut columns = [_mm256_setzero_ps(); 4];
            for (quarter, column) in columns.iter_mut().enumerate() {
                *column = _mm256_loadu_ps(right.add(8 * quarter));
            }
            for (row, quads) in sums.iter_mut().enumerate() {
                let factor = _mm256_set1_ps(*left.add(row * tile.row_stride));
                for (sum, column) in quads.iter_mut().zip(columns) {
                    *sum = _mm256_fmadd_ps(factor, column, *sum);
                }
            }
            left = left.wrapping_add(tile.left_inner);
            right = right.wrapping_add(tile.right_inner);
        }
        for (row, quads) in sums.iter().enumerate() {
            for (quarter, sum) in quads.iter().enumerate() {
                _mm256_storeu_ps(out.add(row * tile.out_stride + 8 * quarter), *sum);
            }
        }
    }
}

unsafe fn tile_portable<const ROWS: usize>(tile: Tile, mut left: *const f32, mut right: *const f32, out: *mut f32) {
    // SAFETY: see `Tile::run`.
    unsafe {
        let mut sums = [[0.0f32; PANEL]; ROWS];
        if tile.accumulate {
            for (row, sums) in sums.iter_mut().enumerate() {
                *sums = out.add(row * tile.out_stride).cast::<[f32; PANEL]>().read();
            }
        }
        for _ in 0..tile.inner {
            let columns = right.cast::<[f32; PANEL]>().read();
            for (row, sums) in sums.iter_mut().enumerate() {
                let factor = *left.add(row * tile.row_stride);
                for (sum, column) in sums.iter_mut().zip(columns) {
                    *sum += factor * column;
                }
            }
            left = left.wrapping_add(tile.left_inner);
            right = right.wrapping_add(tile.right_inner);
        }
        for (row, sums) in sums.iter().enumerate() {
            out.add(row * tile.out_stride).cast::<[f32; PANEL]>().write(*sums);
        }
    }
}

/// Stores a matrix of `inner` rows and `columns` columns, row by row in `source`, panel after panel in `packed`.
///
/// A panel is read front to back by a tile; row by row the same reads would be kilobytes apart.
pub fn pack(source: &[f32], inner: usize, columns: usize, packed: &mut [f32]) {
    assert!(columns.is_multiple_of(PANEL) && source.len() == inner * columns && packed.len() == source.len());
    for (row, values) in source.chunks_exact(columns).enumerate() {
        for (panel, part) in values.chunks_exact(PANEL).enumerate() {
            let start = (panel * inner + row) * PANEL;
            packed[start..start + PANEL].copy_from_slice(part);
        }
    }
}

/// As [`pack`], of the transpose: `source` has `columns` rows of `inner` columns.
pub fn pack_transposed(source: &[f32], inner: usize, columns: usize, packed: &mut [f32]) {
    assert!(columns.is_multiple_of(PANEL) && source.len() == inner * columns && packed.len() == source.len());
    const BLOCK: usize = 16;
    for (rows, panel) in source.chunks_exact(PANEL * inner).zip(packed.chunks_exact_mut(PANEL * inner)) {
        let mut first = 0;
        while first < inner {
            let end = (first + BLOCK).min(inner);
            for (lane, row) in rows.chunks_exact(inner).enumerate() {
                for index in first..end {
                    panel[index * PANEL + lane] = row[index];
                }
            }
            first = end;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(length: usize, seed: u32) -> Vec<f32> {
        let mut state = seed;
        (0..length)
            .map(|_| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (state >> 8) as f32 / (1 << 23) as f32 - 1.0
            })
            .collect()
    }

    fn levels() -> Vec<Level> {
        match Level::detect() {
            Level::Avx512 => vec![Level::Avx512, Level::Avx2, Level::Portable],
            Level::Avx2 => vec![Level::Avx2, Level::Portable],
            Level::Portable => vec![Level::Portable],
        }
    }

    /// Every level, tile height and way of striding equals plain loops.
    #[test]
    fn products_equal_plain_loops() {
        for level in levels() {
            for rows in [1, 2, 3, 5, 7, 8, 11, 12, 13, 16, 23, 25, 40] {
                for (columns, inner) in [(32, 1), (64, 9), (96, 130)] {
                    let size = Size { rows, columns, inner };
                    // Overlapping rows, as a convolution reads its input.
                    let overlap = noise(rows * 3 + inner, 1);
                    // Rows and inner dimension exchanged, as a weight gradient reads its input.
                    let exchanged = noise(inner * (rows + 2), 2);
                    let matrix = noise(inner * columns, 3);
                    let mut packed = vec![0.0; matrix.len()];
                    pack(&matrix, inner, columns, &mut packed);
                    for (left, right) in [
                        (Left { data: &overlap, row_stride: 3, inner_stride: 1 }, Right::panels(&packed, inner)),
                        (Left { data: &exchanged, row_stride: 1, inner_stride: rows + 2 }, Right::rows(&matrix, columns)),
                    ] {
                        for accumulate in [false, true] {
                            let stride = columns + 4;
                            let before = noise(rows * stride, 4);
                            let mut out = before.clone();
                            multiply_with(level, size, left, right, &mut out, stride, accumulate);
                            for row in 0..rows {
                                for column in 0..stride {
                                    let at = row * stride + column;
                                    let expected = if column >= columns {
                                        f64::from(before[at])
                                    } else {
                                        let start = if accumulate { f64::from(before[at]) } else { 0.0 };
                                        (0..inner).fold(start, |sum, p| {
                                            let a = left.data[row * left.row_stride + p * left.inner_stride];
                                            sum + f64::from(a) * f64::from(matrix[p * columns + column])
                                        })
                                    };
                                    assert!(
                                        (f64::from(out[at]) - expected).abs() < 2e-5,
                                        "{level:?} {size:?} row {row} column {column}: {} against {expected}",
                                        out[at]
                                    );
                                }
                            }
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn transposed_packing_equals_packing_of_the_transpose() {
        let (inner, columns) = (19, 64);
        let matrix = noise(inner * columns, 5);
        let mut transpose = vec![0.0; matrix.len()];
        for row in 0..inner {
            for column in 0..columns {
                transpose[column * inner + row] = matrix[row * columns + column];
            }
        }
        let (mut a, mut b) = (vec![0.0; matrix.len()], vec![0.0; matrix.len()]);
        pack(&matrix, inner, columns, &mut a);
        pack_transposed(&transpose, inner, columns, &mut b);
        assert_eq!(a, b);
    }

    #[test]
    #[should_panic(expected = "left factor too short")]
    fn reaching_outside_a_slice_panics() {
        let size = Size { rows: 4, columns: 32, inner: 8 };
        let (left, right) = (vec![0.0; 31], vec![0.0; 256]);
        let left = Left { data: &left, row_stride: 8, inner_stride: 1 };
        multiply(size, left, Right::panels(&right, 8), &mut [0.0; 128], 32, false);
    }
}
