use super::super::panels::Panels;
use super::super::product::tests::noise;
use super::super::product::{
    Axis, Grouped, Left, Right, Size, add_to_overlapping_rows, multiply_grouped, multiply_panels,
    stretches,
};
use super::*;
use std::io::Write;

fn exact(bits: u32) -> f32 {
    f32::from_bits(bits << 16)
}

/// A number's value after rounding, by the definition: the nearest of the two neighbours, the
/// even one of two as near.
fn nearest(value: f32) -> f32 {
    let below = value.to_bits() >> 16;
    let (low, high) = (f64::from(exact(below)), f64::from(exact(below + 1)));
    let (to_low, to_high) = ((f64::from(value) - low).abs(), (high - f64::from(value)).abs());
    let up = to_high < to_low || (to_high == to_low && below % 2 == 1);
    exact(below + u32::from(up))
}

#[test]
fn numbers_are_rounded_to_the_nearest_and_to_even() {
    let mut values = noise(2000, 3);
    values.extend([
        0.0,
        -0.0,
        1.0,
        256.0,
        257.0,
        258.0,
        259.0,
        -257.0,
        1.003_906_3,
        1.011_718_8,
        3e38,
        f32::MIN_POSITIVE,
    ]);
    let mut halves = vec![0; values.len()];
    for kernels in Simd::all() {
        round(kernels, &values, &mut halves);
        for (value, half) in values.iter().zip(&halves) {
            assert_eq!(
                exact((*half).into()).to_bits(),
                nearest(*value).to_bits(),
                "{value} by {kernels}"
            );
        }
        let mut odd = [0; 4];
        round(
            kernels,
            &[f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::from_bits(0x7FFF_FFFF)],
            &mut odd,
        );
        assert_eq!(
            odd[..3],
            [0x7F80, 0xFF80, 0x7F80],
            "infinity stays, and what is nearer to it than to any other becomes it"
        );
        assert!(exact(odd[3].into()).is_nan());
        let pixels: Vec<u8> = (0..=255).chain(0..33).collect();
        let (scale, shift) = (&noise(pixels.len(), 8)[..], &noise(pixels.len(), 9)[..]);
        let mut normalised = vec![0; pixels.len()];
        round_pixels(kernels, &pixels, scale, shift, &mut normalised);
        for (place, half) in normalised.iter().enumerate() {
            let value = (f32::from(pixels[place]) * scale[place] + shift[place]).clamp(-5.0, 5.0);
            assert_eq!(
                exact((*half).into()).to_bits(),
                nearest(value).to_bits(),
                "{value} by {kernels}"
            );
        }
        let mut pairs = vec![0; 16];
        pair_rows(kernels, &values[..16], &values[16..32], &mut pairs);
        for (place, pair) in pairs.iter().enumerate() {
            assert_eq!(*pair, Pair::from(halves[place]) | Pair::from(halves[16 + place]) << 16);
        }
    }
    // 257 lies in the middle between 256 and 258.
    assert_eq!((nearest(257.0), nearest(259.0), nearest(258.0)), (256.0, 260.0, 258.0));
}

/// One number of a product by the definition above: of terms that are walked at once.
fn sum(kernels: Simd, terms: &[(f32, f32)], start: f32) -> f32 {
    let add = |sum: f32, (a, b): &(f32, f32)| nearest(*a).mul_add(nearest(*b), sum);
    if kernels.family() == Family::AmxBf16 {
        return terms.chunks(32).fold(start, |sum, pairs| {
            let firsts = pairs.iter().step_by(2).fold(0.0, add);
            let seconds = pairs.iter().skip(1).step_by(2).fold(0.0, add);
            sum + (firsts + seconds)
        });
    }
    terms
        .chunks(2)
        .fold(start, |sum, pair| add(pair.get(1).map_or(sum, |second| add(sum, second)), &pair[0]))
}

