//! Pictures of sprites and weapons, column by column and row by row: with long vectors they are
//! drawn by rows, in each of which the same row of texels shows.

use crate::assets::Image;
use crate::render::textures::masked::MaskedTexture;
use std::ops::Range;
use std::sync::Arc;

/// Texels that wide code loads at once; rows are padded to whole blocks of these.
pub(crate) const TEXEL_BLOCK: usize = 64;

/// A picture with holes that always sidedefs the eye.
#[derive(Clone, Debug)]
pub(crate) struct SpriteTexture {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Columns left of the anchor.
    pub offset_x: i32,
    /// Rows above the anchor.
    pub offset_y: i32,
    /// The same by columns.
    columns: MaskedTexture,
    /// Of each column the first row without a hole, and one past the last.
    extents: Arc<[[u16; 2]]>,
    /// From one row to the next.
    pub stride: usize,
    /// Palette indices by rows.
    texels: Arc<[u8]>,
    /// A bit for each texel without a hole.
    opaque: Arc<[u64]>,
}

impl SpriteTexture {
    /// How far it reaches to either side of its anchor at most, mirrored or not; texels.
    pub fn reach(&self) -> i64 {
        let (width, left) = (i64::from(self.width), i64::from(self.offset_x));
        left.abs().max((width - left).abs())
    }

    pub fn new(image: &Image) -> SpriteTexture {
        let (width, height) = (usize::from(image.width), usize::from(image.height));
        let (stride, columns) = (width.next_multiple_of(TEXEL_BLOCK), MaskedTexture::new(image));
        let (mut texels, mut opaque) =
            (vec![0; stride * height], vec![0; stride * height / TEXEL_BLOCK]);
        let is_opaque = |texel: &u16| texel & MaskedTexture::OPAQUE != 0;
        let extents = (0..width).map(|column| {
            let texels = columns.column(column as u32);
            let ends = texels.iter().position(is_opaque).zip(texels.iter().rposition(is_opaque));
            ends.map_or([0, 0], |(first, last)| [first as u16, last as u16 + 1])
        });
        let extents = extents.collect();
        for column in 0..width {
            for (row, &texel) in columns.column(column as u32).iter().enumerate() {
                let to = row * stride + column;
                texels[to] = texel as u8;
                opaque[to / TEXEL_BLOCK] |= u64::from(is_opaque(&texel)) << (to % TEXEL_BLOCK);
            }
        }
        SpriteTexture {
            width: width as u32,
            height: height as u32,
            offset_x: i32::from(image.offset_x),
            offset_y: i32::from(image.offset_y),
            columns,
            extents,
            stride,
            texels: texels.into(),
            opaque: opaque.into(),
        }
    }

    /// The palette indices of a row, and a bit for each without a hole: whole blocks.
    #[inline(always)]
    pub fn row(&self, row: usize) -> (&[u8], &[u64]) {
        let (start, end) = (row * self.stride, (row + 1) * self.stride);
        (&self.texels[start..end], &self.opaque[start / TEXEL_BLOCK..end / TEXEL_BLOCK])
    }

    /// The texels of a column as [`MaskedTexture`] has them.
    #[inline(always)]
    pub fn column(&self, column: u16) -> &[u16] {
        self.columns.column(u32::from(column))
    }

    /// The rows of a column between which all texels without a hole lie.
    #[inline(always)]
    pub fn extent(&self, column: u16) -> Range<usize> {
        let [first, end] = self.extents[usize::from(column)].map(usize::from);
        first..end
    }

    /// The palette indices of all texels without a hole.
    pub fn opaque_texels(&self) -> impl Iterator<Item = u8> + '_ {
        let opaque =
            self.columns.texels.iter().filter(|&&texel| texel & MaskedTexture::OPAQUE != 0);
        opaque.map(|&texel| texel as u8)
    }
}
