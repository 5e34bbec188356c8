//! The register tile under all products: some rows x 32 columns of a result, summed over the inner
//! dimension in order.
//!
//! Each number of a result is one chain of additions from the first inner index to the last,
//! whatever the family of kernels and however rows are dealt into tiles; leaving sums in memory and
//! taking them up again changes no bit either. So results depend on the order of the inner
//! dimension alone, never on block sizes or on the number of threads.
//!
//! Products in bfloat16 have a tile of their own, [`super::bfloat16`], and share what is said of
//! tiles here.

use hasard_engine::simd::{Family, Simd};

/// Columns of a tile; widths of results are multiples of it.
pub const PANEL: usize = 32;

/// Most rows of a tile: as many as leave their sums in registers.
pub(super) const fn tallest(kernels: Simd) -> usize {
    match kernels.family() {
        Family::Avx512 | Family::Avx512Bf16 => 12,
        Family::Avx2 => 6,
        Family::Plain => 4,
    }
}

/// Rows dealt into tiles of nearly equal height, as (first row, height): 16 rows are 8 + 8 rather
/// than 12 + 4, which keeps the units busy.
pub(super) fn tiles(kernels: Simd, rows: usize) -> impl Iterator<Item = (usize, usize)> {
    let count = rows.div_ceil(tallest(kernels)).max(1);
    let (height, taller) = (rows / count, rows % count);
    (0..count)
        .map(move |tile| (tile * height + tile.min(taller), height + usize::from(tile < taller)))
}

/// What becomes of a tile's sums.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Finish {
    /// They begin at zero and are written down.
    Set,
    /// They go on from what is there.
    Continue,
    /// They begin at zero and are added to what is there.
    Add,
}

/// Strides of a tile.
#[derive(Clone, Copy)]
pub(super) struct Tile {
    /// Inner indices of a part.
    pub inner: usize,
    /// Parts of the inner dimension: each begins so far behind the one before in the left factor,
    /// and right behind it in the right one.
    pub parts: usize,
    pub left_part: usize,
    pub row_stride: usize,
    pub left_inner: usize,
    pub right_inner: usize,
    pub out_stride: usize,
    pub finish: Finish,
    /// How far behind the right factor lies what will be read in its place soon.
    pub next: usize,
    /// What of that is fetched on the way.
    pub ahead: Ahead,
}

/// The part of the next panel that a tile fetches while it works on this one; a bit for each half,
/// as kernels are made for it.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Ahead {
    Nothing = 0,
    LeftHalf = 1,
    RightHalf = 2,
    Everything = 3,
}

impl Ahead {
    /// What a tile fetches which ends at row `end` of `rows`: the last two of a panel share the
    /// next, so that it comes no faster than it has to.
    pub fn at(first: usize, end: usize, rows: usize) -> Ahead {
        match (end == rows, first > 0) {
            (true, false) => Ahead::Everything,
            (true, true) => Ahead::RightHalf,
            // Tiles differ by one row at most.
            (false, _) if 2 * end - first + 1 >= rows => Ahead::LeftHalf,
            _ => Ahead::Nothing,
        }
    }
}

const LEFT: u8 = Ahead::LeftHalf as u8;
const RIGHT: u8 = Ahead::RightHalf as u8;

