//! Matrix products, block by block over the register tile of [`super::tile`].
//!
//! Both factors are read in place through strides, so a convolution is a product whose rows overlap in memory and the
//! gradient of its weights one with rows and inner dimension exchanged. Weights are repacked once an update, and the long
//! factors of the dense layers' gradients on their way ([`super::outer`]). Tiles run at over 90 % of what the multiply-add
//! units can do.
//!
//! [`multiply`] asserts that every address that it will touch lies inside its slices.

use super::simd::{Kernels, Level};
use super::tile::{Ahead, PANEL, Tile, tallest, tiles};

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

    /// A matrix of `inner` rows stored panel after panel, as [`super::pack::pack`] does.
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
/// Longest stretch of the inner dimension that is walked at once: a panel of so many rows stays in the second-level cache, and
/// with short registers, which read it twice as often, nearly in the first.
pub(super) const fn stretch(kernels: Kernels) -> usize {
    match kernels.level() {
        Level::Avx512 => 2048,
        Level::Avx2 | Level::Portable => 512,
    }
}

/// The inner dimension dealt into stretches of nearly equal length, as (first, length).
pub(super) fn stretches(kernels: Kernels, inner: usize) -> impl Iterator<Item = (usize, usize)> {
    let count = inner.div_ceil(stretch(kernels)).max(1);
    let (length, longer) = (inner / count, inner % count);
    (0..count).map(move |part| (part * length + part.min(longer), length + usize::from(part < longer)))
}

/// Rows of the left factor in a block, for a stretch of the inner dimension.
pub(super) fn block_rows(kernels: Kernels, inner: usize) -> usize {
    (BLOCK_BYTES / size_of::<f32>() / inner.clamp(1, stretch(kernels))).next_multiple_of(tallest(kernels))
}

/// `out = left * right`, or `out += left * right`; row `i` of the result starts at `out[i * out_stride]`.
///
/// # Panics
/// If the size reaches outside a slice, or `columns` is no multiple of [`PANEL`].
pub fn multiply(
    kernels: Kernels,
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
    let panels = columns / PANEL;
    assert!(
        (panels - 1) * right.panel_stride + (inner - 1) * right.inner_stride + PANEL <= right.data.len(),
        "right factor too short"
    );
    assert!((rows - 1) * out_stride + columns <= out.len() && (rows == 1 || out_stride >= columns), "result too short");
    for (start, length) in stretches(kernels, inner) {
        let mut tile = Tile {
            inner: length,
            row_stride: left.row_stride,
            left_inner: left.inner_stride,
            right_inner: right.inner_stride,
            out_stride,
            accumulate: accumulate || start > 0,
            next: right.panel_stride,
            ahead: Ahead::Nothing,
        };
        let block = block_rows(kernels, length);
        for first in (0..rows).step_by(block) {
            let block_rows = block.min(rows - first);
            for panel in 0..panels {
                for (row, height) in tiles(kernels, block_rows) {
                    // The last tiles of a panel fetch the next: with few rows, weights come from afar all the time.
                    let is_last = panel + 1 == panels;
                    tile.ahead = if is_last { Ahead::Nothing } else { Ahead::at(row, row + height, block_rows) };
                    let row = first + row;
                    // SAFETY: the assertions above bound every element of the tile: rows `row..row + height` of the left
                    // factor and of the result, panel `panel` of the right factor and of the result, and the inner indices
                    // `start..start + length`.
                    unsafe {
                        tile.run(
                            kernels,
                            height,
                            left.data.as_ptr().add(row * left.row_stride + start * left.inner_stride),
                            right.data.as_ptr().add(panel * right.panel_stride + start * right.inner_stride),
                            out.as_mut_ptr().add(row * out_stride + panel * PANEL),
                        );
                    }
                }
            }
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::pack::pack;
    use super::*;

    /// Numbers between -1 and 1.
    pub fn noise(length: usize, seed: u32) -> Vec<f32> {
        let mut state = seed;
        (0..length)
            .map(|_| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (state >> 8) as f32 / (1 << 23) as f32 - 1.0
            })
            .collect()
    }

    /// Every family, tile height and way of striding equals plain loops.
    #[test]
    fn products_equal_plain_loops() {
        for kernels in Kernels::available() {
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
                            multiply(kernels, size, left, right, &mut out, stride, accumulate);
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
                                        "{kernels} {size:?} row {row} column {column}: {} against {expected}",
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

    /// Longer than any stretch: at 640x480 the first dense layer sums 136,192 terms, at 1280x720 429,312. One column is compared in full, with a
    /// plain sum in twice the precision.
    #[test]
    fn long_products_end_and_equal_plain_sums() {
        for inner in [2049, 98_305, 136_192, 429_312] {
            let (left, right) = (noise(2 * inner, 1), noise(inner * PANEL, 2));
            for kernels in Kernels::available() {
                let mut out = vec![0.0; 2 * PANEL];
                let factor = Left { data: &left, row_stride: inner, inner_stride: 1 };
                multiply(
                    kernels,
                    Size { rows: 2, columns: PANEL, inner },
                    factor,
                    Right::panels(&right, inner),
                    &mut out,
                    PANEL,
                    false,
                );
                for (row, column) in [(0, 0), (1, 31)] {
                    let term = |k: usize| f64::from(left[row * inner + k]) * f64::from(right[k * PANEL + column]);
                    let expected: f64 = (0..inner).map(term).sum();
                    let found = f64::from(out[row * PANEL + column]);
                    assert!((found - expected).abs() < 1e-6 * inner as f64, "{kernels} {inner}: {found}, not {expected}");
                }
            }
        }
    }

    /// The families that fuse multiplication and addition agree bit by bit, and so do any two ways of dealing out rows.
    #[test]
    fn neither_the_width_of_registers_nor_the_number_of_rows_changes_a_bit() {
        let (rows, inner, columns) = (29, 1300, 64);
        let (left, right) = (noise(rows * inner, 1), noise(inner * columns, 2));
        let product = |kernels: Kernels, parts: &[usize]| {
            let mut out = vec![0.0; rows * columns];
            let mut first = 0;
            for &rows in parts {
                let factor = Left { data: &left[first * inner..], row_stride: inner, inner_stride: 1 };
                let size = Size { rows, columns, inner };
                multiply(kernels, size, factor, Right::panels(&right, inner), &mut out[first * columns..], columns, false);
                first += rows;
            }
            out
        };
        let fused: Vec<_> = Kernels::available().into_iter().filter(|&kernels| kernels != Kernels::PORTABLE).collect();
        for &kernels in fused.iter().chain(&[Kernels::PORTABLE]) {
            assert_eq!(product(kernels, &[rows]), product(kernels, &[1, 13, 15]), "{kernels}");
        }
        for pair in fused.windows(2) {
            assert_eq!(product(pair[0], &[rows]), product(pair[1], &[rows]));
        }
    }

    #[test]
    #[should_panic(expected = "left factor too short")]
    fn reaching_outside_a_slice_panics() {
        let size = Size { rows: 4, columns: 32, inner: 8 };
        let (left, right) = (vec![0.0; 31], vec![0.0; 256]);
        let left = Left { data: &left, row_stride: 8, inner_stride: 1 };
        multiply(Kernels::PORTABLE, size, left, Right::panels(&right, 8), &mut [0.0; 128], 32, false);
    }
}
