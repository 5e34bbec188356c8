//! Sums of outer products: the gradient of a dense layer's weights, from its inputs and the
//! gradients of its sums.
//!
//! The inner dimension are the rows of a batch. They may lie anywhere, since both factors are
//! repacked on their way: read in place, numbers that belong together would be kilobytes apart and
//! push each other out of the nearest cache.

use std::ops::Range;

use hasard_engine::simd::Simd;

use crate::networks::cpu::bfloat16::{Pair, pair_rows, pair_with_zeros};
use crate::networks::cpu::product::{Factor, block_rows, stretches};
use crate::networks::cpu::tile::{Ahead, Finish, PANEL, Tile, tiles};

/// Memory for repacked factors.
#[derive(Default)]
pub struct Workspace {
    numbers: Packed<f32>,
    pairs: Packed<Pair>,
    /// Rows of the two factors, paired.
    paired: [Vec<Pair>; 2],
}

#[derive(Default)]
struct Packed<T> {
    left: Vec<T>,
    right: Vec<T>,
}

/// `out[i][j]` = the sum over all rows k of `inputs[k][rows.start + i] * sums[k][j]`; `out` has
/// `columns` columns.
///
/// # Panics
/// If a row is too short, the two numbers of rows differ, `out` has another size, or `columns` is
/// no multiple of [`PANEL`].
pub fn sum_outer_products(
    kernels: Simd,
    inputs: &[&[f32]],
    rows: Range<usize>,
    sums: &[&[f32]],
    columns: usize,
    out: &mut [f32],
    workspace: &mut Workspace,
) {
    assert!(
        columns.is_multiple_of(PANEL),
        "product of {columns} columns, not a multiple of {PANEL}"
    );
    assert!(
        inputs.len() == sums.len() && out.len() == rows.len() * columns,
        "sizes of an outer product"
    );
    if inputs.is_empty() || columns == 0 {
        return out.fill(0.0);
    }
    if !kernels.family().rounds() {
        return sum_packed(
            kernels,
            inputs,
            rows,
            sums,
            columns,
            out,
            &mut workspace.numbers,
            f32::run,
        );
    }
    let [left, right] = &mut workspace.paired;
    let inputs = paired(kernels, inputs, rows.clone(), left);
    let sums = paired(kernels, sums, 0..columns, right);
    let run = |tile: Tile, kernels, height, left: *const Pair, right, out| {
        // A step of the left factor is a pair of halves.
        let tile =
            Tile { row_stride: 2 * tile.row_stride, left_inner: 2 * tile.left_inner, ..tile };
        // SAFETY: as the caller promises.
        unsafe { u16::run(tile, kernels, height, left.cast(), right, out) }
    };
    sum_packed(kernels, &inputs, 0..rows.len(), &sums, columns, out, &mut workspace.pairs, run);
    u16::end(kernels);
}

/// Some columns of rows, two rows together.
fn paired<'a>(
    kernels: Simd,
    rows: &[&[f32]],
    columns: Range<usize>,
    pairs: &'a mut Vec<Pair>,
) -> Vec<&'a [Pair]> {
    let width = columns.len();
    pairs.resize(rows.len().div_ceil(2) * width, 0);
    for (rows, pairs) in rows.chunks(2).zip(pairs.chunks_exact_mut(width)) {
        match rows {
            [first, second] => {
                pair_rows(kernels, &first[columns.clone()], &second[columns.clone()], pairs)
            }
            _ => pair_with_zeros(kernels, &rows[0][columns.clone()], pairs),
        }
    }
    pairs.chunks_exact(width).collect()
}

/// As [`sum_outer_products`], of numbers or of pairs, by a tile of theirs.
#[allow(clippy::too_many_arguments, reason = "two factors, a result, scratch and what multiplies")]
fn sum_packed<T: Copy + Default>(
    kernels: Simd,
    inputs: &[&[T]],
    rows: Range<usize>,
    sums: &[&[T]],
    columns: usize,
    out: &mut [f32],
    packed: &mut Packed<T>,
    run: unsafe fn(Tile, Simd, usize, *const T, *const T, *mut f32),
) {
    for (start, length) in stretches(kernels, inputs.len()) {
        let (inputs, sums) = (&inputs[start..start + length], &sums[start..start + length]);
        let block = block_rows(kernels, length);
        pack_panels(sums, columns, &mut packed.right);
        for (out, first) in out.chunks_mut(block * columns).zip(rows.clone().step_by(block)) {
            let count = out.len() / columns;
            pack_block(kernels, inputs, first, count, &mut packed.left);
            for (panel, right) in packed.right.chunks_exact(length * PANEL).enumerate() {
                for (row, height) in tiles(kernels, count) {
                    let tile = Tile {
                        inner: length,
                        parts: 1,
                        left_part: 0,
                        row_stride: 1,
                        left_inner: height,
                        right_inner: PANEL,
                        out_stride: columns,
                        finish: if start > 0 { Finish::Continue } else { Finish::Set },
                        next: length * PANEL,
                        ahead: Ahead::at(row, row + height, count),
                    };
                    let left = &packed.left[row * length..][..height * length];
                    let out =
                        &mut out[row * columns + panel * PANEL..][..(height - 1) * columns + PANEL];
                    // SAFETY: the three slices are exactly the tile's elements.
                    unsafe {
                        run(tile, kernels, height, left.as_ptr(), right.as_ptr(), out.as_mut_ptr())
                    };
                }
            }
        }
    }
}

