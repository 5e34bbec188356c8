//! The sky, drawn by columns as walls are.

crate::simd::kernel_files!(avx512);
mod scalar;
pub mod shader;

use crate::render::buffers::frame::Columns;
use crate::render::buffers::visplane::VisPlane;
use crate::simd::{Simd, dispatch};
use shader::SkyShader;

/// Draws a plane of the sky. `texel_rows` are those of the picture's height; `starts` is scratch of
/// an entry for each column.
pub(crate) fn draw(
    shader: &SkyShader,
    simd: Simd,
    columns: &mut Columns,
    plane: &VisPlane,
    starts: &mut [u32],
    texel_rows: &[u16],
) {
    let range = plane.first..plane.end;
    for (start, &angle) in starts[range.clone()].iter_mut().zip(&shader.view.column_angles[range]) {
        // 1024 texels around.
        let u = (shader.camera.angle + angle).0 >> 22;
        *start = shader.picture.column_start(u as i32) as u32;
    }
    dispatch!(simd;
        avx512 if avx512::fits(shader) => avx512::draw(shader, columns, plane, starts, texel_rows),
        scalar => scalar::draw(shader, columns, plane, starts, texel_rows),
    );
}

#[cfg(test)]
mod tests {
    use super::shader::texel_rows;
    use super::*;
    use crate::assets::Image;
    use crate::map::TextureId;
    use crate::math::{Angle, Fixed, Rng};
    use crate::render::buffers::visplane::{VisPlaneKey, VisPlanes};
    use crate::render::textures::wall::WallTexture;
    use crate::render::view::camera::Camera;
    use crate::render::view::size::FrameSize;
    use crate::render::view::tables::View;

    #[test]
    fn all_ways_draw_the_same_sky() {
        let mut rng = Rng::new(19);
        let key = VisPlaneKey { height: Fixed::ZERO, texture: TextureId(0), light: 0, sky: true };
        let table: [u8; 256] = std::array::from_fn(|_| rng.byte() as u8);
        for round in 0..60 {
            let (width, height) = (256u16, [128u16, 200, 64, 240, 33, 300][round % 6]);
            let pixels =
                (0..usize::from(width) * usize::from(height)).map(|_| rng.byte() as u8).collect();
            let picture = WallTexture::new(&Image {
                width,
                height,
                offset_x: 0,
                offset_y: 0,
                pixels,
                mask: None,
            });
            let size = [FrameSize::LEARNER, FrameSize { width: 320, height: 240 }][round / 6 % 2];
            let view = View::new(size).unwrap();
            let camera = Camera { angle: Angle(rng.next_u64() as u32), ..Camera::default() };
            let horizon = i64::from(rng.between(-100 << 16, 200 << 16));
            let texel_rows: Vec<u16> = texel_rows(&view, horizon, u32::from(height)).collect();
            assert!(texel_rows.iter().all(|&row| row < height));
            let mut planes = VisPlanes::default();
            planes.reset(view.width());
            let index = planes.find(key);
            let [tops, bottoms] = planes.columns(index, 3, view.width() - 2);
            for (top, bottom) in tops.iter_mut().zip(bottoms).take(view.width() - 5) {
                *top = rng.below(view.view_rows as u32) as i16;
                *bottom = rng.below(view.view_rows as u32 + 1) as i16;
            }
            let shader =
                SkyShader { camera: &camera, view: &view, table: &table, picture: &picture };
            let drawn = |simd: Simd| {
                let mut columns = Columns::default();
                columns.fit(view.width(), view.view_rows);
                draw(
                    &shader,
                    simd,
                    &mut columns,
                    &planes.used()[0],
                    &mut vec![0; view.width()],
                    &texel_rows,
                );
                (0..view.width())
                    .map(|x| columns.colour_of(x)[..view.view_rows].to_vec())
                    .collect::<Vec<_>>()
            };
            let plain = drawn(Simd::PLAIN);
            assert!(plain.iter().flatten().any(|&pixel| pixel != 0));
            Simd::available()
                .into_iter()
                .for_each(|simd| assert!(drawn(simd) == plain, "{simd:?}, height {height}"));
        }
    }
}
