//! A part of a wall that one texture covers, and what one of its columns shows.

use crate::render::textures::local_palette::LocalPalette;
use crate::render::textures::wall::WallTexture;
use crate::render::view::camera::Camera;
use crate::render::view::depth::DepthEncoding;
use crate::render::view::light::Light;
use crate::render::view::line::{ProjectedLine, TextureLine};
use crate::render::view::tables::View;

/// A part of a wall that one texture covers.
pub(crate) struct WallShader<'a> {
    pub camera: &'a Camera,
    pub view: &'a View,
    pub depths: DepthEncoding,
    pub tables: &'a [[u8; 256]; 32],
    /// For texture positions.
    pub line: &'a ProjectedLine,
    /// For the light.
    pub ends: &'a ProjectedLine,
    pub texture: TextureLine,
    pub picture: &'a WallTexture,
    pub own: &'a LocalPalette,
    pub light: Light,
    /// Height of the texture's top row, relative to the eye, 16.16.
    pub hung_from: i64,
}

/// Columns of a wall that are worked out side by side at most.
pub(crate) const WALL_BLOCK: usize = 8;

/// Where the texture lies in the rows, the same in all columns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WallSlope {
    /// Texture position at the height of the eye, as a fraction of the texture's height with 32
    /// bits.
    pub start: i64,
    /// From the horizon to the lower edge of base row 0: whole base rows, and 65536ths of one to
    /// take away.
    pub rows: i64,
    pub fraction: i64,
}

/// What one column of a wall shows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct WallColumn {
    pub distance: i64,
    /// Horizontal texture position, 16.16.
    pub u: i64,
    /// Light table.
    pub table: usize,
    /// Position in the texture at base row 0 and its change a base row, as fractions of its height
    /// with 32 bits: what overflows is whole heights.
    pub at: u32,
    pub step: u32,
}

impl WallShader<'_> {
    /// Where the texture lies in the rows.
    pub fn slope(&self) -> WallSlope {
        // Texels are those of the rows' lower edges.
        let start = (self.hung_from * self.picture.inverse_height) >> 16;
        WallSlope {
            start,
            rows: 1 - (self.camera.horizon >> 16),
            fraction: self.camera.horizon & 0xFFFF,
        }
    }
}
