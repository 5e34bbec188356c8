//! One column of a midtexture: a texture with holes in an opening.

crate::simd::kernel_files!(avx2);
pub mod data;
mod scalar;

use crate::simd::{Simd, dispatch};
use data::MidColumn;
use std::ops::Range;

/// Gives the frame rows of `rows` that show a texel and their colours to `put`; `base_rows` are the
/// base rows, padded.
#[inline(always)]
pub(crate) fn draw(
    column: &MidColumn,
    simd: Simd,
    base_rows: &[u32],
    rows: Range<usize>,
    put: impl FnMut(usize, u8),
) {
    dispatch!(simd;
        avx512 if !rows.is_empty() && avx2::fits(column, base_rows[rows.end - 1]) => avx2::draw(column, base_rows, rows, put),
        avx2 if !rows.is_empty() && avx2::fits(column, base_rows[rows.end - 1]) => avx2::draw(column, base_rows, rows, put),
        scalar => scalar::draw(column, base_rows, rows, put),
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rng;
    use crate::render::blocks::ROW_PADDING;
    use crate::render::sprites::posts::PostProjection;
    use crate::render::textures::local_palette::LocalPalette;
    use crate::render::textures::midtexture::Post;
    use crate::render::textures::midtexture::{is_opaque, posts_of};

    #[test]
    fn all_ways_show_the_same_rows() {
        let mut rng = Rng::new(14);
        let table: [u8; 256] = std::array::from_fn(|_| rng.byte() as u8);
        for round in 0..3000 {
            let height = [128, 72, 64, 33, 1, 200][round % 6];
            let length = [60u32, 100, 403][round / 6 % 3];
            let texels: Vec<u16> = (0..height).map(|_| rng.below(512) as u16).collect();
            let runs: Vec<Post> = posts_of(texels.iter().map(is_opaque)).collect();
            let base_rows: Vec<u32> = (0..length.next_multiple_of(64) + ROW_PADDING as u32)
                .map(|row| row * 5 / 3)
                .collect();
            let step = i64::from(rng.between(1, 1 << 30)) << rng.below(4);
            let at = i64::from(rng.between(-100, 100)) << 32;
            let hung = PostProjection {
                horizon: i64::from(rng.between(-100, 200)) << 16,
                eye: at >> 16,
                scale: (1 << 32) / (step >> 16).max(3),
            };
            let pixels: Vec<u8> =
                texels.iter().map(|&texel| texel as u8 % [16, 64, 255][round / 18 % 3]).collect();
            let texels: Vec<u16> = texels
                .iter()
                .zip(&pixels)
                .map(|(&texel, &pixel)| texel & 0x100 | u16::from(pixel))
                .collect();
            let own = LocalPalette::new(&pixels, &[table]);
            let (local_texels, lit) = (&own.texels[..], own.lit(0));
            let column = MidColumn {
                texels: &texels,
                table: &table,
                local_texels,
                lit,
                at,
                step,
                runs: &runs,
                hung,
            };
            let (a, b) = (rng.below(length + 1) as usize, rng.below(length + 1) as usize);
            let shown = |simd: Simd| {
                let mut list = Vec::new();
                draw(&column, simd, &base_rows, a.min(b)..a.max(b), |row, colour| {
                    list.push((row, colour))
                });
                list
            };
            // Each row on its own: its texel, and from where to where there are no holes around it.
            let expected: Vec<(usize, u8)> = (a.min(b)..a.max(b))
                .filter_map(|row| {
                    let v = ((at + step * i64::from(base_rows[row])) >> 32)
                        .clamp(0, height as i64 - 1) as usize;
                    let above =
                        texels[..=v].iter().rev().take_while(|texel| is_opaque(texel)).count();
                    let below = texels[v..].iter().take_while(|texel| is_opaque(texel)).count();
                    let begun = || {
                        i64::from(base_rows[row])
                            >= hung.first_row([v + 1 - above, v + below].map(|texel| texel as u16))
                    };
                    (above > 0 && begun()).then(|| (row, table[usize::from(texels[v] as u8)]))
                })
                .collect();
            Simd::available()
                .into_iter()
                .for_each(|simd| assert_eq!(shown(simd), expected, "{simd:?}"));
        }
    }
}
