//! Products in bfloat16: both factors are rounded to the upper 16 bits of a 32-bit number, to the
//! nearest and to even ones where two are as near; sums are numbers of 32 bits.
//!
//! An inner index stands for a pair of terms. A sum goes on pair by pair, in each by the second
//! term and then by the first, and each of the two is one fused multiplication and addition. That
//! is what `vdpbf16ps` is documented to do; a numeral below 2^-126 counts as zero, in factors and
//! in sums. So bits are equal on all processors that have it, and equal to those of plain fused
//! arithmetic wherever no such number occurs.
//!
//! What is rounded is what a product reads: weights, activations and gradients themselves stay
//! numbers of 32 bits, and all other arithmetic is that of the other families.

use hasard_engine::simd::{Family, Simd};

use crate::networks::cpu::tile::Tile;
use crate::networks::cpu::vectorised::vectorised;

/// Two numbers of 16 bits, the first one in the lower half.
pub type Pair = u32;

/// The bits of a number rounded to its upper 16; those below are to be cut off.
#[inline(always)]
fn rounded(value: f32) -> u32 {
    let bits = value.to_bits();
    // What is no number stays none, though its upper bits alone might say otherwise.
    if value.is_nan() { bits | 0x0040_0000 } else { bits.wrapping_add(0x7FFF + ((bits >> 16) & 1)) }
}

#[inline(always)]
fn pair(first: f32, second: f32) -> Pair {
    (rounded(first) >> 16) | (rounded(second) & 0xFFFF_0000)
}

/// Rounds numbers one by one.
pub fn round(kernels: Simd, from: &[f32], to: &mut [u16]) {
    #[cfg(target_arch = "x86_64")]
    if kernels.family() == Family::Avx512Bf16 {
        // SAFETY: a `Simd` value proves that the processor has the instructions.
        return unsafe { native::round(from, to) };
    }
    round_plainly(kernels, from, to);
}

vectorised! {
    fn round_plainly(from: &[f32], to: &mut [u16]) {
        for (to, from) in to.iter_mut().zip(from) {
            *to = (rounded(*from) >> 16) as u16;
        }
    }
}

/// 8-bit pixels to normalised and rounded numbers: `clamp(pixel * scale + shift, -5, 5)`.
pub fn round_pixels(kernels: Simd, pixels: &[u8], scale: &[f32], shift: &[f32], out: &mut [u16]) {
    #[cfg(target_arch = "x86_64")]
    if kernels.family() == Family::Avx512Bf16 {
        // SAFETY: a `Simd` value proves that the processor has the instructions.
        return unsafe { native::round_pixels(pixels, scale, shift, out) };
    }
    round_pixels_plainly(kernels, pixels, scale, shift, out);
}

vectorised! {
    fn round_pixels_plainly(pixels: &[u8], scale: &[f32], shift: &[f32], out: &mut [u16]) {
        for (((out, pixel), scale), shift) in out.iter_mut().zip(pixels).zip(scale).zip(shift) {
            *out = (rounded(normalised(*pixel, *scale, *shift)) >> 16) as u16;
        }
    }
}

#[inline(always)]
fn normalised(pixel: u8, scale: f32, shift: f32) -> f32 {
    (f32::from(pixel) * scale + shift).clamp(-5.0, 5.0)
}

/// Rounding by the instructions for it, many numbers at a time.
#[cfg(target_arch = "x86_64")]
mod native {
    use std::arch::x86_64::{
        __m128i, __m256bh, __m256i, __m512bh, __m512i, _mm_loadu_si128, _mm256_storeu_si256,
        _mm512_add_ps, _mm512_cvtepi32_ps, _mm512_cvtepu8_epi32, _mm512_cvtne2ps_pbh,
        _mm512_cvtneps_pbh, _mm512_loadu_ps, _mm512_max_ps, _mm512_min_ps, _mm512_mul_ps,
        _mm512_set1_ps, _mm512_storeu_si512,
    };
    use std::mem::transmute;

    use super::{normalised, rounded};

    #[target_feature(enable = "avx512f,avx512bf16")]
    pub fn round(from: &[f32], to: &mut [u16]) {
        let ((from, rest), (to, last)) = (from.as_chunks::<32>(), to.as_chunks_mut::<32>());
        for (from, to) in from.iter().zip(to) {
            // SAFETY: both halves and the result are whole arrays; a register of rounded numbers is
            // any bits.
            unsafe {
                let (low, high) =
                    (_mm512_loadu_ps(from.as_ptr()), _mm512_loadu_ps(from.as_ptr().add(16)));
                let both = transmute::<__m512bh, __m512i>(_mm512_cvtne2ps_pbh(high, low));
                _mm512_storeu_si512(to.as_mut_ptr().cast(), both);
            }
        }
        for (from, to) in rest.iter().zip(last) {
            *to = (rounded(*from) >> 16) as u16;
        }
    }

