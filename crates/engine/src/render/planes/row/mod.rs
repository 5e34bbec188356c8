//! A row of a floor: its texture positions, several pixels at a time.
//!
//! The positions of a chunk of pixels are those of the one before plus a constant (see [`CHUNK`]),
//! so that vector additions replace a multiplication a pixel.

crate::simd::kernel_files!(avx2, avx512, sse2);
pub mod data;
#[cfg_attr(
    target_arch = "x86_64",
    allow(dead_code, reason = "every x86-64 has the vectors of sse2")
)]
mod scalar;

use crate::render::blocks::CHUNK;
use data::{RowWalk, index};

/// Fills the pixels of the base columns `columns` with what `fetch` gives for the index into a
/// square texture of side `2^BITS`, at most 128. `stride` is what the base column rises by over a
/// chunk.
#[inline(always)]
pub(crate) fn draw<const BITS: u32>(
    walk: &RowWalk,
    pixels: &mut [u8],
    columns: &[u32],
    stride: u32,
    fetch: impl Fn(usize) -> u8 + Copy,
) {
    let whole = pixels.len() / CHUNK * CHUNK;
    let (chunks, rest) = pixels.split_at_mut(whole);
    if let Some(first) = columns.first_chunk::<CHUNK>()
        && whole > 0
    {
        draw_chunks::<BITS>(walk, chunks, first, stride, fetch);
    }
    for (pixel, &column) in rest.iter_mut().zip(&columns[whole..]) {
        let (u, v) = walk.at(column);
        *pixel = fetch(index::<BITS>(u, v) as usize);
    }
}

/// Fills whole chunks, the first of which has the given base columns.
#[inline(always)]
fn draw_chunks<const BITS: u32>(
    walk: &RowWalk,
    pixels: &mut [u8],
    columns: &[u32; CHUNK],
    stride: u32,
    fetch: impl Fn(usize) -> u8 + Copy,
) {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: every x86-64 has these vectors; nothing else about the function is unsafe.
    unsafe {
        sse2::draw_chunks::<BITS>(walk, pixels, columns, stride, fetch);
    }
    #[cfg(not(target_arch = "x86_64"))]
    scalar::draw_chunks::<BITS>(walk, pixels, columns, stride, fetch);
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
            draw::<6>(&walk, &mut pixels, &columns[..length], stride, fetch);
            let plain = |x: usize| {
                let (u, v) = walk.at(columns[x]);
                fetch(index::<6>(u, v) as usize)
            };
            if columns.windows(CHUNK + 1).all(|w| w[CHUNK] == w[0] + stride) {
                assert!(pixels.iter().enumerate().all(|(x, &pixel)| pixel == plain(x)));
            }
            let (mut vector, mut scalar) = (vec![0; 128], vec![0; 128]);
            let chunk = columns.first_chunk().unwrap();
            draw_chunks::<7>(&walk, &mut vector, chunk, stride, fetch);
            scalar::draw_chunks::<7>(&walk, &mut scalar, chunk, stride, fetch);
            assert_eq!(vector, scalar);
        }
    }

    #[test]
    #[cfg(target_arch = "x86_64")]
    fn groups_of_pixels_are_those_one_by_one() {
        use crate::simd::{Level, Simd};
        use avx2::ROW_GROUP;
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
            let (own, chunk) =
                (&columns[first..first + count], columns[first..].first_chunk().unwrap());
            // SAFETY: the processor has the instructions, see above.
            unsafe {
                if round % 2 == 0 {
                    draw::<6>(&walk, &mut plain[..count], own, 10, |index| {
                        table[usize::from(small[index])]
                    });
                    avx2::draw::<6, { 64 * 64 }>(
                        &walk,
                        &mut wide,
                        count,
                        chunk,
                        10,
                        (&small, &table),
                    );
                } else {
                    draw::<7>(&walk, &mut plain[..count], own, 10, |index| {
                        table[usize::from(large[index])]
                    });
                    avx2::draw::<7, { 128 * 128 }>(
                        &walk,
                        &mut wide,
                        count,
                        chunk,
                        10,
                        (large, &table),
                    );
                }
            }
            assert_eq!(wide, plain, "{count} pixels from column {first}");
        }
    }
}
