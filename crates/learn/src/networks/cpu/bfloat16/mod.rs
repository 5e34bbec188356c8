//! Products in bfloat16: both factors are rounded to the upper 16 bits of a 32-bit number, to the
//! nearest and to even ones where two are as near; sums are numbers of 32 bits.
//!
//! An inner index stands for a pair of terms. A sum goes on pair by pair, in each by the second
//! term and then by the first, and each of the two is one fused multiplication and addition. That
//! is what `vdpbf16ps` is documented to do; a numeral below 2^-126 counts as zero, in factors and
//! in sums. So bits are equal on all processors that have it, and equal to those of plain fused
//! arithmetic wherever no such number occurs.
//!
//! The family of AMX adds up otherwise, as `tdpbf16ps` is documented to: of up to 16 pairs at a
//! time the first terms apart and the second terms apart, each from zero on, then the two together,
//! and that to the sum so far. Its bits are equal on all processors that have it.
//!
//! What is rounded is what a product reads: weights, activations and gradients themselves stay
//! numbers of 32 bits, and all other arithmetic is that of the other families.

use crate::networks::cpu::tile::Tile;
use crate::networks::cpu::vectorised::{kernel_files, vectorised};
use hasard_engine::simd::{Family, Simd};

kernel_files!(amx, avx512);
mod number;
#[cfg(test)]
mod tests;

pub use number::Pair;
use number::{normalised, pair, rounded};

/// Rounds numbers one by one.
pub fn round(kernels: Simd, from: &[f32], to: &mut [u16]) {
    #[cfg(target_arch = "x86_64")]
    if kernels.family().rounds() {
        // SAFETY: a `Simd` value proves that the processor has the instructions.
        return unsafe { avx512::round(from, to) };
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
    if kernels.family().rounds() {
        // SAFETY: a `Simd` value proves that the processor has the instructions.
        return unsafe { avx512::round_pixels(pixels, scale, shift, out) };
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

/// Ends a product: what a unit keeps from tile to tile is given back.
#[inline]
pub(super) fn end(kernels: Simd) {
    #[cfg(target_arch = "x86_64")]
    if kernels.family() == Family::AmxBf16 {
        amx::release();
    }
    let _ = kernels;
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
        use crate::networks::cpu::tile::Ahead;
        if kernels.family() == Family::AmxBf16 {
            // SAFETY: as the caller promised; a `Simd` value proves that the processor has the
            // instructions.
            return unsafe { amx::tile_of(tile, height, left, right, out) };
        }
        assert!(kernels.family() == Family::Avx512Bf16, "a product of pairs by {kernels}");
        let next = right.wrapping_add(tile.next);
        const LEFT: u8 = Ahead::LeftHalf as u8;
        const RIGHT: u8 = Ahead::RightHalf as u8;
        macro_rules! heights {
            ($($height:literal)*) => {
                match (height, tile.ahead) {
                    // SAFETY: as the caller promised; a `Simd` value proves that the processor has
                    // the instructions.
                    $(($height, Ahead::Nothing) => unsafe { avx512::tile_of::<$height, 0>(tile, left, right, next, out) },)*
                    // SAFETY: as above.
                    $(($height, Ahead::LeftHalf) => unsafe { avx512::tile_of::<$height, LEFT>(tile, left, right, next, out) },)*
                    // SAFETY: as above.
                    $(($height, Ahead::RightHalf) => unsafe { avx512::tile_of::<$height, RIGHT>(tile, left, right, next, out) },)*
                    // SAFETY: as above.
                    $(($height, Ahead::Everything) => unsafe {
                        avx512::tile_of::<$height, { LEFT | RIGHT }>(tile, left, right, next, out);
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
