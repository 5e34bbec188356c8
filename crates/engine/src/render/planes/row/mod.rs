//! Texture positions along a row of a floor, several pixels at a time.
//!
//! The positions of a chunk of pixels are those of the one before plus a constant (see [`CHUNK`]), so that vector
//! additions replace a multiplication a pixel; the compiler takes them apart again unless they are spelt out. Where the
//! processor's vectors are not known, plain arithmetic does the same; a test compares the two.

#[cfg(target_arch = "x86_64")]
pub mod vector;

use crate::render::blocks::CHUNK;

/// Texture positions along a row, as fractions of the texture's side with 32 bits: linear in the base column.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowWalk {
    /// At base column 0, to the right.
    pub u: u32,
    /// At base column 0, down.
    pub v: u32,
    /// Changes a base column.
    pub u_step: u32,
    pub v_step: u32,
}

/// Index of a position in a texture of side `2^BITS`, column by column.
#[inline(always)]
fn index<const BITS: u32>(u: u32, v: u32) -> u32 {
    (u >> (32 - BITS)) << BITS | v >> (32 - BITS)
}

impl RowWalk {
    #[inline(always)]
    fn at(&self, column: u32) -> (u32, u32) {
        let u = self.u.wrapping_add(self.u_step.wrapping_mul(column));
        (u, self.v.wrapping_add(self.v_step.wrapping_mul(column)))
    }

    /// Fills the pixels of the base columns `columns` with what `fetch` gives for the index into a square texture of
    /// side `2^BITS`, at most 128. `stride` is what the base column rises by over a chunk.
    #[inline(always)]
    pub fn draw<const BITS: u32>(&self, pixels: &mut [u8], columns: &[u32], stride: u32, fetch: impl Fn(usize) -> u8 + Copy) {
        let whole = pixels.len() / CHUNK * CHUNK;
        let (chunks, rest) = pixels.split_at_mut(whole);
        if let Some(first) = columns.first_chunk::<CHUNK>()
            && whole > 0
        {
            self.draw_chunks::<BITS>(chunks, first, stride, fetch);
        }
        for (pixel, &column) in rest.iter_mut().zip(&columns[whole..]) {
            let (u, v) = self.at(column);
            *pixel = fetch(index::<BITS>(u, v) as usize);
        }
    }

    #[cfg(not(target_arch = "x86_64"))]
    #[inline(always)]
    fn draw_chunks<const BITS: u32>(
        &self,
        pixels: &mut [u8],
        columns: &[u32; CHUNK],
        stride: u32,
        fetch: impl Fn(usize) -> u8 + Copy,
    ) {
        self.draw_chunks_plainly::<BITS>(pixels, columns, stride, fetch);
    }

    /// What [`RowWalk::draw_chunks`] does, in plain arithmetic.
    #[cfg(any(test, not(target_arch = "x86_64")))]
    fn draw_chunks_plainly<const BITS: u32>(
        &self,
        pixels: &mut [u8],
        columns: &[u32; CHUNK],
        stride: u32,
        fetch: impl Fn(usize) -> u8 + Copy,
    ) {
        let mut columns = *columns;
        for chunk in pixels.chunks_exact_mut(CHUNK) {
            for (pixel, column) in chunk.iter_mut().zip(&mut columns) {
                let (u, v) = self.at(*column);
                *pixel = fetch(index::<BITS>(u, v) as usize);
                *column = column.wrapping_add(stride);
            }
        }
    }

