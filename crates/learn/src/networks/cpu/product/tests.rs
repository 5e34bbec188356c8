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
    for kernels in Simd::available() {
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
                    (
                        Left { data: &overlap, row_stride: 3, inner_stride: 1 },
                        Right::panels(&packed, inner),
                    ),
                    (
                        Left { data: &exchanged, row_stride: 1, inner_stride: rows + 2 },
                        Right::rows(&matrix, columns),
                    ),
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
                                    let start =
                                        if accumulate { f64::from(before[at]) } else { 0.0 };
                                    (0..inner).fold(start, |sum, p| {
                                        let a = left.data
                                            [row * left.row_stride + p * left.inner_stride];
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

/// Longer than any stretch: at 640x480 the first dense layer sums 136,192 terms, at 1280x720
/// 429,312. One column is compared in full, with a plain sum in twice the precision.
#[test]
fn long_products_end_and_equal_plain_sums() {
    for inner in [2049, 98_305, 136_192, 429_312] {
        let (left, right) = (noise(2 * inner, 1), noise(inner * PANEL, 2));
        for kernels in Simd::available() {
            let mut out = vec![0.0; 2 * PANEL];
            let factor = Left::rows(&left, inner);
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
                let term = |k: usize| {
                    f64::from(left[row * inner + k]) * f64::from(right[k * PANEL + column])
                };
                let expected: f64 = (0..inner).map(term).sum();
                let found = f64::from(out[row * PANEL + column]);
                assert!(
                    (found - expected).abs() < 1e-6 * inner as f64,
                    "{kernels} {inner}: {found}, not {expected}"
                );
            }
        }
    }
}

/// The families that fuse multiplication and addition agree bit by bit, and so do any two ways
/// of dealing out rows.
#[test]
fn neither_the_width_of_registers_nor_the_number_of_rows_changes_a_bit() {
    let (rows, inner, columns) = (29, 1300, 64);
    let (left, right) = (noise(rows * inner, 1), noise(inner * columns, 2));
    let product = |kernels: Simd, parts: &[usize]| {
        let mut out = vec![0.0; rows * columns];
        let mut first = 0;
        for &rows in parts {
            let factor = Left::rows(&left[first * inner..], inner);
            let size = Size { rows, columns, inner };
            multiply(
                kernels,
                size,
                factor,
                Right::panels(&right, inner),
                &mut out[first * columns..],
                columns,
                false,
            );
            first += rows;
        }
        out
    };
    let fused: Vec<_> =
        Simd::available().into_iter().filter(|&kernels| kernels != Simd::PLAIN).collect();
    for &kernels in fused.iter().chain(&[Simd::PLAIN]) {
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
    multiply(Simd::PLAIN, size, left, Right::panels(&right, 8), &mut [0.0; 128], 32, false);
}