impl Tile {
    /// Computes a tile of some height.
    ///
    /// # Safety
    /// All elements of the tile must lie inside the allocations behind the pointers.
    #[inline]
    pub unsafe fn run(
        self,
        kernels: Simd,
        height: usize,
        left: *const f32,
        right: *const f32,
        out: *mut f32,
    ) {
        let next = right.wrapping_add(self.next);
        macro_rules! heights {
            ($function:ident: $($height:literal)*) => {
                match (height, self.ahead) {
                    // SAFETY: as the caller promised; whoever has these kernels has their
                    // instructions.
                    $(($height, Ahead::Nothing) => unsafe { $function::<$height, 0>(self, left, right, next, out) },)*
                    // SAFETY: as above.
                    $(($height, Ahead::LeftHalf) => unsafe { $function::<$height, LEFT>(self, left, right, next, out) },)*
                    // SAFETY: as above.
                    $(($height, Ahead::RightHalf) => unsafe { $function::<$height, RIGHT>(self, left, right, next, out) },)*
                    // SAFETY: as above.
                    $(($height, Ahead::Everything) => unsafe {
                        $function::<$height, { LEFT | RIGHT }>(self, left, right, next, out);
                    },)*
                    _ => unreachable!("tile height"),
                }
            };
        }
        match kernels.family() {
            #[cfg(target_arch = "x86_64")]
            Family::Avx512 | Family::Avx512Bf16 => heights!(avx512: 1 2 3 4 5 6 7 8 9 10 11 12),
            #[cfg(target_arch = "x86_64")]
            Family::Avx2 => heights!(avx2: 1 2 3 4 5 6),
            _ => heights!(portable: 1 2 3 4),
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f")]
unsafe fn avx512<const ROWS: usize, const AHEAD: u8>(
    tile: Tile,
    mut part: *const f32,
    mut right: *const f32,
    mut ahead: *const f32,
    out: *mut f32,
) {
    use std::arch::x86_64::{
        _MM_HINT_T1, _mm_prefetch, _mm512_add_ps, _mm512_fmadd_ps, _mm512_loadu_ps, _mm512_set1_ps,
        _mm512_setzero_ps, _mm512_storeu_ps,
    };
    // SAFETY: see `Tile::run`; a prefetch of any address is harmless.
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
                if AHEAD & LEFT != 0 {
                    _mm_prefetch::<_MM_HINT_T1>(ahead.cast());
                }
                if AHEAD & RIGHT != 0 {
                    _mm_prefetch::<_MM_HINT_T1>(ahead.wrapping_add(16).cast());
                }
                ahead = ahead.wrapping_add(tile.right_inner);
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

/// Half a panel at a time: two halves of six rows fill the sixteen registers.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
unsafe fn avx2<const ROWS: usize, const AHEAD: u8>(
    tile: Tile,
    left: *const f32,
    right: *const f32,
    ahead: *const f32,
    out: *mut f32,
) {
    use std::arch::x86_64::{
        _MM_HINT_T1, _mm_prefetch, _mm256_add_ps, _mm256_fmadd_ps, _mm256_loadu_ps, _mm256_set1_ps,
        _mm256_setzero_ps, _mm256_storeu_ps,
    };
    // SAFETY: see `Tile::run`; a prefetch of any address is harmless.
    unsafe {
        for half in [0, 16] {
            let (mut part, mut right, out) = (left, right.add(half), out.add(half));
            let mut ahead = ahead.wrapping_add(half);
            let mut sums = [[_mm256_setzero_ps(); 2]; ROWS];
            if tile.finish == Finish::Continue {
                for (row, pair) in sums.iter_mut().enumerate() {
                    for (part, sum) in pair.iter_mut().enumerate() {
                        *sum = _mm256_loadu_ps(out.add(row * tile.out_stride + 8 * part));
                    }
                }
            }
            for _ in 0..tile.parts {
                let mut left = part;
                for _ in 0..tile.inner {
                    if AHEAD & (if half == 0 { LEFT } else { RIGHT }) != 0 {
                        _mm_prefetch::<_MM_HINT_T1>(ahead.cast());
                    }
                    ahead = ahead.wrapping_add(tile.right_inner);
                    let low = _mm256_loadu_ps(right);
                    let high = _mm256_loadu_ps(right.add(8));
                    for (row, pair) in sums.iter_mut().enumerate() {
                        let factor = _mm256_set1_ps(*left.add(row * tile.row_stride));
                        pair[0] = _mm256_fmadd_ps(factor, low, pair[0]);
                        pair[1] = _mm256_fmadd_ps(factor, high, pair[1]);
                    }
                    left = left.wrapping_add(tile.left_inner);
                    right = right.wrapping_add(tile.right_inner);
                }
                part = part.wrapping_add(tile.left_part);
            }
            for (row, pair) in sums.iter().enumerate() {
                for (quarter, sum) in pair.iter().enumerate() {
                    let to = out.add(row * tile.out_stride + 8 * quarter);
                    let sum = if tile.finish == Finish::Add {
                        _mm256_add_ps(_mm256_loadu_ps(to), *sum)
                    } else {
                        *sum
                    };
                    _mm256_storeu_ps(to, sum);
                }
            }
        }
    }
}

/// A quarter of a panel at a time, for processors of sixteen short registers.
unsafe fn portable<const ROWS: usize, const AHEAD: u8>(
    tile: Tile,
    left: *const f32,
    right: *const f32,
    _ahead: *const f32,
    out: *mut f32,
) {
    const WIDTH: usize = 8;
    // SAFETY: see `Tile::run`.
    unsafe {
        for quarter in 0..PANEL / WIDTH {
            let (mut part, mut right, out) =
                (left, right.add(quarter * WIDTH), out.add(quarter * WIDTH));
            let mut sums = [[0.0f32; WIDTH]; ROWS];
            if tile.finish == Finish::Continue {
                for (row, sums) in sums.iter_mut().enumerate() {
                    *sums = out.add(row * tile.out_stride).cast::<[f32; WIDTH]>().read();
                }
            }
            for _ in 0..tile.parts {
                let mut left = part;
                for _ in 0..tile.inner {
                    let columns = right.cast::<[f32; WIDTH]>().read();
                    for (row, sums) in sums.iter_mut().enumerate() {
                        let factor = *left.add(row * tile.row_stride);
                        for (sum, column) in sums.iter_mut().zip(columns) {
                            *sum += factor * column;
                        }
                    }
                    left = left.wrapping_add(tile.left_inner);
                    right = right.wrapping_add(tile.right_inner);
                }
                part = part.wrapping_add(tile.left_part);
            }
            for (row, sums) in sums.iter_mut().enumerate() {
                let to = out.add(row * tile.out_stride).cast::<[f32; WIDTH]>();
                if tile.finish == Finish::Add {
                    for (sum, there) in sums.iter_mut().zip(to.read()) {
                        *sum += there;
                    }
                }
                to.write(*sums);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_all_rows_once_and_none_is_too_tall() {
        for kernels in Simd::available() {
            for rows in 1..60 {
                let mut next = 0;
                for (first, height) in tiles(kernels, rows) {
                    assert_eq!(first, next);
                    assert!((1..=tallest(kernels)).contains(&height));
                    next += height;
                }
                assert_eq!(next, rows);
            }
        }
    }

    #[test]
    fn the_next_panel_is_fetched_once() {
        for kernels in Simd::available() {
            for rows in 1..60 {
                let (mut left, mut right) = (0, 0);
                for (first, height) in tiles(kernels, rows) {
                    let ahead = Ahead::at(first, first + height, rows);
                    left += u32::from(matches!(ahead, Ahead::LeftHalf | Ahead::Everything));
                    right += u32::from(matches!(ahead, Ahead::RightHalf | Ahead::Everything));
                }
                assert_eq!((left, right), (1, 1), "{rows} rows");
            }
        }
    }
}