    /// Fills whole chunks, the first of which has the given base columns.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn draw_chunks<const BITS: u32>(
        &self,
        pixels: &mut [u8],
        columns: &[u32; CHUNK],
        stride: u32,
        fetch: impl Fn(usize) -> u8 + Copy,
    ) {
        // SAFETY: every x86-64 has these vectors; nothing else about the function is unsafe.
        unsafe { self.draw_chunks_by_vectors::<BITS>(pixels, columns, stride, fetch) }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "sse2")]
    #[inline]
    fn draw_chunks_by_vectors<const BITS: u32>(
        &self,
        pixels: &mut [u8],
        columns: &[u32; CHUNK],
        stride: u32,
        fetch: impl Fn(usize) -> u8 + Copy,
    ) {
        use std::arch::x86_64::{
            _mm_add_epi32, _mm_cvtsi32_si128, _mm_cvtsi128_si64, _mm_or_si128, _mm_packs_epi32, _mm_set_epi32, _mm_set1_epi32,
            _mm_sll_epi32, _mm_srl_epi32, _mm_unpackhi_epi64,
        };
        let positions = columns.map(|column| self.at(column));
        let u = |i: usize| positions[i].0 as i32;
        let v = |i: usize| positions[i].1 as i32;
        let mut us = [_mm_set_epi32(u(3), u(2), u(1), u(0)), _mm_set_epi32(u(7), u(6), u(5), u(4))];
        let mut vs = [_mm_set_epi32(v(3), v(2), v(1), v(0)), _mm_set_epi32(v(7), v(6), v(5), v(4))];
        let u_stride = _mm_set1_epi32(self.u_step.wrapping_mul(stride) as i32);
        let v_stride = _mm_set1_epi32(self.v_step.wrapping_mul(stride) as i32);
        let (fraction, side) = (_mm_cvtsi32_si128(32 - BITS as i32), _mm_cvtsi32_si128(BITS as i32));
        for chunk in pixels.chunks_exact_mut(CHUNK) {
            let indices = [0, 1].map(|i| {
                let column = _mm_sll_epi32(_mm_srl_epi32(us[i], fraction), side);
                _mm_or_si128(column, _mm_srl_epi32(vs[i], fraction))
            });
            us = us.map(|u| _mm_add_epi32(u, u_stride));
            vs = vs.map(|v| _mm_add_epi32(v, v_stride));
            // Indices are below 2^15, so that signed saturation leaves them alone.
            let packed = _mm_packs_epi32(indices[0], indices[1]);
            let halves = [packed, _mm_unpackhi_epi64(packed, packed)].map(|half| _mm_cvtsi128_si64(half) as u64);
            let (low, high) = chunk.split_at_mut(CHUNK / 2);
            for (pixels, half) in [(low, halves[0]), (high, halves[1])] {
                for (i, pixel) in pixels.iter_mut().enumerate() {
                    *pixel = fetch(usize::from((half >> (16 * i)) as u16));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rng;

    #[test]
    fn vectors_and_plain_arithmetic_agree() {
        let mut rng = Rng::new(77);
        for round in 0..200 {
            let mut any = || rng.next_u64() as u32;
            let walk = RowWalk { u: any(), v: any(), u_step: any(), v_step: any() };
            let (first, stride) = (round % 13, if round % 2 == 0 { 8 } else { 10 });
            let columns: Vec<u32> = (0..200).map(|x| (x + first) * stride / 8).collect();
            let columns = &columns[..];
            let length = (any() % 200) as usize;
            let fetch = |index: usize| (index * 31 + index / 256) as u8;
            let mut pixels = vec![0; length];
            walk.draw::<6>(&mut pixels, &columns[..length], stride, fetch);
            let plain = |x: usize| {
                let (u, v) = walk.at(columns[x]);
                fetch(index::<6>(u, v) as usize)
            };
            if columns.windows(CHUNK + 1).all(|w| w[CHUNK] == w[0] + stride) {
                assert!(pixels.iter().enumerate().all(|(x, &pixel)| pixel == plain(x)));
            }
            let (mut vector, mut scalar) = (vec![0; 128], vec![0; 128]);
            let chunk = columns.first_chunk().unwrap();
            walk.draw_chunks::<7>(&mut vector, chunk, stride, fetch);
            walk.draw_chunks_plainly::<7>(&mut scalar, chunk, stride, fetch);
            assert_eq!(vector, scalar);
        }
    }

    #[test]
    #[cfg(target_arch = "x86_64")]
    fn groups_of_pixels_are_those_one_by_one() {
        use crate::render::planes::row::vector::{ROW_GROUP, draw};
        use crate::simd::{Level, Simd};
        if !Simd::available().iter().any(|simd| simd.level() >= Level::Avx2) {
            return;
        }
        let mut rng = Rng::new(78);
        let table: [u8; 256] = std::array::from_fn(|_| rng.byte() as u8);
        let small: [u8; 64 * 64] = std::array::from_fn(|_| rng.byte() as u8);
        let large: Vec<u8> = (0..128 * 128).map(|_| rng.byte() as u8).collect();
        let large: &[u8; 128 * 128] = large[..].try_into().unwrap();
        let columns: Vec<u32> = (0..200).map(|x| x * 5 / 4).collect();
        for round in 0..2000 {
            let mut any = || rng.next_u64() as u32;
            let walk = RowWalk { u: any(), v: any(), u_step: any(), v_step: any() };
            let (first, count) = ((any() % 100) as usize, (any() % 90) as usize);
            let before: Vec<u8> = (0..count + ROW_GROUP).map(|_| any() as u8).collect();
            let (mut plain, mut wide) = (before.clone(), before);
            let (own, chunk) = (&columns[first..first + count], columns[first..].first_chunk().unwrap());
            // SAFETY: the processor has the instructions, see above.
            unsafe {
                if round % 2 == 0 {
                    walk.draw::<6>(&mut plain[..count], own, 10, |index| table[usize::from(small[index])]);
                    draw::<6, { 64 * 64 }>(&walk, &mut wide, count, chunk, 10, (&small, &table));
                } else {
                    walk.draw::<7>(&mut plain[..count], own, 10, |index| table[usize::from(large[index])]);
                    draw::<7, { 128 * 128 }>(&walk, &mut wide, count, chunk, 10, (large, &table));
                }
            }
            assert_eq!(wide, plain, "{count} pixels from column {first}");
        }
    }
}
