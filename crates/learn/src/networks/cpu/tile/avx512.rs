//! A tile in registers of 64 bytes.

use crate::networks::cpu::tile::data::{Finish, LEFT, RIGHT, Tile};

#[target_feature(enable = "avx512f")]
pub unsafe fn tile<const ROWS: usize, const AHEAD: u8>(
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
    // SAFETY: see [`Tile::run`]; a prefetch of any address is harmless.
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
