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

use crate::networks::cpu::vectorised::kernel_files;

kernel_files!(avx2, avx512);
mod data;
mod scalar;

pub use data::PANEL;
pub(super) use data::{Ahead, Finish, Tile};
use data::{LEFT, RIGHT};
use hasard_engine::simd::{Family, Simd};

/// Most rows of a tile: as many as leave their sums in registers.
pub(super) const fn tallest(kernels: Simd) -> usize {
    match kernels.family() {
        Family::AmxBf16 => 32,
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
                    // SAFETY: as the caller promised; a `Simd` value proves that the processor
                    // has the instructions.
                    $(($height, Ahead::Nothing) => unsafe { $function::tile::<$height, 0>(self, left, right, next, out) },)*
                    // SAFETY: as above.
                    $(($height, Ahead::LeftHalf) => unsafe { $function::tile::<$height, LEFT>(self, left, right, next, out) },)*
                    // SAFETY: as above.
                    $(($height, Ahead::RightHalf) => unsafe { $function::tile::<$height, RIGHT>(self, left, right, next, out) },)*
                    // SAFETY: as above.
                    $(($height, Ahead::Everything) => unsafe {
                        $function::tile::<$height, { LEFT | RIGHT }>(self, left, right, next, out);
                    },)*
                    _ => unreachable!("tile height"),
                }
            };
        }
        match kernels.family() {
            #[cfg(target_arch = "x86_64")]
            Family::Avx512 | Family::Avx512Bf16 | Family::AmxBf16 => {
                heights!(avx512: 1 2 3 4 5 6 7 8 9 10 11 12)
            }
            #[cfg(target_arch = "x86_64")]
            Family::Avx2 => heights!(avx2: 1 2 3 4 5 6),
            _ => heights!(scalar: 1 2 3 4),
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
