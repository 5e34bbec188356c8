//! One column of a texture with holes in an opening.

#[cfg(target_arch = "x86_64")]
pub mod avx2;

use crate::render::textures::midtexture::{Hung, Run};
#[cfg(target_arch = "x86_64")]
use crate::simd::Level;
use crate::simd::Simd;
#[cfg(target_arch = "x86_64")]
use crate::simd::lookup::avx2::GROUP;
use std::ops::Range;

/// A column on its way to the frame.
pub(crate) struct MaskedColumn<'a> {
    /// Palette indices in the low bytes.
    pub texels: &'a [u16],
    pub table: &'a [u8; 256],
    /// The same by the picture's own colours.
    #[cfg_attr(not(target_arch = "x86_64"), allow(dead_code, reason = "wide code alone picks colours so"))]
    pub own_texels: &'a [u8],
    /// These colours as they are lit.
    #[cfg_attr(not(target_arch = "x86_64"), allow(dead_code, reason = "wide code alone picks colours so"))]
    pub lit: &'a [u8],
    /// Texture row at base row 0 and its change a base row, 32 fractional bits.
    pub at: i64,
    pub step: i64,
    /// From top to bottom.
    pub runs: &'a [Run],
    pub hung: Hung,
}

impl MaskedColumn<'_> {
    /// Start of the run that a base row shows.
    pub fn run_at(&self, base_row: u32) -> u16 {
        let texel = self.texel_at(base_row) as u16;
        self.runs.iter().find(|[_, end]| texel < *end).map_or(0, |&[start, _]| start)
    }

    /// The texel of a base row.
    #[inline(always)]
    fn texel_at(&self, base_row: u32) -> usize {
        let v = (self.at + self.step * i64::from(base_row)) >> 32;
        v.clamp(0, self.texels.len() as i64 - 1) as usize
    }

    /// Gives the frame rows of `rows` that show a texel and their colours to `put`; `base_rows` are the base rows, padded.
    #[inline(always)]
    pub fn draw(&self, simd: Simd, base_rows: &[u32], rows: Range<usize>, mut put: impl FnMut(usize, u8)) {
        #[cfg(target_arch = "x86_64")]
        if simd.level() >= Level::Avx2 && !rows.is_empty() && avx2::fits(self, base_rows[rows.end - 1]) {
            let mut row = rows.start;
            while row < rows.end {
                let base_rows = base_rows[row..].first_chunk().expect("lists by row are padded");
                // SAFETY: whoever has this `Simd` has the instructions.
                let (colours, mut shown) = unsafe { avx2::block(self, base_rows) };
                shown &= u32::MAX >> GROUP.saturating_sub(rows.end - row);
                while shown != 0 {
                    let i = shown.trailing_zeros() as usize;
                    put(row + i, colours[i]);
                    shown &= shown - 1;
                }
                row += GROUP;
            }
            return;
        }
        #[cfg(not(target_arch = "x86_64"))]
        let _ = simd;
        // Further down there are no texels further up.
        let (mut runs, mut run, mut first_row) = (self.runs.iter(), [0, 0], i64::MAX);
        for row in rows {
            let v = self.texel_at(base_rows[row]);
            while v >= usize::from(run[1]) {
                let Some(&next) = runs.next() else { return };
                (run, first_row) = (next, self.hung.first_row(next));
            }
            if v >= usize::from(run[0]) && i64::from(base_rows[row]) >= first_row {
                put(row, self.table[usize::from(self.texels[v] as u8)]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rng;
    use crate::render::blocks::ROW_PADDING;
    use crate::render::textures::local_palette::OwnColours;
    use crate::render::textures::midtexture::{is_opaque, runs_of};

    #[test]
    fn all_ways_show_the_same_rows() {
        let mut rng = Rng::new(14);
        let table: [u8; 256] = std::array::from_fn(|_| rng.byte() as u8);
        for round in 0..3000 {
            let height = [128, 72, 64, 33, 1, 200][round % 6];
            let length = [60u32, 100, 403][round / 6 % 3];
            let texels: Vec<u16> = (0..height).map(|_| rng.below(512) as u16).collect();
            let runs: Vec<Run> = runs_of(texels.iter().map(is_opaque)).collect();
            let base_rows: Vec<u32> = (0..length.next_multiple_of(64) + ROW_PADDING as u32).map(|row| row * 5 / 3).collect();
            let step = i64::from(rng.between(1, 1 << 30)) << rng.below(4);
            let at = i64::from(rng.between(-100, 100)) << 32;
            let hung =
                Hung { horizon: i64::from(rng.between(-100, 200)) << 16, eye: at >> 16, scale: (1 << 32) / (step >> 16).max(3) };
            let pixels: Vec<u8> = texels.iter().map(|&texel| texel as u8 % [16, 64, 255][round / 18 % 3]).collect();
            let texels: Vec<u16> = texels.iter().zip(&pixels).map(|(&texel, &pixel)| texel & 0x100 | u16::from(pixel)).collect();
            let own = OwnColours::new(&pixels, &[table]);
            let (own_texels, lit) = (&own.texels[..], own.lit(0));
            let column = MaskedColumn { texels: &texels, table: &table, own_texels, lit, at, step, runs: &runs, hung };
            let (a, b) = (rng.below(length + 1) as usize, rng.below(length + 1) as usize);
            let shown = |simd: Simd| {
                let mut list = Vec::new();
                column.draw(simd, &base_rows, a.min(b)..a.max(b), |row, colour| list.push((row, colour)));
                list
            };
            // Each row on its own: its texel, and from where to where there are no holes around it.
            let expected: Vec<(usize, u8)> = (a.min(b)..a.max(b))
                .filter_map(|row| {
                    let v = ((at + step * i64::from(base_rows[row])) >> 32).clamp(0, height as i64 - 1) as usize;
                    let above = texels[..=v].iter().rev().take_while(|texel| is_opaque(texel)).count();
                    let below = texels[v..].iter().take_while(|texel| is_opaque(texel)).count();
                    let begun =
                        || i64::from(base_rows[row]) >= hung.first_row([v + 1 - above, v + below].map(|texel| texel as u16));
                    (above > 0 && begun()).then(|| (row, table[usize::from(texels[v] as u8)]))
                })
                .collect();
            Simd::available().into_iter().for_each(|simd| assert_eq!(shown(simd), expected, "{simd:?}"));
        }
    }
}