/// The same where more terms are summed than are walked at once.
fn long_sum(kernels: Simd, terms: &[(f32, f32)], start: f32) -> f32 {
    stretches(kernels, terms.len().div_ceil(2)).fold(start, |so_far, (first, pairs)| {
        sum(kernels, &terms[2 * first..(2 * (first + pairs)).min(terms.len())], so_far)
    })
}

/// Bit by bit against the definition; within what sums of 32-bit numbers may lose of the
/// rounded factors' product in 64 bits; and within what 8 bits may lose of the product of the
/// factors themselves.
#[test]
fn products_are_what_is_defined_and_near_those_of_numbers() {
    let cases = [1, 2, 5, 11, 12, 13, 16, 17, 31, 32, 33, 40].into_iter().flat_map(|rows| {
        [(32, 1), (32, 2), (64, 9), (96, 130), (32, 4501)]
            .map(|(columns, inner)| (rows, columns, inner))
    });
    for kernels in bfloat16() {
        for (rows, columns, inner) in cases.clone() {
            let (left, matrix) = (noise(rows * inner, 1), noise(inner * columns, 2));
            let mut panels = Panels::default();
            panels.pack(kernels, &matrix, inner, columns);
            for accumulate in [false, true] {
                let stride = columns + 3;
                let before = noise(rows * stride, 4);
                let mut out = before.clone();
                let factor = Left::rows(&left, inner);
                let size = Size { rows, columns, inner };
                multiply_panels(
                    kernels,
                    size,
                    factor,
                    &panels,
                    &mut out,
                    stride,
                    accumulate,
                    &mut Vec::new(),
                );
                for (row, column) in
                    (0..rows).flat_map(|row| (0..stride).map(move |column| (row, column)))
                {
                    let at = row * stride + column;
                    if column >= columns {
                        assert_eq!(out[at], before[at]);
                        continue;
                    }
                    let start = if accumulate { before[at] } else { 0.0 };
                    let terms: Vec<(f32, f32)> = (0..inner)
                        .map(|k| (left[row * inner + k], matrix[k * columns + column]))
                        .collect();
                    assert_eq!(
                        out[at].to_bits(),
                        long_sum(kernels, &terms, start).to_bits(),
                        "{size:?} row {row} column {column}"
                    );
                    let product = |of: fn(f32) -> f32| -> (f64, f64) {
                        let each =
                            || terms.iter().map(|(a, b)| f64::from(of(*a)) * f64::from(of(*b)));
                        (
                            f64::from(start) + each().sum::<f64>(),
                            f64::from(start.abs()) + each().map(f64::abs).sum::<f64>(),
                        )
                    };
                    let found = f64::from(out[at]);
                    let (rounded, size_of_rounded) = product(nearest);
                    let terms_lost = (inner as f64 + 1.0) * f64::from(f32::EPSILON);
                    assert!(
                        (found - rounded).abs() <= terms_lost * size_of_rounded,
                        "{found} for {rounded}"
                    );
                    let (exact, size_of_exact) = product(|value| value);
                    assert!(
                        (found - exact).abs() <= (2.01 / 256.0 + terms_lost) * size_of_exact,
                        "{found} for {exact}"
                    );
                }
            }
        }
    }
}

/// Rows and inner indices in groups, as a convolution reads an image, and rows that overlap in
/// the result, as its gradient writes it.
#[test]
fn products_in_groups_and_over_overlapping_rows_are_what_is_defined() {
    bfloat16().into_iter().for_each(groups_and_overlapping_rows);
}

