//! Matrix products, block by block over the register tile of [`super::tile`].
//!
//! Both factors are read in place through strides, so a convolution is a product whose rows overlap
//! in memory and the gradient of its weights one with rows and inner dimension exchanged. Weights
//! are repacked once an update, and the long factors of the dense layers' gradients on their way
//! ([`super::outer`]). Tiles run at over 90 % of what the multiply-add units can do.
//!
//! [`multiply`] asserts that every address that it will touch lies inside its slices.
//!
//! Long because it holds every shape of product over the one tile, so that their order of sums is read at one place.

use hasard_engine::simd::{Family, Simd};

use crate::networks::cpu::bfloat16::{self, Pair};
use crate::networks::cpu::panels::Panels;
use crate::networks::cpu::tile::{Ahead, Finish, PANEL, Tile, tallest, tiles};

/// The way of one index through a factor: `count` steps, and that again for each of `groups`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    pub count: usize,
    pub stride: usize,
    pub groups: usize,
    pub group_stride: usize,
}

impl Axis {
    /// Steps of one length.
    pub const fn plain(count: usize, stride: usize) -> Axis {
        Axis { count, stride, groups: 1, group_stride: 0 }
    }

    /// All steps of all groups.
    pub const fn length(self) -> usize {
        self.count * self.groups
    }

    /// How far the last of them lies behind the first.
    const fn reach(self) -> usize {
        (self.count - 1) * self.stride + (self.groups - 1) * self.group_stride
    }
}

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

/// Right factor: element (inner, 32 panel + column) is `data[panel * panel_stride + inner *
/// inner_stride + column]`. In bfloat16 an element is a pair of inner indices.
#[derive(Clone, Copy)]
pub struct Right<'a, T = f32> {
    /// The elements.
    pub data: &'a [T],
    /// Distance of two panels of 32 columns.
    pub panel_stride: usize,
    /// Distance of two inner indices.
    pub inner_stride: usize,
}

