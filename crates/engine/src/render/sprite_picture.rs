//! Pictures of sprites and weapons, row by row: they are drawn by rows, in each of which the same row of texels shows.

use crate::assets::Image;
use std::sync::Arc;

/// Texels that wide code loads at once; rows are padded to whole blocks of these.
pub(super) const TEXEL_BLOCK: usize = 64;

/// A picture with holes that always faces the eye.
#[derive(Clone, Debug)]
pub(super) struct SpritePicture {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Columns left of the anchor.
    pub offset_x: i32,
    /// Rows above the anchor.
    pub offset_y: i32,
    /// From one row to the next.
    pub stride: usize,
    /// Palette indices.
    texels: Arc<[u8]>,
    /// A bit for each texel without a hole.
    opaque: Arc<[u64]>,
}

impl SpritePicture {
    pub fn new(image: &Image) -> SpritePicture {
        let (width, height) = (usize::from(image.width), usize::from(image.height));
        let stride = width.next_multiple_of(TEXEL_BLOCK);
        let (mut texels, mut opaque) = (vec![0; stride * height], vec![0; stride * height / TEXEL_BLOCK]);
        for (column, row) in (0..width).flat_map(|column| (0..height).map(move |row| (column, row))) {
            let from = column * height + row;
            let is_opaque = image.mask.as_ref().is_none_or(|mask| mask.get(from).is_some_and(|&m| m != 0));
            let to = row * stride + column;
            texels[to] = image.pixels.get(from).copied().unwrap_or(0);
            opaque[to / TEXEL_BLOCK] |= u64::from(is_opaque) << (to % TEXEL_BLOCK);
        }
        SpritePicture {
            width: width as u32,
            height: height as u32,
            offset_x: i32::from(image.offset_x),
            offset_y: i32::from(image.offset_y),
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

    /// The palette indices of all texels without a hole.
    pub fn opaque_texels(&self) -> impl Iterator<Item = u8> + '_ {
        let is_opaque = |at: usize| self.opaque[at / TEXEL_BLOCK] >> (at % TEXEL_BLOCK) & 1 != 0;
        self.texels.iter().enumerate().filter(move |&(at, _)| is_opaque(at)).map(|(_, &texel)| texel)
    }
}
