//! The sky: a cylinder at infinite distance.

use super::View;
use super::camera::Camera;
use super::frame::{Frame, class};
use super::picture::WallPicture;
use super::plane::Span;

/// Height of the cylinder in units of 1/200 screen height, whatever the picture's: enough to look all the way up.
const SKY_UNITS: i64 = 228;
const UNITS_A_SCREEN: i64 = 200;
/// Units of it above the horizon.
const UNITS_ABOVE: i64 = 200;

/// The sky as one frame sees it.
pub(super) struct SkyShader<'a> {
    pub camera: &'a Camera,
    pub view: &'a View,
    pub table: &'a [u8; 256],
    pub picture: &'a WallPicture,
}

impl SkyShader<'_> {
    /// Finds the texture column of each frame column `first..end`.
    pub fn columns(&self, starts: &mut [u32], first: usize, end: usize) {
        for (start, &angle) in starts[first..end].iter_mut().zip(&self.view.column_angles[first..end]) {
            // 1024 texels around.
            let u = i64::from((self.camera.angle + angle).0 >> 22);
            *start = self.picture.column_start(u << 16) as u32;
        }
    }

    /// Draws the frame columns `first..end` of a frame row.
    pub fn span<const DEPTH: bool, const CLASS: bool>(&self, frame: &mut Frame, starts: &[u32], span: Span) {
        let (row, first, end) = (usize::from(span.row), usize::from(span.first), usize::from(span.end));
        let height = i64::from(self.picture.height);
        // From the lower edge of the row.
        let below = (i64::from(self.view.rows[row] + 1) << 16) - self.camera.horizon;
        let units = below * UNITS_A_SCREEN / i64::from(self.view.base_rows()) + (UNITS_ABOVE << 16);
        let v = ((units * height / SKY_UNITS) >> 16).rem_euclid(height) as usize;
        let start = row * frame.width;
        let pixels = frame.colour[start + first..start + end].iter_mut();
        for (pixel, &column) in pixels.zip(&starts[first..end]) {
            *pixel = self.table[usize::from(self.picture.pixels[column as usize + v])];
        }
        if DEPTH {
            let depth = frame.depths.farthest();
            frame.depth[start + first..start + end].fill(depth);
        }
        if CLASS {
            frame.class[start + first..start + end].fill(class::SKY);
        }
    }
}
