//! Rounding by the instructions for it, many numbers at a time, and the tile of pairs.

use std::arch::x86_64::{
    __m128i, __m256bh, __m256i, __m512bh, __m512i, _MM_HINT_T0, _mm_loadu_si128, _mm_prefetch,
    _mm256_storeu_si256, _mm512_add_ps, _mm512_cvtepi32_ps, _mm512_cvtepu8_epi32,
    _mm512_cvtne2ps_pbh, _mm512_cvtneps_pbh, _mm512_loadu_ps, _mm512_max_ps, _mm512_min_ps,
    _mm512_mul_ps, _mm512_set1_ps, _mm512_storeu_si512,
};
use std::mem::transmute;

use crate::networks::cpu::bfloat16::number::{Pair, normalised, rounded};
use crate::networks::cpu::tile::{Ahead, Finish, Tile};

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

/// How far ahead pixels are asked for: some hundreds of cycles of work.
const PIXELS_AHEAD: usize = 2048;

#[target_feature(enable = "avx512f,avx512bf16,avx512vl")]
pub fn round_pixels(pixels: &[u8], scale: &[f32], shift: &[f32], out: &mut [u16]) {
    let (pixels, (out, last)) = (pixels.as_chunks::<16>(), out.as_chunks_mut::<16>());
    let (scale, shift) = (scale.as_chunks::<16>(), shift.as_chunks::<16>());
    let (least, most) = (_mm512_set1_ps(-5.0), _mm512_set1_ps(5.0));
    for (((out, pixels), scales), shifts) in out.iter_mut().zip(pixels.0).zip(scale.0).zip(shift.0)
    {
        // SAFETY: every pointer is that of a whole array; a register of rounded numbers is any
        // bits.
        unsafe {
            // The pixels of a rollout are in no cache by now.
            _mm_prefetch::<_MM_HINT_T0>(pixels.as_ptr().wrapping_add(PIXELS_AHEAD).cast());
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
    for (((out, pixel), scale), shift) in last.iter_mut().zip(pixels.1).zip(scale.1).zip(shift.1) {
        *out = (rounded(normalised(*pixel, *scale, *shift)) >> 16) as u16;
    }
}

#[target_feature(enable = "avx512f,avx512bf16")]
pub unsafe fn tile_of<const ROWS: usize, const AHEAD: u8>(
    tile: Tile,
    mut part: *const u16,
    mut right: *const Pair,
    mut ahead: *const Pair,
    out: *mut f32,
) {
    use std::arch::x86_64::{
        __m512bh, __m512i, _MM_HINT_T1, _mm_prefetch, _mm512_add_ps, _mm512_dpbf16_ps,
        _mm512_loadu_ps, _mm512_loadu_si512, _mm512_set1_epi32, _mm512_setzero_ps,
        _mm512_storeu_ps,
    };
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
