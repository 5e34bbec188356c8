//! The sky: a cylinder at infinite distance. It is drawn by columns, as walls are.

#[cfg(target_arch = "x86_64")]
pub mod avx512;

use crate::render::buffers::frame::Columns;
use crate::render::buffers::visplane::Plane;
use crate::render::textures::picture::WallPicture;
use crate::render::view::camera::Camera;
use crate::render::view::tables::View;
#[cfg(target_arch = "x86_64")]
use crate::simd::Level;
use crate::simd::Simd;

/// Height of the cylinder in units of 1/200 screen height, whatever the picture's: enough to look all the way up.
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
    pub picture: &'a WallPicture,
}

impl SkyShader<'_> {
    /// Draws a plane of the sky. `texel_rows` are those of the picture's height; `starts` is scratch of an entry for each column.
    pub fn draw(&self, simd: Simd, columns: &mut Columns, plane: &Plane, starts: &mut [u32], texel_rows: &[u16]) {
        let range = plane.first..plane.end;
        for (start, &angle) in starts[range.clone()].iter_mut().zip(&self.view.column_angles[range.clone()]) {
            // 1024 texels around.
            let u = (self.camera.angle + angle).0 >> 22;
            *start = self.picture.column_start(u as i32) as u32;
        }
        #[cfg(target_arch = "x86_64")]
        if simd.level() == Level::Avx512 && self.picture.height as usize <= avx512::MOST_TEXELS {
            // SAFETY: whoever has this `Simd` has the instructions.
            return unsafe { avx512::draw(self, columns, plane, starts, texel_rows) };
        }
        #[cfg(not(target_arch = "x86_64"))]
        let _ = simd;
        for x in range {
            let (top, bottom) = (plane.top[x], plane.bottom[x]);
            if top >= bottom {
                continue;
            }
            let texels = &self.picture.pixels[starts[x] as usize..];
            let rows = top as usize..bottom as usize;
            for (pixel, &row) in columns.colour_of(x)[rows.clone()].iter_mut().zip(&texel_rows[rows]) {
                *pixel = self.table[usize::from(texels[usize::from(row)])];
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::Image;
    use crate::map::TextureId;
    use crate::math::{Angle, Fixed, Rng};
    use crate::render::buffers::visplane::{PlaneKey, Planes};
    use crate::render::view::size::FrameSize;

    #[test]
    fn all_ways_draw_the_same_sky() {
        let mut rng = Rng::new(19);
        let key = PlaneKey { height: Fixed::ZERO, texture: TextureId(0), light: 0, sky: true };
        let table: [u8; 256] = std::array::from_fn(|_| rng.byte() as u8);
        for round in 0..60 {
            let (width, height) = (256u16, [128u16, 200, 64, 240, 33, 300][round % 6]);
            let pixels = (0..usize::from(width) * usize::from(height)).map(|_| rng.byte() as u8).collect();
            let picture = WallPicture::new(&Image { width, height, offset_x: 0, offset_y: 0, pixels, mask: None });
            let size = [FrameSize::LEARNER, FrameSize { width: 320, height: 240 }][round / 6 % 2];
            let view = View::new(size).unwrap();
            let camera = Camera { angle: Angle(rng.next_u64() as u32), ..Camera::default() };
            let horizon = i64::from(rng.between(-100 << 16, 200 << 16));
            let texel_rows: Vec<u16> = texel_rows(&view, horizon, u32::from(height)).collect();
            assert!(texel_rows.iter().all(|&row| row < height));
            let mut planes = Planes::default();
            planes.reset(view.width());
            let index = planes.find(key);
            let [tops, bottoms] = planes.columns(index, 3, view.width() - 2);
            for (top, bottom) in tops.iter_mut().zip(bottoms).take(view.width() - 5) {
                *top = rng.below(view.view_rows as u32) as i16;
                *bottom = rng.below(view.view_rows as u32 + 1) as i16;
            }
            let shader = SkyShader { camera: &camera, view: &view, table: &table, picture: &picture };
            let drawn = |simd: Simd| {
                let mut columns = Columns::default();
                columns.fit(view.width(), view.view_rows);
                shader.draw(simd, &mut columns, &planes.used()[0], &mut vec![0; view.width()], &texel_rows);
                (0..view.width()).map(|x| columns.colour_of(x)[..view.view_rows].to_vec()).collect::<Vec<_>>()
            };
            let plain = drawn(Simd::PLAIN);
            assert!(plain.iter().flatten().any(|&pixel| pixel != 0));
            Simd::available().into_iter().for_each(|simd| assert!(drawn(simd) == plain, "{simd:?}, height {height}"));
        }
    }
}
