//! Pictures with holes.

use crate::assets::Image;
use std::sync::Arc;

/// A picture with holes: sprites, midtextures, weapons, the status bar.
#[derive(Clone, Debug)]
pub(crate) struct MaskedTexture {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Columns left of the anchor.
    pub offset_x: i32,
    /// Rows above the anchor.
    pub offset_y: i32,
    /// Column by column: palette index, and [`MaskedTexture::OPAQUE`] where there is no hole.
    pub texels: Arc<[u16]>,
}

impl MaskedTexture {
    /// Set in opaque texels.
    pub const OPAQUE: u16 = 0x100;

    pub fn new(image: &Image) -> MaskedTexture {
        let opaque =
            |i: usize| image.mask.as_ref().is_none_or(|mask| mask.get(i).is_some_and(|&m| m != 0));
        let texels = image
            .pixels
            .iter()
            .enumerate()
            .map(|(i, &pixel)| u16::from(pixel) | if opaque(i) { MaskedTexture::OPAQUE } else { 0 })
            .collect::<Vec<u16>>();
        let (width, height) = (u32::from(image.width), u32::from(image.height));
        let mut texels = texels;
        texels.resize((width * height) as usize, 0);
        MaskedTexture {
            width,
            height,
            offset_x: i32::from(image.offset_x),
            offset_y: i32::from(image.offset_y),
            texels: texels.into(),
        }
    }

    /// The texels of a column.
    #[inline]
    pub fn column(&self, column: u32) -> &[u16] {
        let start = (column * self.height) as usize;
        &self.texels[start..start + self.height as usize]
    }
}