/// The rows as [`super::pack::pack`] stores them.
fn pack_panels<T: Copy + Default>(rows: &[&[T]], columns: usize, packed: &mut Vec<T>) {
    packed.resize(rows.len() * columns, T::default());
    for (k, row) in rows.iter().enumerate() {
        for (panel, values) in row[..columns].chunks_exact(PANEL).enumerate() {
            packed[(panel * rows.len() + k) * PANEL..][..PANEL].copy_from_slice(values);
        }
    }
}

/// Columns `first..first + count` of the inputs, tile after tile; in a tile one row of numbers
/// after the other.
fn pack_block<T: Copy + Default>(
    kernels: Simd,
    inputs: &[&[T]],
    first: usize,
    count: usize,
    packed: &mut Vec<T>,
) {
    packed.resize(count * inputs.len(), T::default());
    let mut all = tiles(kernels, count).peekable();
    // At most two heights occur, the taller first.
    while let Some(&(start, height)) = all.peek() {
        let mut same = 0;
        while all.next_if(|tile| tile.1 == height).is_some() {
            same += 1;
        }
        let part = &mut packed[start * inputs.len()..][..same * height * inputs.len()];
        macro_rules! heights {
            ($($height:literal)*) => {
                match height {
                    $($height => pack_tiles::<T, $height>(inputs, first + start, part),)*
                    _ => pack_tiles_of(height, inputs, first + start, part),
                }
            };
        }
        heights!(1 2 3 4 5 6 7 8 9 10 11 12);
    }
}

/// Tiles of a height known when this is compiled, so that a copy is a move or two rather than a
/// call.
fn pack_tiles<T: Copy, const HEIGHT: usize>(inputs: &[&[T]], first: usize, packed: &mut [T]) {
    pack_tiles_of(HEIGHT, inputs, first, packed);
}

#[inline(always)]
fn pack_tiles_of<T: Copy>(height: usize, inputs: &[&[T]], first: usize, packed: &mut [T]) {
    let length = inputs.len() * height;
    let count = packed.len() / length;
    for (k, row) in inputs.iter().enumerate() {
        for (tile, values) in row[first..first + count * height].chunks_exact(height).enumerate() {
            packed[tile * length + k * height..][..height].copy_from_slice(values);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::product::tests::noise;
    use super::*;

    /// Every family, with more rows than a stretch of the inner dimension and more columns than a
    /// block.
    #[test]
    fn sums_equal_plain_loops() {
        for kernels in Simd::all() {
            // Two factors of eight bits lose that much of a term of at most 1.
            let lost = if kernels.family().rounds() { 2.01 / 256.0 } else { 0.0 };
            for (count, width, columns, rows) in
                [(1, 40, 32, 3..40), (5, 300, 64, 0..300), (1100, 50, 96, 7..48)]
            {
                let (inputs, sums) = (noise(count * width, 1), noise(count * columns, 2));
                let (inputs, sums): (Vec<_>, Vec<_>) =
                    (inputs.chunks(width).collect(), sums.chunks(columns).collect());
                let mut out = vec![7.0; rows.len() * columns];
                sum_outer_products(
                    kernels,
                    &inputs,
                    rows.clone(),
                    &sums,
                    columns,
                    &mut out,
                    &mut Workspace::default(),
                );
                for (i, row) in rows.clone().enumerate() {
                    for column in 0..columns {
                        let terms = inputs
                            .iter()
                            .zip(&sums)
                            .map(|(x, d)| f64::from(x[row]) * f64::from(d[column]));
                        let (expected, found) =
                            (terms.sum::<f64>(), f64::from(out[i * columns + column]));
                        assert!(
                            (expected - found).abs() < 1e-4 + lost * count as f64,
                            "{kernels} {count} {row} {column}: {found}, not {expected}"
                        );
                    }
                }
            }
        }
    }

    /// The order of summation is that of the rows, wherever the part of the result begins.
    #[test]
    fn parts_of_a_result_have_the_bits_of_the_whole() {
        for kernels in Simd::all() {
            let (inputs, sums) = (noise(700 * 70, 1), noise(700 * 32, 2));
            let (inputs, sums): (Vec<_>, Vec<_>) =
                (inputs.chunks(70).collect(), sums.chunks(32).collect());
            let part = |rows: Range<usize>| {
                let mut out = vec![0.0; rows.len() * 32];
                sum_outer_products(
                    kernels,
                    &inputs,
                    rows,
                    &sums,
                    32,
                    &mut out,
                    &mut Workspace::default(),
                );
                out
            };
            assert_eq!(part(0..70), [part(0..11), part(11..23), part(23..70)].concat());
        }
    }
}
