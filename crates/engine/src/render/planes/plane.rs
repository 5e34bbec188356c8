//! Floors and ceilings: collected as areas of equal height, texture and light, then drawn row by row.

use crate::render::buffers::frame::{Frame, class};
use crate::render::buffers::visplane::{NO_ROW, Plane, PlaneKey, Span};
use crate::render::planes::row::RowWalk;
#[cfg(target_arch = "x86_64")]
use crate::render::planes::row::vector::{self, ROW_GROUP};
#[cfg(target_arch = "x86_64")]
use crate::render::planes::spans;
use crate::render::textures::picture::FlatPicture;
use crate::render::view::camera::Camera;
use crate::render::view::horizon::RowSlopes;
use crate::render::view::light::{Light, ONE_TABLE_DISTANCE};
use crate::render::view::tables::View;
#[cfg(target_arch = "x86_64")]
use crate::simd::Level;
use crate::simd::Simd;
use std::ops::Range;

impl Plane {
    /// Lists every run of pixels of the plane in `spans`, in any order, and returns how many there are. `starts` is
    /// scratch of one entry more than the frame has rows.
    pub fn spans(&self, simd: Simd, starts: &mut [u16], spans: &mut Vec<Span>) -> usize {
        #[cfg(target_arch = "x86_64")]
        match simd.level() {
            // SAFETY: whoever has this `Simd` has the instructions.
            Level::Avx512 => return unsafe { spans::spans_avx512(self, spans) },
            // SAFETY: as above.
            Level::Avx2 => return unsafe { spans::spans_avx2(self, spans) },
            Level::Plain => {}
        }
        #[cfg(not(target_arch = "x86_64"))]
        let _ = simd;
        self.spans_plainly(starts, spans)
    }

    /// From column to column an end of the run of rows stays or moves by one, and which cannot be foretold: the first
    /// row that comes or goes is handled without a branch, by writing it in any case, and more of them by loops.
    fn spans_plainly(&self, starts: &mut [u16], spans: &mut Vec<Span>) -> usize {
        let nowhere = starts.len() - 1;
        let mut count = 0;
        // The column behind the last one has no rows, which ends the last spans.
        let (mut top1, mut bottom1) = (0, i32::from(NO_ROW));
        let columns = self.top[self.first..=self.end].iter().zip(&self.bottom[self.first..=self.end]);
        for (x, (&top2, &bottom2)) in (self.first as u16..).zip(columns) {
            let (top2, bottom2) = (i32::from(top2), i32::from(bottom2));
            if (top1, bottom1) == (top2, bottom2) {
                continue;
            }
            if count + 2 * starts.len() > spans.len() {
                spans.resize(count + 4 * starts.len(), Span::default());
            }
            // Rows of the last column that end before this one, from above and from below.
            let upper_end = bottom1.min(top2);
            let mut row = top1;
            loop {
                // The first row of a column without rows may be left from a higher frame.
                spans[count] = Span { row: row as u16, first: starts[(row as usize).min(nowhere)], end: x };
                count += usize::from(row < upper_end);
                row += 1;
                if row >= upper_end {
                    break;
                }
            }
            let lower_first = top1.max(bottom2).max(upper_end);
            let mut row = bottom1 - 1;
            loop {
                spans[count] = Span { row: row as u16, first: starts[row.max(0) as usize], end: x };
                count += usize::from(row >= lower_first);
                row -= 1;
                if row < lower_first {
                    break;
                }
            }
            // Rows that begin with this column.
            let upper_end = bottom2.min(top1);
            let mut row = top2;
            loop {
                starts[if row < upper_end { row as usize } else { nowhere }] = x;
                row += 1;
                if row >= upper_end {
                    break;
                }
            }
            let lower_first = top2.max(bottom1).max(upper_end);
            let mut row = bottom2 - 1;
            loop {
                starts[if row >= lower_first { row as usize } else { nowhere }] = x;
                row -= 1;
                if row < lower_first {
                    break;
                }
            }
            (top1, bottom1) = (top2, bottom2);
        }
        count
    }
}

/// What the rows of a plane have in common.
pub(crate) struct PlaneShader<'a> {
    pub camera: &'a Camera,
    pub view: &'a View,
    pub tables: &'a [[u8; 256]; 32],
    /// Distance of the plane from the eye's height, 16.16, positive.
    pub height: i64,
    pub slopes: &'a RowSlopes,
    pub light: Light,
    /// [`ONE_TABLE_DISTANCE`] over the distance in the first row from the horizon, 32 fractional bits.
    pub nearness: i64,
    class: u16,
}

