//! Floors and ceilings: collected as areas of equal height, texture and light, then drawn row by row.

use super::camera::Camera;
use super::depth_level;
use super::frame::{Frame, class};
use super::light::{Light, ONE_TABLE_DISTANCE};
use super::picture::FlatPicture;
use super::view::{CHUNK, View};
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
    /// First row by column; one column more than the frame has.
    pub top: Vec<i16>,
    /// One past the last row by column; not below the first where the plane has no row.
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
        plane.top.resize(self.width + 1, 0);
        plane.bottom.resize(self.width + 1, 0);
        plane.bottom.fill(i16::MIN);
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
        // The column behind the last one has no rows, which ends the last spans.
        let (mut t1, mut b1) = (0, 0);
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
        let pixels = &mut frame.colour[start + first..start + end];
        let columns = &self.view.columns[first..end];
        match flat {
            FlatPicture::Small(texels) => {
                let fetch = |index: u32| table[usize::from(texels[index as usize & (64 * 64 - 1)])];
                self.walk::<6>(distance).draw::<6>(pixels, columns, self.view.chunk_stride, fetch);
            }
            FlatPicture::Large(texels) => {
                let fetch = |index: u32| table[usize::from(texels[index as usize & (128 * 128 - 1)])];
                self.walk::<7>(distance).draw::<7>(pixels, columns, self.view.chunk_stride, fetch);
            }
        }
        if DEPTH {
            frame.depth[start + first..start + end].fill(depth_level(distance));
        }
        if CLASS {
            frame.class[start + first..start + end].fill(self.class);
        }
    }

    /// The walk of a row over textures of side `2^BITS`.
    #[inline]
    fn walk<const BITS: u32>(&self, distance: i64) -> TextureWalk {
        let camera = self.camera;
        // 48 fractional bits, of which the fraction of the side's 32 are kept; whole sides wrap away.
        let part = |position: i64| (position >> (16 + BITS)) as u32;
        let u = (camera.x << 32).wrapping_add(distance.wrapping_mul(camera.ray[0]));
        let v = (camera.y << 32).wrapping_add(distance.wrapping_mul(camera.ray[1]));
        TextureWalk {
            u: part(u),
            v: part(v.wrapping_neg()),
            u_step: part(distance.wrapping_mul(camera.ray_step[0])),
            v_step: part(distance.wrapping_mul(camera.ray_step[1]).wrapping_neg()),
        }
    }
}

/// Texture positions along a row, as fractions of the texture's side with 32 bits: linear in the base column.
struct TextureWalk {
    /// At base column 0, to the right.
    u: u32,
    /// At base column 0, down.
    v: u32,
    u_step: u32,
    v_step: u32,
}

impl TextureWalk {
    /// Fills the pixels of base columns `columns` with what `fetch` gives for an index into a square texture of side
    /// `2^BITS`. Positions are worked out [`CHUNK`] at a time, which the compiler turns into vector arithmetic;
    /// `stride` is what the base column rises by over a chunk.
    #[inline(always)]
    fn draw<const BITS: u32>(&self, pixels: &mut [u8], columns: &[u32], stride: u32, fetch: impl Fn(u32) -> u8) {
        let index = |u: u32, v: u32| (u >> (32 - BITS)) << BITS | v >> (32 - BITS);
        let at = |column: u32| {
            let u = self.u.wrapping_add(self.u_step.wrapping_mul(column));
            (u, self.v.wrapping_add(self.v_step.wrapping_mul(column)))
        };
        let whole = pixels.len() / CHUNK * CHUNK;
        let (chunks, rest) = pixels.split_at_mut(whole);
        if whole > 0 {
            let mut u: [u32; CHUNK] = std::array::from_fn(|i| at(columns[i]).0);
            let mut v: [u32; CHUNK] = std::array::from_fn(|i| at(columns[i]).1);
            let (u_stride, v_stride) = (self.u_step.wrapping_mul(stride), self.v_step.wrapping_mul(stride));
            for chunk in chunks.chunks_exact_mut(CHUNK) {
                let indices: [u32; CHUNK] = std::array::from_fn(|i| index(u[i], v[i]));
                u = u.map(|u| u.wrapping_add(u_stride));
                v = v.map(|v| v.wrapping_add(v_stride));
                for (pixel, index) in chunk.iter_mut().zip(indices) {
                    *pixel = fetch(index);
                }
            }
        }
        for (pixel, &column) in rest.iter_mut().zip(&columns[whole..]) {
            let (u, v) = at(column);
            *pixel = fetch(index(u, v));
        }
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