    #[target_feature(enable = "avx512f,avx512bf16,avx512vl")]
    pub fn round_pixels(pixels: &[u8], scale: &[f32], shift: &[f32], out: &mut [u16]) {
        let (pixels, (out, last)) = (pixels.as_chunks::<16>(), out.as_chunks_mut::<16>());
        let (scale, shift) = (scale.as_chunks::<16>(), shift.as_chunks::<16>());
        let (least, most) = (_mm512_set1_ps(-5.0), _mm512_set1_ps(5.0));
        for (((out, pixels), scales), shifts) in
            out.iter_mut().zip(pixels.0).zip(scale.0).zip(shift.0)
        {
            // SAFETY: every pointer is that of a whole array; a register of rounded numbers is any
            // bits.
            unsafe {
                let pixels = _mm512_cvtepi32_ps(_mm512_cvtepu8_epi32(_mm_loadu_si128(
                    pixels.as_ptr().cast::<__m128i>(),
                )));
                let (scales, shifts) =
                    (_mm512_loadu_ps(scales.as_ptr()), _mm512_loadu_ps(shifts.as_ptr()));
                let values = _mm512_add_ps(_mm512_mul_ps(pixels, scales), shifts);
                let values = _mm512_min_ps(_mm512_max_ps(values, least), most);
                let halves = transmute::<__m256bh, __m256i>(_mm512_cvtneps_pbh(values));
                _mm256_storeu_si256(out.as_mut_ptr().cast(), halves);
            }
        }
        for (((out, pixel), scale), shift) in
            last.iter_mut().zip(pixels.1).zip(scale.1).zip(shift.1)
        {
            *out = (rounded(normalised(*pixel, *scale, *shift)) >> 16) as u16;
        }
    }
}

vectorised! {
    /// Pairs the numbers of two rows place by place.
    pub fn pair_rows(first: &[f32], second: &[f32], pairs: &mut [Pair]) {
        for ((pairs, first), second) in pairs.iter_mut().zip(first).zip(second) {
            *pairs = pair(*first, *second);
        }
    }
}

vectorised! {
    /// Pairs the numbers of a row with zeros.
    pub fn pair_with_zeros(first: &[f32], pairs: &mut [Pair]) {
        for (pairs, first) in pairs.iter_mut().zip(first) {
            *pairs = pair(*first, 0.0);
        }
    }
}

vectorised! {
    /// Pairs each number with that which stands `distance` further on.
    pub fn pair_with_distant(numbers: &[u16], distance: usize, pairs: &mut [Pair]) {
        for ((pair, first), second) in pairs.iter_mut().zip(numbers).zip(&numbers[distance..]) {
            *pair = Pair::from(*first) | Pair::from(*second) << 16;
        }
    }
}

/// A pair of two weights.
#[inline]
pub(super) fn pair_of(first: f32, second: f32) -> Pair {
    pair(first, second)
}

/// Pairs as the halves that they consist of.
pub(super) fn halves(pairs: &[Pair]) -> &[u16] {
    // SAFETY: the halves are the same memory, need less alignment, and any bits are a number of 16
    // bits.
    unsafe { std::slice::from_raw_parts(pairs.as_ptr().cast::<u16>(), 2 * pairs.len()) }
}

