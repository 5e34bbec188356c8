//! A picture with holes put on the frame as it is: what sprites and weapons come down to.

crate::simd::kernel_files!(avx512);
pub mod data;
mod scalar;

use crate::render::buffers::frame::Frame;
use crate::render::buffers::written::{ClassBuffer, DepthBuffer};
use crate::simd::{Simd, dispatch};
use data::{DrawnBounds, Patch};

/// Draws it; `base_rows` are the base rows of the frame's.
pub(crate) fn draw<D: DepthBuffer, C: ClassBuffer>(
    stamp: &Patch,
    simd: Simd,
    frame: &mut Frame,
    base_rows: &[u32],
) -> DrawnBounds {
    let count = stamp.columns.count();
    let top = stamp.columns.tops[..count].iter().min().map_or(0, |&top| top.max(0) as usize);
    let bottom =
        stamp.columns.bottoms[..count].iter().max().map_or(0, |&bottom| bottom.max(0) as usize);
    let rows = stamp.rows.start.max(top)..stamp.rows.end.min(bottom);
    dispatch!(simd;
        avx512 if stamp.picture.stride <= avx512::MOST_TEXELS => avx512::draw::<D, C>(stamp, frame, base_rows, rows),
        scalar => scalar::draw::<D, C>(stamp, frame, base_rows, rows),
    )
}

#[cfg(test)]
mod tests {
    use super::data::{PatchColumns, TEXEL_BITS};
    use super::*;
    use crate::assets::{Assets, Image};
    use crate::math::Rng;
    use crate::render::buffers::written::{NoClass, NoDepth, WithClass, WithDepth};
    use crate::render::colour::blend::Blend;
    use crate::render::textures::sprite::SpriteTexture;
    use crate::world::OPAQUE;

    #[test]
    fn all_ways_stamp_the_same_pixels() {
        let mut rng = Rng::new(6);
        let table: [u8; 256] = std::array::from_fn(|_| rng.byte() as u8);
        let blend = Blend::new(&Assets::embedded().palette);
        for round in 0..600 {
            let (width, height) = (1 + rng.below(300) as u16, 1 + rng.below(60) as u16);
            let texels = usize::from(width) * usize::from(height);
            let mut bytes =
                |count: usize| -> Box<[u8]> { (0..count).map(|_| rng.byte() as u8).collect() };
            let mask = (round % 4 > 0).then(|| bytes(texels).iter().map(|byte| byte & 1).collect());
            let image =
                Image { width, height, offset_x: 0, offset_y: 0, pixels: bytes(texels), mask };
            let picture = SpriteTexture::new(&image);
            let (frame_width, frame_rows) = (160, 100usize);
            let pixels = frame_width * frame_rows;
            let before = Frame {
                width: frame_width,
                colour: bytes(pixels).to_vec(),
                depth: bytes(pixels).to_vec(),
                class: vec![7; pixels],
                ..Frame::default()
            };
            let first = rng.below(frame_width as u32) as usize;
            let count = rng.below((frame_width - first) as u32 + 1) as usize;
            let mut columns = PatchColumns::default();
            columns.open(
                0..frame_rows as i16,
                (0..count).map(|i| (i * usize::from(width) / count) as u16),
            );
            for i in 0..count {
                columns.tops[i] = rng.between(0, 60) as i16;
                columns.bottoms[i] = rng.between(0, 100) as i16;
            }
            let rows = rng.below(50) as usize..50 + rng.below(51) as usize;
            let base_rows: Vec<u32> = (0..frame_rows as u32).collect();
            // A little more than nothing at row 0, as much as the step loses in all rows by
            // rounding.
            let (v, v_step) =
                (frame_rows as i64, (i64::from(height) << TEXEL_BITS) / frame_rows as i64);
            let opacity = rng.below(u32::from(OPAQUE) + 1) as u8;
            let stamp = Patch {
                picture: &picture,
                table: &table,
                first,
                columns: &columns,
                rows,
                v,
                v_step,
                mixture: (round % 3 == 0).then(|| blend.mixture(opacity)),
                depth: 9,
                class: 33,
            };
            let mut plain = before.clone();
            let covered = draw::<WithDepth, WithClass>(&stamp, Simd::PLAIN, &mut plain, &base_rows);
            for row in 0..frame_rows {
                for x in 0..frame_width {
                    let i = x.wrapping_sub(first);
                    let inside = i < count
                        && stamp.rows.contains(&row)
                        && (columns.tops[i] as usize..columns.bottoms[i] as usize).contains(&row);
                    let texel = || {
                        usize::from(columns.texels[i]) * usize::from(height)
                            + row * usize::from(height) / frame_rows
                    };
                    let shown = inside && image.mask.as_ref().is_none_or(|mask| mask[texel()] != 0);
                    let at = row * frame_width + x;
                    let own = || table[usize::from(image.pixels[texel()])];
                    let colour = match (shown, stamp.mixture) {
                        (false, _) => before.colour[at],
                        (true, None) => own(),
                        (true, Some(_)) => blend.over(own(), before.colour[at], opacity),
                    };
                    assert_eq!(
                        (plain.colour[at], plain.class[at]),
                        (colour, if shown { 33 } else { 7 })
                    );
                }
            }
            for simd in Simd::available() {
                let mut wide = before.clone();
                assert_eq!(
                    draw::<WithDepth, WithClass>(&stamp, simd, &mut wide, &base_rows),
                    covered,
                    "{simd:?}"
                );
                assert!(
                    wide.colour == plain.colour
                        && wide.depth == plain.depth
                        && wide.class == plain.class,
                    "{simd:?}"
                );
                let mut bare = before.clone();
                draw::<NoDepth, NoClass>(&stamp, simd, &mut bare, &base_rows);
                assert!(
                    bare.colour == plain.colour
                        && bare.depth == before.depth
                        && bare.class == before.class,
                    "{simd:?}"
                );
            }
        }
    }
}
