//! One column of a wall, drawn into a frame that lies column by column.

crate::simd::kernel_files!(avx2, avx512);
pub mod data;
mod scalar;

use crate::simd::{Simd, dispatch};
use data::Column;

/// Draws the frame rows `top..bottom` of a column; `rows` are the base rows. Both lists are padded.
/// With vectors of 32 bytes whole walls are worked out side by side where they fit: `walls::shade`
/// calls that variant.
#[inline(always)]
pub(crate) fn draw(
    column: &Column,
    simd: Simd,
    pixels: &mut [u8],
    rows: &[u32],
    top: usize,
    bottom: usize,
) {
    match column.texels.len() {
        128 => {
            dispatch!(simd; avx512 => avx512::draw::<7>(column, pixels, rows, top, bottom), scalar => scalar::draw(column, pixels, rows, top, bottom))
        }
        64 => {
            dispatch!(simd; avx512 => avx512::draw::<6>(column, pixels, rows, top, bottom), scalar => scalar::draw(column, pixels, rows, top, bottom))
        }
        _ => scalar::draw(column, pixels, rows, top, bottom),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rng;
    use crate::render::blocks::{ROW_BLOCK, ROW_PADDING};

    #[test]
    fn all_ways_draw_the_same_columns() {
        let mut rng = Rng::new(4);
        let tables: [[u8; 256]; 2] =
            std::array::from_fn(|_| std::array::from_fn(|_| rng.byte() as u8));
        for round in 0..1000 {
            let height = [64, 128, 96][round % 3];
            let length = [60usize, 100, 403][round / 3 % 3];
            let padded = length.next_multiple_of(ROW_BLOCK);
            // Few colours, some, and many.
            let colours = [15, 63, 255][round % 7 % 3];
            let texels: Vec<u8> =
                (0..2 * height).map(|_| (rng.byte() as u8 & colours).wrapping_mul(3)).collect();
            let rows: Vec<u32> =
                (0..(padded + ROW_PADDING) as u32).map(|row| row * 5 / 3).collect();
            let before: Vec<u8> = (0..padded).map(|_| rng.byte() as u8).collect();
            let (at, step) = (rng.next_u64() as u32, rng.next_u64() as u32 >> rng.between(4, 12));
            for _ in 0..6 {
                let (a, b) =
                    (rng.below(length as u32 + 1) as usize, rng.below(length as u32 + 1) as usize);
                let column = Column {
                    texels: &texels[[0, height][rng.below(2) as usize]..][..height],
                    table: &tables[rng.below(2) as usize],
                    at: at.wrapping_add(rng.next_u64() as u32 >> 7),
                    step: step + (rng.next_u64() as u32 >> 16),
                };
                let mut plain = before.clone();
                let (top, bottom) = (a.min(b), a.max(b));
                scalar::draw(&column, &mut plain, &rows, top, bottom);
                let compare = |draw: &mut dyn FnMut(&mut [u8]), name: &str| {
                    let mut pixels = before.clone();
                    draw(&mut pixels);
                    assert_eq!(
                        pixels, plain,
                        "{name}, rows {a} and {b} of {length}, texture of {height}"
                    );
                };
                for simd in Simd::available() {
                    compare(
                        &mut |pixels| draw(&column, simd, pixels, &rows, top, bottom),
                        simd.name(),
                    );
                    #[cfg(target_arch = "x86_64")]
                    if simd.level() == crate::simd::Level::Avx2 && height != 96 {
                        compare(
                            &mut |pixels| {
                                avx2::draw_by_own_colours(&column, pixels, &rows, top, bottom)
                            },
                            "by own colours",
                        );
                    }
                }
            }
        }
    }
}
