//! Pictures of walls, with their sizes' reciprocals worked out.

use crate::assets::Image;
use std::sync::Arc;

/// Most texels of a column of the pictures whose columns are drawn in batches: two vectors.
pub(crate) const MOST_TEXELS: usize = 128;

/// A texture on a wall: opaque, tiled both ways.
#[derive(Clone, Debug)]
pub(crate) struct WallTexture {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `2^32 / height`, rounded up so that whole heights come out whole.
    pub inverse_height: i64,
    /// `width - 1` where that masks a column number, otherwise 0.
    column_mask: u32,
    /// Palette indices, column by column.
    pub pixels: Arc<[u8]>,
}

impl WallTexture {
    /// Whether the columns of a picture can be listed: they fill one or two vectors, and wrap as
    /// numbers do.
    pub fn fits_batch(&self) -> bool {
        matches!(self.height, 64 | 128) && self.width.is_power_of_two()
    }

    pub fn new(image: &Image) -> WallTexture {
        let (width, height) = (u32::from(image.width).max(1), u32::from(image.height).max(1));
        let mut pixels = image.pixels.to_vec();
        pixels.resize((width * height) as usize, 0);
        WallTexture {
            width,
            height,
            inverse_height: ((1 << 32) + i64::from(height) - 1) / i64::from(height),
            column_mask: if width.is_power_of_two() { width - 1 } else { 0 },
            pixels: pixels.into(),
        }
    }

    /// The texels of the column that holds the horizontal texture position `u`, 16.16.
    #[inline]
    pub fn column(&self, u: i64) -> &[u8] {
        let start = self.column_start((u >> 16) as i32);
        &self.pixels[start..start + self.height as usize]
    }

    /// Index of the first texel of the column that holds a whole texel of a tiled wall.
    #[inline]
    pub fn column_start(&self, u: i32) -> usize {
        let column = if self.column_mask != 0 {
            u as u32 & self.column_mask
        } else {
            u.rem_euclid(self.width as i32) as u32
        };
        (column * self.height) as usize
    }
}
