//! A picture with holes put on the frame as it is: what sprites and weapons come down to.

#[cfg(target_arch = "x86_64")]
pub mod avx512;

use crate::render::buffers::frame::Frame;
use crate::render::colour::blend::Mixture;
use crate::render::textures::picture::MaskedPicture;
use crate::render::textures::sprite::SpritePicture;
use crate::render::view::tables::View;
#[cfg(target_arch = "x86_64")]
use crate::simd::Level;
use crate::simd::Simd;
use std::ops::Range;

/// Columns that are stamped at once at most: lists by column are that much longer than there are columns.
pub(crate) const STAMP_BLOCK: usize = 64;
/// More rows than these are searched for those of a column that show no air: in a learner's frame few sprites have so many.
const SEARCHED_ROWS: usize = 32;
/// Fractional bits of texture rows.
pub(crate) const TEXEL_BITS: u32 = 32;

/// The first frame row whose lower edge is at a texture row or below it; `v` and `v_step` as in [`Stamp`].
#[inline]
pub(crate) fn first_row(view: &View, texel: u32, v: i64, v_step: i64) -> i16 {
    let base = ((i64::from(texel) << TEXEL_BITS) - v + v_step - 1).div_euclid(v_step);
    view.first_row[base.clamp(0, i64::from(view.base_view_rows)) as usize]
}

/// The part of a frame that was covered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Covered {
    pub columns: [usize; 2],
    pub rows: [usize; 2],
}

impl Covered {
    pub const NOTHING: Covered = Covered { columns: [usize::MAX, 0], rows: [usize::MAX, 0] };

    /// Adds a part with pixels in its outermost columns and rows.
    #[inline(always)]
    pub fn add(&mut self, columns: Range<usize>, rows: Range<usize>) {
        self.columns = [self.columns[0].min(columns.start), self.columns[1].max(columns.end)];
        self.rows = [self.rows[0].min(rows.start), self.rows[1].max(rows.end)];
    }
}

/// What may be covered of each column of the picture at hand, and what it shows; memory that is reused.
#[derive(Clone, Debug, Default)]
pub(crate) struct StampColumns {
    /// First row; padded, as the others are.
    pub tops: Vec<i16>,
    /// One past the last row.
    pub bottoms: Vec<i16>,
    /// Column of the picture.
    pub texels: Vec<u16>,
}

impl StampColumns {
    /// Opens the rows `rows` of as many columns as `texels` gives columns of the picture.
    pub fn open(&mut self, rows: Range<i16>, texels: impl Iterator<Item = u16>) {
        self.texels.clear();
        self.texels.extend(texels);
        let padded = self.texels.len() + STAMP_BLOCK;
        self.texels.resize(padded, 0);
        self.tops.clear();
        self.tops.resize(padded, rows.start);
        self.bottoms.clear();
        self.bottoms.resize(padded, rows.end);
    }

    /// How many columns there are.
    pub fn count(&self) -> usize {
        self.texels.len() - STAMP_BLOCK
    }
}

/// A picture on its way to the frame.
pub(crate) struct Stamp<'a> {
    pub picture: &'a SpritePicture,
    pub table: &'a [u8; 256],
    /// First frame column.
    pub first: usize,
    pub columns: &'a StampColumns,
    /// Frame rows that show the picture where its columns are open.
    pub rows: Range<usize>,
    /// Texture row at base row 0, and its change a base row.
    pub v: i64,
    pub v_step: i64,
    /// For what is not opaque: what becomes of it and what is behind.
    pub mixture: Option<&'a Mixture>,
    pub depth: u8,
    pub class: u16,
}

