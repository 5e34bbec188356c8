//! The drawing of a wall: what its columns show, and the columns themselves.

crate::simd::kernel_files!(avx2, avx512);
mod scalar;

use crate::render::buffers::frame::Columns;
use crate::render::buffers::written::DepthBuffer;
use crate::render::walls::shader::WallShader;
use crate::simd::{Simd, dispatch};

/// Draws rows `tops[i]..bottoms[i]` of the frame columns from `first` on, into the frame's columns.
pub(crate) fn draw<D: DepthBuffer>(
    shader: &WallShader,
    simd: Simd,
    frame: &mut Columns,
    first: usize,
    tops: &[i16],
    bottoms: &[i16],
) {
    dispatch!(simd;
        avx512 => avx512::draw::<D>(shader, simd, frame, first, tops, bottoms),
        avx2 if avx2::fits(shader) => avx2::draw::<D>(shader, frame, first, tops, bottoms),
        scalar => scalar::draw::<D>(shader, simd, frame, first, tops, bottoms),
    );
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;
    use crate::assets::Image;
    use crate::math::Rng;
    use crate::render::textures::local_palette::LocalPalette;
    use crate::render::textures::wall::WallTexture;
    use crate::render::view::camera::Camera;
    use crate::render::view::depth::DepthEncoding;
    use crate::render::view::light::Light;
    use crate::render::view::line::{ProjectedLine, TextureLine};
    use crate::render::view::size::FrameSize;
    use crate::render::view::tables::View;
    use crate::render::walls::shader::WALL_BLOCK;
    use crate::simd::Level;

    #[test]
    fn columns_side_by_side_are_those_one_by_one() {
        let has = |level: Level| Simd::available().iter().any(|simd| simd.level() == level);
        let mut rng = Rng::new(12);
        let pictures = [64, 96, 128].map(|height| {
            let pixels = vec![0; 64 * usize::from(height)].into();
            WallTexture::new(&Image {
                width: 64,
                height,
                offset_x: 0,
                offset_y: 0,
                pixels,
                mask: None,
            })
        });
        let own = LocalPalette::new(&[], &[]);
        let view = View::new(FrameSize::LEARNER).unwrap();
        let mut fitting = 0;
        for round in 0..20_000 {
            let mut signed = |bits: u32| rng.next_u64() as i64 >> (63 - bits);
            // Inverses from those beyond all maps to those of a wall at the eye.
            let mut line = || {
                let bits = 24 + signed(5).unsigned_abs() as u32 % 29;
                ProjectedLine { inverse: signed(bits), inverse_step: signed(bits - 8) }
            };
            let (line, ends) = (line(), line());
            let camera = Camera {
                horizon: signed(24),
                extra_light: (signed(1) & 1) as i32,
                ..Camera::default()
            };
            let shader = WallShader {
                camera: &camera,
                view: &view,
                depths: DepthEncoding::default(),
                tables: &[[0; 256]; 32],
                line: &line,
                ends: &ends,
                texture: TextureLine {
                    along: signed(30),
                    gain: signed(58),
                    gain_step: signed(50),
                    least: [0, i64::MIN][(signed(1) & 1) as usize],
                    last: signed(24).abs(),
                    offset: signed(24),
                },
                picture: &pictures[round % 3],
                own: &own,
                light: Light::new(&camera, signed(8) as i32),
                hung_from: signed(28),
            };
            let slope = shader.slope();
            let columns: [u32; WALL_BLOCK] =
                *view.columns[rng.below(128) as usize..].first_chunk().unwrap();
            let plain = columns.map(|column| scalar::column(&shader, &slope, i64::from(column)));
            if has(Level::Avx512) {
                // SAFETY: the processor has the instructions.
                let block = unsafe { avx512::columns(&shader, &slope, &columns) };
                for (i, plain) in plain.iter().enumerate() {
                    assert_eq!(block.column(i), *plain, "{line:?} at {}", columns[i]);
                }
            }
            if has(Level::Avx2) && avx2::fits(&shader) {
                // SAFETY: the processor has the instructions.
                let block = unsafe { avx2::columns(&shader, &slope, &columns) };
                for (i, plain) in plain.iter().enumerate() {
                    let (distance, table) = (block.distance[i], block.table[i] as usize);
                    assert_eq!(
                        (distance, table),
                        (plain.distance, plain.table),
                        "{line:?} at {}",
                        columns[i]
                    );
                    let expected = ((plain.u >> 16) as u32, plain.at, plain.step);
                    assert_eq!(
                        (block.u[i], block.at[i], block.step[i]),
                        expected,
                        "{line:?} at {}",
                        columns[i]
                    );
                }
                fitting += 1;
            }
        }
        assert!(fitting > 10_000 || !has(Level::Avx2), "{fitting}");
    }
}