impl<'a> PlaneShader<'a> {
    /// For the plane of a key, whose picture is a `square` of 64 texels or another one.
    pub fn new(
        camera: &'a Camera,
        view: &'a View,
        slopes: &'a RowSlopes,
        tables: &'a [[u8; 256]; 32],
        key: PlaneKey,
        square: bool,
    ) -> PlaneShader<'a> {
        let above = i64::from(key.height.0) > camera.z;
        let height = (i64::from(key.height.0) - camera.z).abs().max(256);
        let nearness = ((i128::from(ONE_TABLE_DISTANCE) << 64) / i128::from(height * view.focal_y)) as i64;
        PlaneShader {
            camera,
            view,
            tables,
            height,
            slopes,
            light: Light::new(camera, i32::from(key.light)),
            nearness,
            class: match (above, square) {
                (false, true) => class::FLOOR,
                (false, false) => class::OTHER_FLOOR,
                (true, true) => class::CEILING,
                (true, false) => class::OTHER_CEILING,
            },
        }
    }

    /// Draws runs of pixels.
    pub fn draw<const DEPTH: bool, const CLASS: bool>(&self, simd: Simd, frame: &mut Frame, flat: &FlatPicture, spans: &[Span]) {
        match flat {
            FlatPicture::Small(texels) => self.draw_from::<DEPTH, CLASS, 6, { 64 * 64 }>(simd, frame, texels, spans),
            FlatPicture::Large(texels) => self.draw_from::<DEPTH, CLASS, 7, { 128 * 128 }>(simd, frame, texels, spans),
        }
    }

    fn draw_from<const DEPTH: bool, const CLASS: bool, const BITS: u32, const TEXELS: usize>(
        &self,
        simd: Simd,
        frame: &mut Frame,
        texels: &[u8; TEXELS],
        spans: &[Span],
    ) {
        #[cfg(target_arch = "x86_64")]
        if simd.level() >= Level::Avx2 {
            // SAFETY: whoever has this `Simd` has the instructions.
            return unsafe { self.draw_wide::<DEPTH, CLASS, BITS, TEXELS>(frame, texels, spans) };
        }
        #[cfg(not(target_arch = "x86_64"))]
        let _ = simd;
        for span in spans {
            let (first, end) = (usize::from(span.first), usize::from(span.end));
            let (distance, table, start) = self.row(frame.width, span.row);
            let pixels = &mut frame.colour[start + first..start + end];
            let fetch = |index: usize| table[usize::from(texels[index & (TEXELS - 1)])];
            self.walk::<BITS>(distance).draw::<BITS>(pixels, &self.view.columns[first..end], self.view.chunk_stride, fetch);
            self.tell::<DEPTH, CLASS>(frame, distance, start + first..start + end);
        }
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn draw_wide<const DEPTH: bool, const CLASS: bool, const BITS: u32, const TEXELS: usize>(
        &self,
        frame: &mut Frame,
        texels: &[u8; TEXELS],
        spans: &[Span],
    ) {
        for span in spans {
            let (first, end) = (usize::from(span.first), usize::from(span.end));
            let (distance, table, start) = self.row(frame.width, span.row);
            // The status bar follows the last row.
            let pixels = &mut frame.colour[start + first..start + end + ROW_GROUP];
            let columns = self.view.columns[first..].first_chunk().expect("the list is padded");
            let walk = self.walk::<BITS>(distance);
            vector::draw::<BITS, TEXELS>(&walk, pixels, end - first, columns, self.view.chunk_stride, (texels, table));
            self.tell::<DEPTH, CLASS>(frame, distance, start + first..start + end);
        }
    }

    /// How far the plane is in a row, its light there, and the row's first pixel.
    #[inline(always)]
    fn row(&self, width: usize, row: u16) -> (i64, &[u8; 256], usize) {
        let row = usize::from(row);
        let distance = (self.height * self.slopes.distances[row]) >> 16;
        let table = &self.tables[self.light.table((self.nearness * self.slopes.rows[row]) >> 32)];
        (distance, table, row * width)
    }

    #[inline(always)]
    pub fn tell<const DEPTH: bool, const CLASS: bool>(&self, frame: &mut Frame, distance: i64, pixels: Range<usize>) {
        if DEPTH {
            let depth = frame.depths.plane(distance);
            frame.depth[pixels.clone()].fill(depth);
        }
        if CLASS {
            frame.class[pixels].fill(self.class);
        }
    }

    /// The walk of a row over textures of side `2^BITS`.
    #[inline(always)]
    fn walk<const BITS: u32>(&self, distance: i64) -> RowWalk {
        let camera = self.camera;
        // 48 fractional bits, of which the fraction of the side's 32 are kept; whole sides wrap away.
        let part = |position: i64| (position >> (16 + BITS)) as u32;
        let u = (camera.x << 32).wrapping_add(distance.wrapping_mul(camera.plane_ray[0]));
        let v = (camera.y << 32).wrapping_add(distance.wrapping_mul(camera.plane_ray[1]));
        RowWalk {
            u: part(u),
            v: part(v.wrapping_neg()),
            u_step: part(distance.wrapping_mul(camera.plane_step[0])),
            v_step: part(distance.wrapping_mul(camera.plane_step[1]).wrapping_neg()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::TextureId;
    use crate::math::Fixed;
    use crate::render::buffers::visplane::Planes;

    const KEY: PlaneKey = PlaneKey { height: Fixed::ZERO, texture: TextureId(0), light: 0, sky: false };

    fn covered(simd: Simd, columns: &[(i16, i16)]) -> Vec<u8> {
        let mut planes = Planes::default();
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
        let count = if first < end { planes.used()[0].spans(simd, &mut [0; 9], &mut spans) } else { 0 };
        for span in &spans[..count] {
            assert!(span.first < span.end);
            let row = usize::from(span.row) * columns.len();
            pixels[row + usize::from(span.first)..row + usize::from(span.end)].iter_mut().for_each(|p| *p += 1);
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
            let columns: Vec<(i16, i16)> = (0..width).map(|_| (any(if flat { 2 } else { 8 }), any(8))).collect();
            for simd in Simd::available() {
                let pixels = covered(simd, &columns);
                for (i, &count) in pixels.iter().enumerate() {
                    let (row, (top, bottom)) = ((i / width) as i16, columns[i % width]);
                    let expected = u8::from(row >= top && row < bottom);
                    assert_eq!(count, expected, "{simd:?}: {columns:?} row {row} column {}", i % width);
                }
            }
        }
    }

    #[test]
    fn the_newest_plane_of_a_key_is_found() {
        let mut planes = Planes::default();
        planes.reset(4);
        let first = planes.find(KEY);
        let second = planes.start_another(first);
        assert_ne!(first, second);
        assert_eq!(planes.find(KEY), second);
        assert_ne!(planes.find(PlaneKey { light: 1, ..KEY }), second);
    }
}
