//! A picture with holes on its way to the frame.

use crate::render::colour::blend::Mixture;
use crate::render::textures::sprite::SpriteTexture;
use crate::render::view::tables::View;
use std::ops::Range;

/// Columns that are stamped at once at most: lists by column are that much longer than there are
/// columns.
pub(crate) const PATCH_BLOCK: usize = 64;
/// Fractional bits of texture rows.
pub(crate) const TEXEL_BITS: u32 = 32;

/// The first frame row whose lower edge is at a texture row or below it; `v` and `v_step` as in
/// [`Patch`].
#[inline]
pub(crate) fn first_row(view: &View, texel: u32, v: i64, v_step: i64) -> i16 {
    let base = ((i64::from(texel) << TEXEL_BITS) - v + v_step - 1).div_euclid(v_step);
    view.first_row[base.clamp(0, i64::from(view.base_view_rows)) as usize]
}

/// The part of a frame that was covered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct DrawnBounds {
    pub columns: [usize; 2],
    pub rows: [usize; 2],
}

impl DrawnBounds {
    pub const NOTHING: DrawnBounds =
        DrawnBounds { columns: [usize::MAX, 0], rows: [usize::MAX, 0] };

    /// Adds a part with pixels in its outermost columns and rows.
    #[inline(always)]
    pub fn add(&mut self, columns: Range<usize>, rows: Range<usize>) {
        self.columns = [self.columns[0].min(columns.start), self.columns[1].max(columns.end)];
        self.rows = [self.rows[0].min(rows.start), self.rows[1].max(rows.end)];
    }
}

/// What may be covered of each column of the picture at hand, and what it shows; memory that is
/// reused.
#[derive(Clone, Debug, Default)]
pub(crate) struct PatchColumns {
    /// First row; padded, as the others are.
    pub tops: Vec<i16>,
    /// One past the last row.
    pub bottoms: Vec<i16>,
    /// Column of the picture.
    pub texels: Vec<u16>,
}

impl PatchColumns {
    /// Opens the rows `rows` of as many columns as `texels` gives columns of the picture.
    pub fn open(&mut self, rows: Range<i16>, texels: impl Iterator<Item = u16>) {
        self.texels.clear();
        self.texels.extend(texels);
        let padded = self.texels.len() + PATCH_BLOCK;
        self.texels.resize(padded, 0);
        self.tops.clear();
        self.tops.resize(padded, rows.start);
        self.bottoms.clear();
        self.bottoms.resize(padded, rows.end);
    }

    /// How many columns there are.
    pub fn count(&self) -> usize {
        self.texels.len() - PATCH_BLOCK
    }
}

/// A picture on its way to the frame.
pub(crate) struct Patch<'a> {
    pub picture: &'a SpriteTexture,
    pub table: &'a [u8; 256],
    /// First frame column.
    pub first: usize,
    pub columns: &'a PatchColumns,
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

impl Patch<'_> {
    /// Texture row that a base row shows.
    #[inline(always)]
    pub fn texel_row(&self, base_row: u32) -> usize {
        ((self.v + self.v_step * i64::from(base_row)) >> TEXEL_BITS) as usize
    }
}
