//! A column of a midtexture on its way to the frame.

use crate::render::sprites::posts::PostProjection;
use crate::render::textures::midtexture::Post;

/// A column on its way to the frame.
pub(crate) struct MidColumn<'a> {
    /// Palette indices in the low bytes.
    pub texels: &'a [u16],
    pub table: &'a [u8; 256],
    /// The same by the picture's own colours.
    pub local_texels: &'a [u8],
    /// These colours as they are lit.
    pub lit: &'a [u8],
    /// Texture row at base row 0 and its change a base row, 32 fractional bits.
    pub at: i64,
    pub step: i64,
    /// From top to bottom.
    pub runs: &'a [Post],
    pub hung: PostProjection,
}

impl MidColumn<'_> {
    /// Start of the run that a base row shows.
    pub fn run_at(&self, base_row: u32) -> u16 {
        let texel = self.texel_at(base_row) as u16;
        self.runs.iter().find(|[_, end]| texel < *end).map_or(0, |&[start, _]| start)
    }

    /// The texel of a base row.
    #[inline(always)]
    pub fn texel_at(&self, base_row: u32) -> usize {
        let v = (self.at + self.step * i64::from(base_row)) >> 32;
        v.clamp(0, self.texels.len() as i64 - 1) as usize
    }
}
