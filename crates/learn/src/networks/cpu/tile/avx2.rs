//! A tile in registers of 32 bytes.

use crate::networks::cpu::tile::data::{Finish, LEFT, RIGHT, Tile};

/// Half a panel at a time: two halves of six rows fill the sixteen registers.
#[target_feature(enable = "avx2,fma")]
pub unsafe fn tile<const ROWS: usize, const AHEAD: u8>(
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
    use std::hint::black_box;
    // SAFETY: see [`Tile::run`]; a prefetch of any address is harmless.
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
                // The rows from the fourth on have a pointer of their own, which the compiler cannot
                // derive from the first: else it goes from row to row by additions, each of which
                // waits for the one before, six in the time of twelve products.
                let mut left = part;
                let mut lower = black_box(part.wrapping_add(3 * tile.row_stride));
                for _ in 0..tile.inner {
                    if AHEAD & (if half == 0 { LEFT } else { RIGHT }) != 0 {
                        _mm_prefetch::<_MM_HINT_T1>(ahead.cast());
                    }
                    ahead = ahead.wrapping_add(tile.right_inner);
                    let low = _mm256_loadu_ps(right);
                    let high = _mm256_loadu_ps(right.add(8));
                    for (row, pair) in sums.iter_mut().enumerate() {
                        let from = if row < 3 {
                            left.wrapping_add(row * tile.row_stride)
                        } else {
                            lower.wrapping_add((row - 3) * tile.row_stride)
                        };
                        let factor = _mm256_set1_ps(*from);
                        pair[0] = _mm256_fmadd_ps(factor, low, pair[0]);
                        pair[1] = _mm256_fmadd_ps(factor, high, pair[1]);
                    }
                    left = left.wrapping_add(tile.left_inner);
                    lower = lower.wrapping_add(tile.left_inner);
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
