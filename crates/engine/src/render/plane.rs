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
/// `top` of a column that the plane does not have.
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
    /// First row by column, or [`UNUSED`].
    pub top: Vec<i16>,
    /// One past the last row by column.
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
            let (top, bottom) = (vec![UNUSED; self.width], vec![0; self.width]);
            self.list.push(Plane { key, next: NONE, first: 0, end: 0, top, bottom });
        }
        let index = self.used;
        self.used += 1;
        let plane = &mut self.list[index];
        plane.key = key;
        plane.next = std::mem::replace(&mut self.buckets[key.bucket()], index as u16);
        (plane.first, plane.end) = (self.width, 0);
        plane.top.clear();
        plane.top.resize(self.width, UNUSED);
        plane.bottom.resize(self.width, 0);
        index as u16
    }

    /// Adds the rows `tops[i]..bottoms[i]` of the columns from `first` on; returns the plane that took them, which is
    /// another one where `index` already has rows in one of the columns.
    pub fn add(&mut self, index: u16, first: usize, tops: &[i16], bottoms: &[i16]) -> u16 {
        let end = first + tops.len();
        let plane = &self.list[usize::from(index)];
        let taken = plane.top[first..end]
            .iter()
            .zip(tops.iter().zip(bottoms))
            .fold(false, |taken, (&have, (&top, &bottom))| taken | ((have != UNUSED) & (top < bottom)));
        let index = if taken { self.start(plane.key) } else { index };
        let plane = &mut self.list[usize::from(index)];
        let columns = plane.top[first..end].iter_mut().zip(&mut plane.bottom[first..end]);
        for ((plane_top, plane_bottom), (&top, &bottom)) in columns.zip(tops.iter().zip(bottoms)) {
            let fill = top < bottom;
            *plane_top = if fill { top } else { *plane_top };
            *plane_bottom = if fill { bottom } else { *plane_bottom };
        }
        plane.first = plane.first.min(first);
        plane.end = plane.end.max(end);
        index
    }
}

impl Plane {
    /// Calls `span(row, first column, one past the last column)` for every run of pixels of the plane; `starts` is
    /// scratch of at least as many entries as there are rows.
    pub fn spans(&self, starts: &mut [u16], mut span: impl FnMut(usize, usize, usize)) {
        // A column without rows is UNUSED..UNUSED, so that it lies above and below of every other.
        let (mut t1, mut b1) = (UNUSED, UNUSED);
        for x in self.first..=self.end {
            let (t2, b2) = if x < self.end { (self.top[x], self.bottom[x]) } else { (UNUSED, UNUSED) };
            let b2 = if t2 == UNUSED { UNUSED } else { b2 };
            for row in (t1..b1.min(t2)).chain(t1.max(b2)..b1) {
                span(row as usize, usize::from(starts[row as usize]), x);
            }
            for row in (t2..b2.min(t1)).chain(t2.max(b1)..b2) {
                starts[row as usize] = x as u16;
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
    pub fn span<const DEPTH: bool, const CLASS: bool>(
        &self,
        frame: &mut Frame,
        flat: &FlatPicture,
        row: usize,
        first: usize,
        end: usize,
    ) {
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
        let (tops, bottoms): (Vec<i16>, Vec<i16>) = columns.iter().copied().unzip();
        planes.add(index, 0, &tops, &bottoms);
        let mut pixels = vec![0; 8 * columns.len()];
        planes.used()[0].spans(&mut [0; 8], |row, first, end| {
            assert!(first < end);
            pixels[row * columns.len() + first..row * columns.len() + end].iter_mut().for_each(|p| *p += 1);
        });
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
    fn a_column_that_is_taken_starts_another_plane() {
        let mut planes = Planes::default();
        planes.reset(4);
        let first = planes.find(KEY);
        assert_eq!(planes.add(first, 0, &[2, 2], &[5, 5]), first);
        assert_eq!(planes.add(first, 2, &[1, 1], &[3, 3]), first);
        assert_eq!(planes.add(first, 1, &[4], &[4]), first, "an empty run takes nothing");
        let second = planes.add(first, 1, &[0], &[1]);
        assert_ne!(second, first);
        assert_eq!(planes.find(KEY), second);
    }
}