/// Computes a tile of some height: an inner index is a pair, which the left factor has side by
/// side.
///
/// # Safety
/// All elements of the tile must lie inside the allocations behind the pointers.
#[inline]
pub(super) unsafe fn run(
    tile: Tile,
    kernels: Simd,
    height: usize,
    left: *const u16,
    right: *const Pair,
    out: *mut f32,
) {
    #[cfg(target_arch = "x86_64")]
    {
        use super::tile::Ahead;
        assert!(kernels.family() == Family::Avx512Bf16, "a product of pairs by {kernels}");
        let next = right.wrapping_add(tile.next);
        const LEFT: u8 = Ahead::LeftHalf as u8;
        const RIGHT: u8 = Ahead::RightHalf as u8;
        macro_rules! heights {
            ($($height:literal)*) => {
                match (height, tile.ahead) {
                    // SAFETY: as the caller promised; a `Simd` value proves that the processor has
                    // the instructions.
                    $(($height, Ahead::Nothing) => unsafe { tile_of::<$height, 0>(tile, left, right, next, out) },)*
                    // SAFETY: as above.
                    $(($height, Ahead::LeftHalf) => unsafe { tile_of::<$height, LEFT>(tile, left, right, next, out) },)*
                    // SAFETY: as above.
                    $(($height, Ahead::RightHalf) => unsafe { tile_of::<$height, RIGHT>(tile, left, right, next, out) },)*
                    // SAFETY: as above.
                    $(($height, Ahead::Everything) => unsafe {
                        tile_of::<$height, { LEFT | RIGHT }>(tile, left, right, next, out);
                    },)*
                    _ => unreachable!("tile height"),
                }
            };
        }
        heights!(1 2 3 4 5 6 7 8 9 10 11 12);
    }
    #[cfg(not(target_arch = "x86_64"))]
    unreachable!("{kernels} has no pairs: {:?}", (tile.inner, height, left, right, out));
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512bf16")]
unsafe fn tile_of<const ROWS: usize, const AHEAD: u8>(
    tile: Tile,
    mut part: *const u16,
    mut right: *const Pair,
    mut ahead: *const Pair,
    out: *mut f32,
) {
    use super::tile::{Ahead, Finish};
    use std::arch::x86_64::{
        __m512bh, __m512i, _MM_HINT_T1, _mm_prefetch, _mm512_add_ps, _mm512_dpbf16_ps,
        _mm512_loadu_ps, _mm512_loadu_si512, _mm512_set1_epi32, _mm512_setzero_ps,
        _mm512_storeu_ps,
    };
    use std::mem::transmute;
    // SAFETY: see `run`; a prefetch of any address is harmless; a register of pairs is any bits.
    unsafe {
        let mut sums = [[_mm512_setzero_ps(); 2]; ROWS];
        if tile.finish == Finish::Continue {
            for (row, pair) in sums.iter_mut().enumerate() {
                for (half, sum) in pair.iter_mut().enumerate() {
                    *sum = _mm512_loadu_ps(out.add(row * tile.out_stride + 16 * half));
                }
            }
        }
        for _ in 0..tile.parts {
            let mut left = part;
            for _ in 0..tile.inner {
                if AHEAD & Ahead::LeftHalf as u8 != 0 {
                    _mm_prefetch::<_MM_HINT_T1>(ahead.cast());
                }
                if AHEAD & Ahead::RightHalf as u8 != 0 {
                    _mm_prefetch::<_MM_HINT_T1>(ahead.wrapping_add(16).cast());
                }
                ahead = ahead.wrapping_add(tile.right_inner);
                let low = transmute::<__m512i, __m512bh>(_mm512_loadu_si512(right.cast()));
                let high = transmute::<__m512i, __m512bh>(_mm512_loadu_si512(right.add(16).cast()));
                for (row, pair) in sums.iter_mut().enumerate() {
                    let factor = _mm512_set1_epi32(
                        left.add(row * tile.row_stride).cast::<i32>().read_unaligned(),
                    );
                    let factor = transmute::<__m512i, __m512bh>(factor);
                    pair[0] = _mm512_dpbf16_ps(pair[0], factor, low);
                    pair[1] = _mm512_dpbf16_ps(pair[1], factor, high);
                }
                left = left.wrapping_add(tile.left_inner);
                right = right.wrapping_add(tile.right_inner);
            }
            part = part.wrapping_add(tile.left_part);
        }
        for (row, pair) in sums.iter().enumerate() {
            for (half, sum) in pair.iter().enumerate() {
                let to = out.add(row * tile.out_stride + 16 * half);
                let sum = if tile.finish == Finish::Add {
                    _mm512_add_ps(_mm512_loadu_ps(to), *sum)
                } else {
                    *sum
                };
                _mm512_storeu_ps(to, sum);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::panels::Panels;
    use super::super::product::tests::noise;
    use super::super::product::{
        Axis, Grouped, Left, Right, Size, add_to_overlapping_rows, multiply_grouped,
        multiply_panels,
    };
    use super::*;

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
        for kernels in Simd::available().into_iter().chain(Simd::bfloat16()) {
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
                let value =
                    (f32::from(pixels[place]) * scale[place] + shift[place]).clamp(-5.0, 5.0);
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

    /// One number of a product by the definition above.
    fn sum(terms: &[(f32, f32)], start: f32) -> f32 {
        terms.chunks(2).fold(start, |sum, pair| {
            let sum = pair.get(1).map_or(sum, |(a, b)| nearest(*a).mul_add(nearest(*b), sum));
            nearest(pair[0].0).mul_add(nearest(pair[0].1), sum)
        })
    }

    /// Bit by bit against the definition; within what sums of 32-bit numbers may lose of the
    /// rounded factors' product in 64 bits; and within what 8 bits may lose of the product of the
    /// factors themselves.
    #[test]
    fn products_are_what_is_defined_and_near_those_of_numbers() {
        let Some(kernels) = Simd::bfloat16() else { return };
        for rows in [1, 2, 5, 11, 12, 13, 16, 40] {
            for (columns, inner) in [(32, 1), (32, 2), (64, 9), (96, 130), (32, 4501)] {
                let (left, matrix) = (noise(rows * inner, 1), noise(inner * columns, 2));
                let mut panels = Panels::default();
                panels.pack(kernels, &matrix, inner, columns);
                for accumulate in [false, true] {
                    let stride = columns + 3;
                    let before = noise(rows * stride, 4);
                    let mut out = before.clone();
                    let factor = Left { data: &left, row_stride: inner, inner_stride: 1 };
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
                            sum(&terms, start).to_bits(),
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
        let Some(kernels) = Simd::bfloat16() else { return };
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
                assert_eq!(
                    found.to_bits(),
                    sum(&terms, 0.0).to_bits(),
                    "row {row} column {column}"
                );
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
                expected[row * 32 + column] += sum(&terms, 0.0);
            }
        }
        assert_eq!(out, expected);
    }
}
