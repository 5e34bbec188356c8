//! Floors and ceilings: collected as areas of equal height, texture and light, then drawn row by row.

use super::camera::Camera;
use super::frame::{Frame, class};
use super::light::{Light, ONE_TABLE_DISTANCE};
use super::picture::FlatPicture;
use super::{View, depth_level};
use crate::map::TextureId;
use crate::math::Fixed;

/// What is the same all over a plane.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct PlaneKey {
    /// Height; 0 for the sky, all of which is one plane.
    pub height: Fixed,
    /// Texture.
    pub texture: TextureId,
    /// Sector light; 0 for the sky.
    pub light: i16,
    /// The sky.
    pub sky: bool,
}

impl PlaneKey {
    fn bucket(self) -> usize {
        let mixed = (self.height.0 as u32 ^ (u32::from(self.texture.0) << 8) ^ self.light as u32).wrapping_mul(0x9E37_79B1);
        (mixed >> 26) as usize
    }
}

/// Buckets of the table of planes.
const BUCKETS: usize = 64;
/// No plane.
const NONE: u16 = u16::MAX;
/// `top` and `bottom` of a column that the plane does not have.
pub(super) const UNUSED: i16 = i16::MAX;

/// An area of one plane: at most one run of rows in each column.
#[derive(Clone, Debug)]
pub(super) struct Plane {
    pub key: PlaneKey,
    /// The next plane of the same bucket.
    next: u16,
    /// First column.
    pub first: usize,
    /// One past the last column.
    pub end: usize,
    /// First row by column, or [`UNUSED`]; one column more than the frame has.
    pub top: Vec<i16>,
    /// One past the last row by column, or [`UNUSED`].
    pub bottom: Vec<i16>,
}

/// The planes of a frame.
#[derive(Clone, Debug, Default)]
pub(super) struct Planes {
    list: Vec<Plane>,
    used: usize,
    buckets: Vec<u16>,
    width: usize,
}

impl Planes {
    /// Forgets the last frame.
    pub fn reset(&mut self, width: usize) {
        self.used = 0;
        self.width = width;
        self.buckets.clear();
        self.buckets.resize(BUCKETS, NONE);
    }

    /// The planes in the order in which they were found.
    pub fn used(&self) -> &[Plane] {
        &self.list[..self.used]
    }

    /// The newest plane with a key.
    pub fn find(&mut self, key: PlaneKey) -> u16 {
        let mut index = self.buckets[key.bucket()];
        while index != NONE {
            let plane = &self.list[usize::from(index)];
            if plane.key == key {
                return index;
            }
            index = plane.next;
        }
        self.start(key)
    }

    fn start(&mut self, key: PlaneKey) -> u16 {
        if self.used == self.list.len() {
            let (top, bottom) = (vec![], vec![]);
            self.list.push(Plane { key, next: NONE, first: 0, end: 0, top, bottom });
        }
        let index = self.used;
        self.used += 1;
        let plane = &mut self.list[index];
        plane.key = key;
        plane.next = std::mem::replace(&mut self.buckets[key.bucket()], index as u16);
        (plane.first, plane.end) = (self.width, 0);
        // One more than there are columns ends the last span.
        plane.top.resize(self.width + 1, UNUSED);
        plane.bottom.resize(self.width + 1, UNUSED);
        plane.top.fill(UNUSED);
        plane.bottom.fill(UNUSED);
        index as u16
    }

    /// The rows of the columns `first..end` of a plane: first and one past the last.
    #[inline]
    pub fn columns(&mut self, index: u16, first: usize, end: usize) -> (&mut [i16], &mut [i16]) {
        let plane = &mut self.list[usize::from(index)];
        plane.first = plane.first.min(first);
        plane.end = plane.end.max(end);
        (&mut plane.top[first..end], &mut plane.bottom[first..end])
    }

    /// Another plane with the key of plane `index`, which has a run of rows already where another one is needed.
    #[cold]
    pub fn start_another(&mut self, index: u16) -> u16 {
        self.start(self.list[usize::from(index)].key)
    }
}

/// A run of pixels of a row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub row: u16,
    /// First column.
    pub first: u16,
    /// One past the last.
    pub end: u16,
}

impl Plane {
    /// Whether the plane has any column.
    pub fn is_empty(&self) -> bool {
        self.first >= self.end
    }

    /// Lists every run of pixels of the plane; `starts` is scratch of at least as many entries as there are rows.
    pub fn spans(&self, starts: &mut [u16], spans: &mut Vec<Span>) {
        spans.clear();
        // A column without rows is UNUSED..UNUSED, so that it lies above and below of every other. The one behind the
        // last column is such a one.
        let (mut t1, mut b1) = (UNUSED, UNUSED);
        let columns = self.top[self.first..=self.end].iter().zip(&self.bottom[self.first..=self.end]);
        for (x, (&t2, &b2)) in (self.first as u16..).zip(columns) {
            if (t1, b1) == (t2, b2) {
                continue;
            }
            // Rows that end before this column, then rows that begin with it.
            let (mut top, mut bottom) = (t1, b1);
            while top < bottom && top < t2 {
                spans.push(Span { row: top as u16, first: starts[top as usize], end: x });
                top += 1;
            }
            while bottom > top && bottom > b2 {
                bottom -= 1;
                spans.push(Span { row: bottom as u16, first: starts[bottom as usize], end: x });
            }
            let (mut top, mut bottom) = (t2, b2);
            while top < bottom && top < t1 {
                starts[top as usize] = x;
                top += 1;
            }
            while bottom > top && bottom > b1 {
                bottom -= 1;
                starts[bottom as usize] = x;
            }
            (t1, b1) = (t2, b2);
        }
    }
}

