//! The sky as one frame sees it: a cylinder at infinite distance.

use crate::render::textures::wall::WallTexture;
use crate::render::view::camera::Camera;
use crate::render::view::tables::View;

/// Height of the cylinder in units of 1/200 screen height, whatever the picture's: enough to look
/// all the way up.
const SKY_UNITS: i64 = 228;
const UNITS_A_SCREEN: i64 = 200;
/// Units of it above the horizon.
const UNITS_ABOVE: i64 = 200;

/// The texel that each frame row shows of a sky of `height` texels.
pub(crate) fn texel_rows(view: &View, horizon: i64, height: u32) -> impl Iterator<Item = u16> {
    let height = i64::from(height);
    view.rows[..view.view_rows].iter().map(move |&row| {
        // From the lower edge of the row.
        let below = (i64::from(row + 1) << 16) - horizon;
        let units = below * UNITS_A_SCREEN / i64::from(view.base_rows()) + (UNITS_ABOVE << 16);
        ((units * height / SKY_UNITS) >> 16).rem_euclid(height) as u16
    })
}

/// The sky as one frame sees it.
pub(crate) struct SkyShader<'a> {
    pub camera: &'a Camera,
    pub view: &'a View,
    pub table: &'a [u8; 256],
    pub picture: &'a WallTexture,
}
