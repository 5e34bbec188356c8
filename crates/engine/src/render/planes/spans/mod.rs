//! The runs of pixels of a plane: what each row shows of it.

crate::simd::kernel_files!(avx2, avx512);
pub mod rows;
mod scalar;

use crate::render::buffers::visplane::{Span, VisPlane};
use crate::simd::{Simd, dispatch};

/// Lists every run of pixels of the plane in `spans`, in any order, and returns how many there are.
/// `starts` is scratch of one entry more than the frame has rows.
pub(crate) fn list(
    plane: &VisPlane,
    simd: Simd,
    starts: &mut [u16],
    spans: &mut Vec<Span>,
) -> usize {
    dispatch!(simd;
        avx512 => avx512::list(plane, spans),
        avx2 => avx2::list(plane, spans),
        scalar => scalar::list(plane, starts, spans),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::TextureId;
    use crate::math::Fixed;
    use crate::render::buffers::visplane::VisPlaneKey;
    use crate::render::buffers::visplane::VisPlanes;

    const KEY: VisPlaneKey =
        VisPlaneKey { height: Fixed::ZERO, texture: TextureId(0), light: 0, sky: false };

    fn covered(simd: Simd, columns: &[(i16, i16)]) -> Vec<u8> {
        let mut planes = VisPlanes::default();
        planes.reset(columns.len());
        let index = planes.find(KEY);
        let of_plane = |&(top, bottom): &(i16, i16)| top <= bottom;
        let first = columns.iter().position(of_plane).unwrap_or(0);
        let end = columns.iter().rposition(of_plane).map_or(0, |last| last + 1);
        let [tops, bottoms] = planes.columns(index, first, end);
        for (x, &column) in columns.iter().enumerate().filter(|(_, column)| of_plane(column)) {
            (tops[x - first], bottoms[x - first]) = column;
        }
        let mut pixels = vec![0; 8 * columns.len()];
        let mut spans = Vec::new();
        let count =
            if first < end { list(&planes.used()[0], simd, &mut [0; 9], &mut spans) } else { 0 };
        for span in &spans[..count] {
            assert!(span.first < span.end);
            let row = usize::from(span.row) * columns.len();
            pixels[row + usize::from(span.first)..row + usize::from(span.end)]
                .iter_mut()
                .for_each(|p| *p += 1);
        }
        pixels
    }

    #[test]
    fn spans_cover_each_pixel_once() {
        let mut rng = crate::math::Rng::new(5);
        for round in 0..3000 {
            let width = [6, 6, 6, 64, 128, 200][round % 6];
            let mut any = |most: i32| rng.between(0, most) as i16;
            let flat = round % 4 == 0;
            let columns: Vec<(i16, i16)> =
                (0..width).map(|_| (any(if flat { 2 } else { 8 }), any(8))).collect();
            for simd in Simd::available() {
                let pixels = covered(simd, &columns);
                for (i, &count) in pixels.iter().enumerate() {
                    let (row, (top, bottom)) = ((i / width) as i16, columns[i % width]);
                    let expected = u8::from(row >= top && row < bottom);
                    assert_eq!(
                        count,
                        expected,
                        "{simd:?}: {columns:?} row {row} column {}",
                        i % width
                    );
                }
            }
        }
    }

    #[test]
    fn the_newest_plane_of_a_key_is_found() {
        let mut planes = VisPlanes::default();
        planes.reset(4);
        let first = planes.find(KEY);
        let second = planes.split(first);
        assert_ne!(first, second);
        assert_eq!(planes.find(KEY), second);
        assert_ne!(planes.find(VisPlaneKey { light: 1, ..KEY }), second);
    }
}