/// What the rows of a plane have in common.
pub(super) struct PlaneShader<'a> {
    camera: &'a Camera,
    view: &'a View,
    tables: &'a [[u8; 256]; 32],
    /// Distance of the plane from the eye's height, 16.16, positive.
    height: i64,
    /// A ceiling: rows are counted up from the horizon.
    above: bool,
    light: Light,
    /// [`ONE_TABLE_DISTANCE`] over the distance of half a row, 40 fractional bits.
    nearness: i64,
    class: u16,
}

impl<'a> PlaneShader<'a> {
    /// For a plane at `height` in a sector of light `light`.
    pub fn new(camera: &'a Camera, view: &'a View, tables: &'a [[u8; 256]; 32], key: PlaneKey) -> PlaneShader<'a> {
        let above = i64::from(key.height.0) > camera.z;
        let height = (i64::from(key.height.0) - camera.z).abs().max(256);
        let nearness = ((i128::from(ONE_TABLE_DISTANCE) << 72) / i128::from(2 * height * view.focal_y)) as i64;
        PlaneShader {
            camera,
            view,
            tables,
            height,
            above,
            light: Light::new(camera, i32::from(key.light)),
            nearness,
            class: if above { class::CEILING } else { class::FLOOR },
        }
    }

    /// Draws the frame columns `first..end` of a frame row.
    #[inline]
    pub fn span<const DEPTH: bool, const CLASS: bool>(&self, frame: &mut Frame, flat: &FlatPicture, span: Span) {
        let (row, first, end) = (usize::from(span.row), usize::from(span.first), usize::from(span.end));
        let below = i64::from(self.view.rows[row]) - self.camera.horizon;
        let away = if self.above { -1 - below } else { below }.max(0);
        let distance = (self.height * self.view.row_slopes[away as usize]) >> 16;
        let table = &self.tables[self.light.table((self.nearness * (2 * away + 1)) >> 24)];
        let start = row * frame.width;
        let columns = &self.view.columns[first..end];
        let pixels = &mut frame.colour[start + first..start + end];
        match flat {
            FlatPicture::Small(texels) => {
                let (at, step) = self.walk::<6>(distance);
                for (pixel, &column) in pixels.iter_mut().zip(columns) {
                    let at = at.wrapping_add(step.wrapping_mul(u64::from(column)));
                    *pixel = table[usize::from(texels[((at >> 52) & 0xFC0 | (at >> 26) & 0x3F) as usize])];
                }
            }
            FlatPicture::Large(texels) => {
                let (at, step) = self.walk::<7>(distance);
                for (pixel, &column) in pixels.iter_mut().zip(columns) {
                    let at = at.wrapping_add(step.wrapping_mul(u64::from(column)));
                    *pixel = table[usize::from(texels[((at >> 50) & 0x3F80 | (at >> 25) & 0x7F) as usize])];
                }
            }
        }
        if DEPTH {
            frame.depth[start + first..start + end].fill(depth_level(distance));
        }
        if CLASS {
            frame.class[start + first..start + end].fill(self.class);
        }
    }

    /// Texture position at base column 0 and its change a column, for textures of side `2^BITS`: the horizontal
    /// position in the upper half, the vertical one in the lower half, each as a fraction of the side. What the lower
    /// half carries into the upper one is too little to matter.
    #[inline]
    fn walk<const BITS: u32>(&self, distance: i64) -> (u64, u64) {
        let camera = self.camera;
        // 48 fractional bits; whole map units beyond the 16th bit wrap away, as they would in the texture.
        let at = [
            (camera.x << 32).wrapping_add(distance.wrapping_mul(camera.ray[0])),
            (camera.y << 32).wrapping_add(distance.wrapping_mul(camera.ray[1])).wrapping_neg(),
        ];
        let step = [distance.wrapping_mul(camera.ray_step[0]), distance.wrapping_mul(camera.ray_step[1]).wrapping_neg()];
        let shift = 16 - BITS;
        let pack = |u: i64, v: i64| {
            let high = (u << shift) as u64 & 0xFFFF_FFFF_0000_0000;
            high.wrapping_add(((v << shift) >> 32) as u64)
        };
        (pack(at[0], at[1]), pack(step[0], step[1]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEY: PlaneKey = PlaneKey { height: Fixed::ZERO, texture: TextureId(0), light: 0, sky: false };

    fn covered(columns: &[(i16, i16)]) -> Vec<u8> {
        let mut planes = Planes::default();
        planes.reset(columns.len());
        let index = planes.find(KEY);
        let (tops, bottoms) = planes.columns(index, 0, columns.len());
        for (x, &(top, bottom)) in columns.iter().enumerate().filter(|(_, (top, bottom))| top < bottom) {
            (tops[x], bottoms[x]) = (top, bottom);
        }
        let mut pixels = vec![0; 8 * columns.len()];
        let mut spans = Vec::new();
        planes.used()[0].spans(&mut [0; 8], &mut spans);
        for span in spans {
            assert!(span.first < span.end);
            let row = usize::from(span.row) * columns.len();
            pixels[row + usize::from(span.first)..row + usize::from(span.end)].iter_mut().for_each(|p| *p += 1);
        }
        pixels
    }

    #[test]
    fn spans_cover_each_pixel_once() {
        let mut rng = crate::math::Rng::new(5);
        for _ in 0..3000 {
            let columns: Vec<(i16, i16)> = (0..6).map(|_| (rng.between(0, 8) as i16, rng.between(0, 8) as i16)).collect();
            let pixels = covered(&columns);
            for (i, &count) in pixels.iter().enumerate() {
                let (row, (top, bottom)) = ((i / 6) as i16, columns[i % 6]);
                assert_eq!(count, u8::from(row >= top && row < bottom), "{columns:?} row {row} column {}", i % 6);
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