fn groups_and_overlapping_rows(kernels: Simd) {
    let (image, columns) = (noise(400, 5), 64);
    let (rows, inner) = (
        Axis { count: 5, stride: 6, groups: 3, group_stride: 80 },
        Axis { count: 4, stride: 2, groups: 3, group_stride: 40 },
    );
    let matrix = noise(24 * columns, 6);
    let mut halves = vec![0; image.len()];
    round(kernels, &image, &mut halves);
    let mut pairs = vec![0; 12 * columns];
    for (k, pairs) in pairs.chunks_exact_mut(columns).enumerate() {
        pair_rows(
            kernels,
            &matrix[2 * k * columns..][..columns],
            &matrix[(2 * k + 1) * columns..][..columns],
            pairs,
        );
    }
    let mut out = vec![f32::NAN; 15 * columns];
    let left = Grouped { data: &halves[..], rows, inner };
    multiply_grouped(
        kernels,
        left,
        Right::rows(&pairs, columns),
        columns,
        &mut out,
        columns,
        false,
    );
    for (row, found) in out.chunks_exact(columns).enumerate() {
        for (column, found) in found.iter().enumerate() {
            let start = row / 5 * 80 + row % 5 * 6;
            let terms: Vec<(f32, f32)> = (0..24)
                .map(|k| (image[start + k / 8 * 40 + k % 8], matrix[k * columns + column]))
                .collect();
            // No pair and no tile joins two groups of the inner dimension.
            let expected = terms.chunks(8).fold(0.0, |so_far, group| sum(kernels, group, so_far));
            assert_eq!(found.to_bits(), expected.to_bits(), "row {row} column {column}, {kernels}");
        }
    }
    let (rows, inner) = (Axis::plain(15, 10), Axis::plain(4, 2));
    let mut out = noise(14 * 32 + columns, 7);
    let mut expected = out.clone();
    add_to_overlapping_rows(
        kernels,
        Grouped { data: &halves[..], rows, inner },
        Right::rows(&pairs, columns),
        columns,
        &mut out,
        32,
    );
    for row in 0..15 {
        for column in 0..columns {
            let terms: Vec<(f32, f32)> =
                (0..8).map(|k| (image[row * 10 + k], matrix[k * columns + column])).collect();
            expected[row * 32 + column] += sum(kernels, &terms, 0.0);
        }
    }
    assert_eq!(out, expected);
}

/// Rows side by side and pairs far apart, as the gradient of weights reads its left factor; more
/// pairs than a tile has, and rows of two tiles.
#[test]
fn products_of_pairs_that_stand_apart_are_what_is_defined() {
    for kernels in bfloat16() {
        let (count, pairs, columns) = (21, 37, 32);
        let (left, matrix) = (noise(2 * count * pairs, 8), noise(2 * pairs * columns, 9));
        let mut halves = vec![0; left.len()];
        round(kernels, &left, &mut halves);
        let mut right = vec![0; pairs * columns];
        for (k, right) in right.chunks_exact_mut(columns).enumerate() {
            let (first, second) = matrix[2 * k * columns..][..2 * columns].split_at(columns);
            pair_rows(kernels, first, second, right);
        }
        let (rows, inner) = (Axis::plain(count, 2), Axis::plain(pairs, 2 * count));
        let factor = Grouped { data: &halves[..], rows, inner };
        let mut out = vec![0.0; count * columns];
        let right = Right::rows(&right, columns);
        multiply_grouped(kernels, factor, right, columns, &mut out, columns, false);
        for (at, found) in out.iter().enumerate() {
            let (row, column) = (at / columns, at % columns);
            let terms: Vec<(f32, f32)> = (0..2 * pairs)
                .map(|k| (left[k / 2 * 2 * count + 2 * row + k % 2], matrix[k * columns + column]))
                .collect();
            assert_eq!(found.to_bits(), sum(kernels, &terms, 0.0).to_bits(), "{kernels}: {at}");
        }
    }
}

/// The families of bfloat16, or a word that this processor has none.
fn bfloat16() -> Vec<Simd> {
    let kernels = Simd::bfloat16();
    if kernels.is_empty() {
        // Past the capture of the test runner: ./check counts it.
        let _ = writeln!(std::io::stderr(), "skipped: this processor has no products in bfloat16");
    }
    kernels
}