impl Stamp<'_> {
    /// Draws it; `base_rows` are the base rows of the frame's.
    pub fn draw<const DEPTH: bool, const CLASS: bool>(&self, simd: Simd, frame: &mut Frame, base_rows: &[u32]) -> Covered {
        let count = self.columns.count();
        let top = self.columns.tops[..count].iter().min().map_or(0, |&top| top.max(0) as usize);
        let bottom = self.columns.bottoms[..count].iter().max().map_or(0, |&bottom| bottom.max(0) as usize);
        let rows = self.rows.start.max(top)..self.rows.end.min(bottom);
        #[cfg(target_arch = "x86_64")]
        if simd.level() == Level::Avx512 && self.picture.stride <= avx512::MOST_TEXELS {
            // SAFETY: whoever has this `Simd` has the instructions.
            return unsafe { avx512::draw::<DEPTH, CLASS>(self, frame, base_rows, rows) };
        }
        #[cfg(not(target_arch = "x86_64"))]
        let _ = simd;
        let mut covered = Covered::NOTHING;
        for i in 0..count {
            let (top, bottom) = (self.columns.tops[i].max(0) as usize, self.columns.bottoms[i].max(0) as usize);
            let open = rows.start.max(top)..rows.end.min(bottom);
            if !open.is_empty() {
                self.column_plainly::<DEPTH, CLASS>(frame, base_rows, i, open, &mut covered);
            }
        }
        covered
    }

    /// Texture row that a base row shows.
    #[inline(always)]
    pub fn texel_row(&self, base_row: u32) -> usize {
        ((self.v + self.v_step * i64::from(base_row)) >> TEXEL_BITS) as usize
    }

    fn column_plainly<const DEPTH: bool, const CLASS: bool>(
        &self,
        frame: &mut Frame,
        base_rows: &[u32],
        i: usize,
        mut open: Range<usize>,
        covered: &mut Covered,
    ) {
        let (x, width) = (self.first + i, frame.width);
        let texels = self.picture.column(self.columns.texels[i]);
        if open.len() > SEARCHED_ROWS {
            // Half of a weapon's picture is air above it.
            let extent = self.picture.extent(self.columns.texels[i]);
            let before = |texel: usize| base_rows[open.clone()].partition_point(|&base_row| self.texel_row(base_row) < texel);
            open = open.start + before(extent.start)..open.start + before(extent.end);
        }
        let lines = frame.colour[open.start * width..].chunks_exact_mut(width).zip(&base_rows[open.clone()]);
        // Which texels are holes cannot be foretold.
        match self.mixture {
            None => lines.for_each(|(line, &base_row)| {
                let texel = texels[self.texel_row(base_row)];
                let lit = self.table[usize::from(texel as u8)];
                line[x] = if texel & MaskedPicture::OPAQUE != 0 { lit } else { line[x] };
            }),
            Some(mixture) => lines.for_each(|(line, &base_row)| {
                let texel = texels[self.texel_row(base_row)];
                let lit = mixture.over(self.table[usize::from(texel as u8)], line[x]);
                line[x] = if texel & MaskedPicture::OPAQUE != 0 { lit } else { line[x] };
            }),
        }
        if !(DEPTH || CLASS) {
            return;
        }
        let (mut first, mut end) = (usize::MAX, 0);
        for row in open {
            let (opaque, at) = (texels[self.texel_row(base_rows[row])] & MaskedPicture::OPAQUE != 0, row * width + x);
            if DEPTH {
                let pixel = &mut frame.depth[at];
                *pixel = if opaque { self.depth } else { *pixel };
            }
            if CLASS {
                let pixel = &mut frame.class[at];
                *pixel = if opaque { self.class } else { *pixel };
                first = if opaque { first.min(row) } else { first };
                end = if opaque { row + 1 } else { end };
            }
        }
        if first < end {
            covered.add(x..x + 1, first..end);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::{Assets, Image};
    use crate::math::Rng;
    use crate::render::colour::blend::Blend;
    use crate::world::OPAQUE;

    #[test]
    fn all_ways_stamp_the_same_pixels() {
        let mut rng = Rng::new(6);
        let table: [u8; 256] = std::array::from_fn(|_| rng.byte() as u8);
        let blend = Blend::new(&Assets::embedded().palette);
        for round in 0..600 {
            let (width, height) = (1 + rng.below(300) as u16, 1 + rng.below(60) as u16);
            let texels = usize::from(width) * usize::from(height);
            let mut bytes = |count: usize| -> Box<[u8]> { (0..count).map(|_| rng.byte() as u8).collect() };
            let mask = (round % 4 > 0).then(|| bytes(texels).iter().map(|byte| byte & 1).collect());
            let image = Image { width, height, offset_x: 0, offset_y: 0, pixels: bytes(texels), mask };
            let picture = SpritePicture::new(&image);
            let (frame_width, frame_rows) = (160, 100usize);
            let pixels = frame_width * frame_rows;
            let before = Frame {
                width: frame_width,
                colour: bytes(pixels).to_vec(),
                depth: bytes(pixels).to_vec(),
                class: vec![7; pixels],
                ..Frame::default()
            };
            let first = rng.below(frame_width as u32) as usize;
            let count = rng.below((frame_width - first) as u32 + 1) as usize;
            let mut columns = StampColumns::default();
            columns.open(0..frame_rows as i16, (0..count).map(|i| (i * usize::from(width) / count) as u16));
            for i in 0..count {
                columns.tops[i] = rng.between(0, 60) as i16;
                columns.bottoms[i] = rng.between(0, 100) as i16;
            }
            let rows = rng.below(50) as usize..50 + rng.below(51) as usize;
            let base_rows: Vec<u32> = (0..frame_rows as u32).collect();
            // A little more than nothing at row 0, as much as the step loses in all rows by rounding.
            let (v, v_step) = (frame_rows as i64, (i64::from(height) << TEXEL_BITS) / frame_rows as i64);
            let opacity = rng.below(u32::from(OPAQUE) + 1) as u8;
            let stamp = Stamp {
                picture: &picture,
                table: &table,
                first,
                columns: &columns,
                rows,
                v,
                v_step,
                mixture: (round % 3 == 0).then(|| blend.mixture(opacity)),
                depth: 9,
                class: 33,
            };
            let mut plain = before.clone();
            let covered = stamp.draw::<true, true>(Simd::PLAIN, &mut plain, &base_rows);
            for row in 0..frame_rows {
                for x in 0..frame_width {
                    let i = x.wrapping_sub(first);
                    let inside = i < count
                        && stamp.rows.contains(&row)
                        && (columns.tops[i] as usize..columns.bottoms[i] as usize).contains(&row);
                    let texel = || usize::from(columns.texels[i]) * usize::from(height) + row * usize::from(height) / frame_rows;
                    let shown = inside && image.mask.as_ref().is_none_or(|mask| mask[texel()] != 0);
                    let at = row * frame_width + x;
                    let own = || table[usize::from(image.pixels[texel()])];
                    let colour = match (shown, stamp.mixture) {
                        (false, _) => before.colour[at],
                        (true, None) => own(),
                        (true, Some(_)) => blend.over(own(), before.colour[at], opacity),
                    };
                    assert_eq!((plain.colour[at], plain.class[at]), (colour, if shown { 33 } else { 7 }));
                }
            }
            for simd in Simd::available() {
                let mut wide = before.clone();
                assert_eq!(stamp.draw::<true, true>(simd, &mut wide, &base_rows), covered, "{simd:?}");
                assert!(wide.colour == plain.colour && wide.depth == plain.depth && wide.class == plain.class, "{simd:?}");
                let mut bare = before.clone();
                stamp.draw::<false, false>(simd, &mut bare, &base_rows);
                assert!(bare.colour == plain.colour && bare.depth == before.depth && bare.class == before.class, "{simd:?}");
            }
        }
    }
}