impl<'a> Left<'a> {
    /// A matrix of `width` columns stored row by row.
    #[must_use]
    pub fn rows(data: &'a [f32], width: usize) -> Left<'a> {
        Left { data, row_stride: width, inner_stride: 1 }
    }
}

impl<'a, T> Right<'a, T> {
    /// A matrix of `width` columns stored row by row.
    #[must_use]
    pub fn rows(data: &'a [T], width: usize) -> Right<'a, T> {
        Right { data, panel_stride: PANEL, inner_stride: width }
    }

    /// A matrix of `inner` rows stored panel after panel, as [`super::pack::pack`] does.
    #[must_use]
    pub fn panels(data: &'a [T], inner: usize) -> Right<'a, T> {
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

/// Bytes of the left factor that stay in the second-level cache while the panels of the right one
/// pass by.
const BLOCK_BYTES: usize = 384 * 1024;
/// Longest stretch of the inner dimension that is walked at once: a panel of so many rows stays in
/// the second-level cache, and with short registers, which read it twice as often, nearly in the
/// first.
pub(super) const fn stretch(kernels: Simd) -> usize {
    match kernels.family() {
        Family::Avx512 | Family::Avx512Bf16 | Family::AmxBf16 => 2048,
        Family::Avx2 | Family::Plain => 512,
    }
}

/// The inner dimension dealt into stretches of nearly equal length, as (first, length).
pub(super) fn stretches(kernels: Simd, inner: usize) -> impl Iterator<Item = (usize, usize)> {
    let count = inner.div_ceil(stretch(kernels)).max(1);
    let (length, longer) = (inner / count, inner % count);
    (0..count)
        .map(move |part| (part * length + part.min(longer), length + usize::from(part < longer)))
}

/// Rows of the left factor in a block, for a stretch of the inner dimension.
pub(super) fn block_rows(kernels: Simd, inner: usize) -> usize {
    (BLOCK_BYTES / size_of::<f32>() / inner.clamp(1, stretch(kernels)))
        .next_multiple_of(tallest(kernels))
}

/// A left factor whose rows and inner indices come in groups, in which a convolution finds its
/// patches without copying them. In bfloat16 strides count numbers of 16 bits, and an inner index
/// is the pair of two of them that begins there.
#[derive(Clone, Copy)]
pub(super) struct Grouped<'a, T> {
    pub data: &'a [T],
    pub rows: Axis,
    pub inner: Axis,
}

/// What a tile of numbers or of pairs is made of.
pub(super) trait Factor: Copy {
    /// Elements of the right factor.
    type Right: Copy;
    /// Elements of the left factor that a step of the inner dimension reads.
    const READ: usize;
    /// Computes a tile.
    ///
    /// # Safety
    /// All elements of the tile must lie inside the allocations behind the pointers.
    unsafe fn run(
        tile: Tile,
        kernels: Simd,
        height: usize,
        left: *const Self,
        right: *const Self::Right,
        out: *mut f32,
    );
    /// Ends a product, after its last tile.
    #[inline(always)]
    fn end(_kernels: Simd) {}
}

impl Factor for f32 {
    type Right = f32;
    const READ: usize = 1;
    #[inline(always)]
    unsafe fn run(
        tile: Tile,
        kernels: Simd,
        height: usize,
        left: *const f32,
        right: *const f32,
        out: *mut f32,
    ) {
        // SAFETY: as the caller promised.
        unsafe { tile.run(kernels, height, left, right, out) }
    }
}

impl Factor for u16 {
    type Right = Pair;
    const READ: usize = 2;
    #[inline(always)]
    unsafe fn run(
        tile: Tile,
        kernels: Simd,
        height: usize,
        left: *const u16,
        right: *const Pair,
        out: *mut f32,
    ) {
        // SAFETY: as the caller promised.
        unsafe { bfloat16::run(tile, kernels, height, left, right, out) }
    }
    #[inline(always)]
    fn end(kernels: Simd) {
        bfloat16::end(kernels);
    }
}

/// `out = left * right`, or `out += left * right`; row `i` of the result starts at `out[i *
/// out_stride]`.
///
/// # Panics
/// If the size reaches outside a slice, or `columns` is no multiple of [`PANEL`].
pub fn multiply(
    kernels: Simd,
    size: Size,
    left: Left<'_>,
    right: Right<'_>,
    out: &mut [f32],
    out_stride: usize,
    accumulate: bool,
) {
    let Size { rows, columns, inner } = size;
    let (rows, inner) = (Axis::plain(rows, left.row_stride), Axis::plain(inner, left.inner_stride));
    multiply_grouped(
        kernels,
        Grouped { data: left.data, rows, inner },
        right,
        columns,
        out,
        out_stride,
        accumulate,
    );
}

/// As [`multiply`] with weights as the family reads them; in bfloat16 the rows of the left factor,
/// whose inner indices stand side by side, are rounded into `rounded` block by block.
#[allow(clippy::too_many_arguments, reason = "two factors, a result and scratch")]
pub fn multiply_panels(
    kernels: Simd,
    size: Size,
    left: Left<'_>,
    right: &Panels,
    out: &mut [f32],
    out_stride: usize,
    accumulate: bool,
    rounded: &mut Vec<u16>,
) {
    multiply_panels_from(kernels, size, left, (right, 0), out, out_stride, accumulate, rounded);
}

/// As [`multiply_panels`], of the right factor's panels from one on.
#[allow(clippy::too_many_arguments, reason = "two factors, a result and scratch")]
pub(super) fn multiply_panels_from(
    kernels: Simd,
    size: Size,
    left: Left<'_>,
    (right, panel): (&Panels, usize),
    out: &mut [f32],
    out_stride: usize,
    accumulate: bool,
    rounded: &mut Vec<u16>,
) {
    let Size { rows, columns, inner } = size;
    let pairs = match right {
        Panels::Numbers(data) => {
            return multiply(
                kernels,
                size,
                left,
                Right::panels(&data[panel * inner * PANEL..], inner),
                out,
                out_stride,
                accumulate,
            );
        }
        Panels::Pairs(pairs) => pairs,
    };
    assert!(left.inner_stride == 1, "rows that are rounded stand in one piece");
    let width = inner.next_multiple_of(2);
    let block = block_rows(kernels, width / 2);
    rounded.resize(block.min(rows) * width, 0);
    for first in (0..rows).step_by(block) {
        let count = block.min(rows - first);
        for (row, to) in rounded.chunks_exact_mut(width.max(1)).take(count).enumerate() {
            let from = &left.data[(first + row) * left.row_stride..][..inner];
            bfloat16::round(kernels, from, &mut to[..inner]);
            to[inner..].fill(0);
        }
        let factor = Grouped {
            data: &rounded[..],
            rows: Axis::plain(count, width),
            inner: Axis::plain(width / 2, 2),
        };
        let right = Right::panels(&pairs[panel * (width / 2) * PANEL..], width / 2);
        multiply_grouped(
            kernels,
            factor,
            right,
            columns,
            &mut out[first * out_stride..],
            out_stride,
            accumulate,
        );
    }
}

/// As [`multiply`], of a left factor in groups: the rows of all groups follow each other in the
/// result, the inner indices in the right factor.
pub(super) fn multiply_grouped<T: Factor>(
    kernels: Simd,
    left: Grouped<'_, T>,
    right: Right<'_, T::Right>,
    columns: usize,
    out: &mut [f32],
    out_stride: usize,
    accumulate: bool,
) {
    let Grouped { data, rows, inner } = left;
    if rows.length() == 0 || columns == 0 || inner.length() == 0 {
        assert!(
            inner.length() > 0 || accumulate,
            "an empty sum must be asked for as an accumulation"
        );
        return;
    }
    assert!(
        columns.is_multiple_of(PANEL),
        "product of {columns} columns, not a multiple of {PANEL}"
    );
    assert!(rows.reach() + inner.reach() + T::READ <= data.len(), "left factor too short");
    let panels = columns / PANEL;
    assert!(
        (panels - 1) * right.panel_stride + (inner.length() - 1) * right.inner_stride + PANEL
            <= right.data.len(),
        "right factor too short"
    );
    assert!(
        (rows.length() - 1) * out_stride + columns <= out.len()
            && (rows.length() == 1 || out_stride >= columns),
        "result too short"
    );
    for Stretch { start, parts, length } in inner.stretches(kernels) {
        let (part, step) = (start / inner.count, start % inner.count);
        let mut tile = Tile {
            inner: length,
            parts,
            left_part: inner.group_stride,
            row_stride: rows.stride,
            left_inner: inner.stride,
            right_inner: right.inner_stride,
            out_stride,
            finish: if accumulate || start > 0 { Finish::Continue } else { Finish::Set },
            next: right.panel_stride,
            ahead: Ahead::Nothing,
        };
        let block = block_rows(kernels, length * parts);
        for (group, first) in (0..rows.groups)
            .flat_map(|group| (0..rows.count).step_by(block).map(move |first| (group, first)))
        {
            let block_rows = block.min(rows.count - first);
            for panel in 0..panels {
                for (row, height) in tiles(kernels, block_rows) {
                    // The last tiles of a panel fetch the next: with few rows, weights come from
                    // afar all the time.
                    let is_last = panel + 1 == panels;
                    tile.ahead = if is_last {
                        Ahead::Nothing
                    } else {
                        Ahead::at(row, row + height, block_rows)
                    };
                    let row = first + row;
                    let from = group * rows.group_stride
                        + row * rows.stride
                        + part * inner.group_stride
                        + step * inner.stride;
                    let to = (group * rows.count + row) * out_stride + panel * PANEL;
                    // SAFETY: the assertions above bound every element of the tile: rows
                    // `row..row + height` of the group in the left factor and in the result, panel
                    // `panel` of the right factor and of the result, and the inner indices from
                    // `start` on, `length` of each of `parts` groups.
                    unsafe {
                        T::run(
                            tile,
                            kernels,
                            height,
                            data.as_ptr().add(from),
                            right
                                .data
                                .as_ptr()
                                .add(panel * right.panel_stride + start * right.inner_stride),
                            out.as_mut_ptr().add(to),
                        );
                    }
                }
            }
        }
    }
    T::end(kernels);
}

/// Inner indices that are walked at once: `length` of each of `parts` groups, from the index
/// `start` on.
struct Stretch {
    start: usize,
    parts: usize,
    length: usize,
}

impl Axis {
    /// One group in stretches of its own, several in stretches of whole ones.
    fn stretches(self, kernels: Simd) -> impl Iterator<Item = Stretch> {
        let single = self.groups == 1;
        let at_once = (stretch(kernels) / self.count).max(1);
        let (one, many) =
            (if single { self.count } else { 0 }, if single { 0 } else { self.groups });
        let of_one =
            stretches(kernels, one).map(|(start, length)| Stretch { start, parts: 1, length });
        let of_many = (0..many).step_by(at_once).map(move |first| Stretch {
            start: first * self.count,
            parts: at_once.min(many - first),
            length: self.count,
        });
        of_one.filter(move |_| single).chain(of_many)
    }
}

/// Adds `left * right` to rows that overlap: row `i` of the result starts at `out[i * out_stride]`,
/// and panels of it that meet rows before are added after those, so that what meets in one number
/// is added up in the order of the rows.
pub(super) fn add_to_overlapping_rows<T: Factor>(
    kernels: Simd,
    left: Grouped<'_, T>,
    right: Right<'_, T::Right>,
    columns: usize,
    out: &mut [f32],
    out_stride: usize,
) {
    let Grouped { data, rows, inner } = left;
    assert!(
        columns.is_multiple_of(PANEL) && columns > 0,
        "product of {columns} columns, not a multiple of {PANEL}"
    );
    assert!(
        rows.groups == 1 && inner.groups == 1 && rows.count > 0 && inner.count > 0,
        "one group of rows"
    );
    assert!(rows.reach() + inner.reach() + T::READ <= data.len(), "left factor too short");
    let panels = columns / PANEL;
    assert!(
        (panels - 1) * right.panel_stride + (inner.count - 1) * right.inner_stride + PANEL
            <= right.data.len(),
        "right factor too short"
    );
    assert!(
        (rows.count - 1) * out_stride + columns <= out.len() && out_stride >= PANEL,
        "result too short"
    );
    let tile = Tile {
        inner: inner.count,
        parts: 1,
        left_part: 0,
        row_stride: rows.stride,
        left_inner: inner.stride,
        right_inner: right.inner_stride,
        out_stride,
        finish: Finish::Add,
        next: 0,
        ahead: Ahead::Nothing,
    };
    for (row, height) in tiles(kernels, rows.count) {
        // What lies farther behind in an earlier row lies further ahead in a later one.
        for panel in (0..panels).rev() {
            // SAFETY: the assertions above bound every element of the tile.
            unsafe {
                T::run(
                    tile,
                    kernels,
                    height,
                    data.as_ptr().add(row * rows.stride),
                    right.data.as_ptr().add(panel * right.panel_stride),
                    out.as_mut_ptr().add(row * out_stride + panel * PANEL),
                );
            }
        }
    }
    T::end(kernels);
}

#[cfg(test)]
pub(crate) mod tests;
