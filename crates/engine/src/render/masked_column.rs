//! One column of a texture with holes in an opening.

use super::fence::{Hung, Runs};
#[cfg(target_arch = "x86_64")]
use super::masked_wide;
#[cfg(target_arch = "x86_64")]
use crate::simd::Level;
use crate::simd::Simd;
use std::ops::Range;

/// Rows that are worked out at once at most.
pub(super) const MASKED_BLOCK: usize = 64;

/// A column on its way to the frame.
pub(super) struct MaskedColumn<'a> {
    /// Palette indices in the low bytes.
    pub texels: &'a [u16],
    pub table: &'a [u8; 256],
    /// Texture row at base row 0 and its change a base row, 32 fractional bits.
    pub at: i64,
    pub step: i64,
    pub runs: Runs<'a>,
    pub hung: Hung,
}

impl MaskedColumn<'_> {
    /// Start of the run that a base row shows.
    pub fn run_at(&self, base_row: u32) -> u16 {
        self.runs.starts[self.texel_at(base_row)]
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
        if simd.level() == Level::Avx512 && self.texels.len() <= masked_wide::MOST_TEXELS {
            for first in (rows.start / MASKED_BLOCK * MASKED_BLOCK..rows.end).step_by(MASKED_BLOCK) {
                let base_rows = base_rows[first..].first_chunk().expect("lists by row are padded");
                // SAFETY: whoever has this `Simd` has the instructions.
                let (colours, shown) = unsafe { masked_wide::block(self, base_rows) };
                let above = rows.start.saturating_sub(first);
                let below = (first + MASKED_BLOCK).saturating_sub(rows.end);
                let mut shown = shown & (u64::MAX << above) & (u64::MAX >> below);
                while shown != 0 {
                    let i = shown.trailing_zeros() as usize;
                    put(first + i, colours[i]);
                    shown &= shown - 1;
                }
            }
            return;
        }
        #[cfg(not(target_arch = "x86_64"))]
        let _ = simd;
        let (mut run, mut first_row) = ((0, 0), i64::MAX);
        for row in rows {
            let v = self.texel_at(base_rows[row]);
            let own = (self.runs.starts[v], self.runs.ends[v]);
            if own != run {
                (run, first_row) = (own, self.hung.first_row(own.0, own.1));
            }
            if i64::from(base_rows[row]) >= first_row {
                put(row, self.table[usize::from(self.texels[v] as u8)]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rng;
    use crate::render::fence::find_runs;

    #[test]
    fn all_ways_show_the_same_rows() {
        let mut rng = Rng::new(14);
        let table: [u8; 256] = std::array::from_fn(|_| rng.byte() as u8);
        for round in 0..3000 {
            let height = [128, 72, 64, 33, 1, 200][round % 6];
            let length = [60u32, 100, 403][round / 6 % 3];
            let texels: Vec<u16> = (0..height).map(|_| rng.below(512) as u16).collect();
            let (mut starts, mut ends) = (vec![0; texels.len()], vec![0; texels.len()]);
            find_runs(&texels, &mut starts, &mut ends);
            let runs = Runs { starts: &starts, ends: &ends };
            let base_rows: Vec<u32> = (0..length.next_multiple_of(64) + 8).map(|row| row * 5 / 3).collect();
            let step = i64::from(rng.between(1, 1 << 30)) << rng.below(4);
            let at = i64::from(rng.between(-100, 100)) << 32;
            let hung =
                Hung { horizon: i64::from(rng.between(-100, 200)) << 16, eye: at >> 16, scale: (1 << 32) / (step >> 16).max(3) };
            let column = MaskedColumn { texels: &texels, table: &table, at, step, runs, hung };
            let (a, b) = (rng.below(length + 1) as usize, rng.below(length + 1) as usize);
            let shown = |simd: Simd| {
                let mut list = Vec::new();
                column.draw(simd, &base_rows, a.min(b)..a.max(b), |row, colour| list.push((row, colour)));
                list
            };
            let plain = shown(Simd::PLAIN);
            Simd::available().into_iter().for_each(|simd| assert_eq!(shown(simd), plain, "{simd:?}"));
        }
    }
}
