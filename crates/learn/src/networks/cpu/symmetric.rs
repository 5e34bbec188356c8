//! Products that are their own transposes, for about half of the arithmetic.

use hasard_engine::simd::Simd;

use crate::networks::cpu::panels::Panels;
use crate::networks::cpu::product::{Left, Size, multiply_panels_from};
use crate::networks::cpu::tile::PANEL;

/// `out = left * right`, which the caller knows to be symmetric, of `side` rows and columns: blocks
/// on and above the diagonal are computed, those below it are their mirror images. The bits are
/// those of the whole product, since both numbers are sums of the same terms in the same order.
///
/// # Panics
/// If the size reaches outside a slice, or `side` is no multiple of [`PANEL`].
pub fn multiply_symmetric(
    kernels: Simd,
    side: usize,
    left: Left<'_>,
    right: &Panels,
    inner: usize,
    out: &mut [f32],
    rounded: &mut Vec<u16>,
) {
    for first in (0..side).step_by(PANEL) {
        let size = Size { rows: PANEL, columns: side - first, inner };
        let left = Left { data: &left.data[first * left.row_stride..], ..left };
        let (right, to) = ((right, first / PANEL), &mut out[first * side + first..]);
        multiply_panels_from(kernels, size, left, right, to, side, false, rounded);
        let (above, below) = out.split_at_mut((first + PANEL) * side);
        for (row, to) in below.chunks_exact_mut(side).enumerate() {
            for (column, to) in to[first..first + PANEL].iter_mut().enumerate() {
                *to = above[(first + column) * side + first + PANEL + row];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::product::multiply_panels;
    use super::super::product::tests::noise;
    use super::*;

    /// A matrix times its transpose, and that once more by itself, in every family.
    #[test]
    fn half_of_a_symmetric_product_has_the_bits_of_the_whole() {
        for kernels in Simd::all() {
            for (side, inner) in [(32, 5), (64, 64), (96, 601)] {
                let mut rounded = Vec::new();
                let mut panels = Panels::default();
                let mut both = |rows: &[f32], inner: usize, panels: &Panels| {
                    let left = Left::rows(rows, inner);
                    let (mut whole, mut half) = (vec![1.0; side * side], vec![2.0; side * side]);
                    let size = Size { rows: side, columns: side, inner };
                    let rounded = &mut rounded;
                    multiply_panels(kernels, size, left, panels, &mut whole, side, false, rounded);
                    multiply_symmetric(kernels, side, left, panels, inner, &mut half, rounded);
                    let bits = |values: &[f32]| -> Vec<u32> {
                        values.iter().map(|value| value.to_bits()).collect()
                    };
                    assert_eq!(bits(&whole), bits(&half), "{kernels} {side} {inner}");
                    half
                };
                let matrix = noise(side * inner, 1);
                panels.pack_transposed(kernels, &matrix, inner, side);
                let gram = both(&matrix, inner, &panels);
                panels.pack(kernels, &gram, side, side);
                both(&gram, side, &panels);
            }
        }
    }
}
