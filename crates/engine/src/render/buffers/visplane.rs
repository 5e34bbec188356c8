//! Visplanes: areas of floors and ceilings of equal height, texture and light, as they are found.

use crate::map::TextureId;
use crate::math::Fixed;

/// What is the same all over a plane.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct VisPlaneKey {
    /// Height; 0 for the sky, all of which is one plane.
    pub height: Fixed,
    /// Texture.
    pub texture: TextureId,
    /// Sector light; 0 for the sky.
    pub light: i16,
    /// The sky.
    pub sky: bool,
}

impl VisPlaneKey {
    /// All of it in a word: what shows the sky's texture is the sky.
    fn packed(self) -> u64 {
        u64::from(self.height.0 as u32)
            | u64::from(self.texture.0) << 32
            | u64::from(self.light as u16) << 48
    }
}

/// Buckets of the table of planes: two to the power of these.
const BUCKET_BITS: u32 = 6;

/// Columns that are looked at at once at most; a plane's lists are that much longer than a frame is
/// wide.
pub(crate) const SPAN_BLOCK: usize = 64;

/// No plane.
const NONE: u16 = u16::MAX;

/// One past the last row of a column without rows: of equal bytes, so that filling a list with it
/// is quick.
pub(crate) const NO_ROW: i16 = -1;

/// An area of one plane: at most one run of rows in each column.
#[derive(Clone, Debug)]
pub(crate) struct VisPlane {
    pub key: VisPlaneKey,
    /// First column.
    pub first: usize,
    /// One past the last column.
    pub end: usize,
    /// First row by column; padded for blocks of columns.
    pub top: Vec<i16>,
    /// One past the last row by column; not below the first where the plane has no row.
    pub bottom: Vec<i16>,
}

/// The planes of a frame.
#[derive(Clone, Debug)]
pub(crate) struct VisPlanes {
    list: Vec<VisPlane>,
    used: usize,
    /// Of each plane in use its packed key, and the next plane of the same bucket.
    keys: Vec<(u64, u16)>,
    buckets: [u16; 1 << BUCKET_BITS],
    width: usize,
}

impl Default for VisPlanes {
    fn default() -> VisPlanes {
        VisPlanes {
            list: Vec::new(),
            used: 0,
            keys: Vec::new(),
            buckets: [NONE; 1 << BUCKET_BITS],
            width: 0,
        }
    }
}

impl VisPlanes {
    /// Forgets the last frame.
    pub fn reset(&mut self, width: usize) {
        self.used = 0;
        self.width = width;
        self.keys.clear();
        self.buckets.fill(NONE);
    }

    /// The planes in the order in which they were found.
    pub fn used(&self) -> &[VisPlane] {
        &self.list[..self.used]
    }

    /// The newest plane with a key.
    pub fn find(&mut self, key: VisPlaneKey) -> u16 {
        let packed = key.packed();
        let mut index = self.buckets[bucket(packed)];
        while index != NONE {
            let (other, next) = self.keys[usize::from(index)];
            if other == packed {
                return index;
            }
            index = next;
        }
        self.start(key)
    }

    fn start(&mut self, key: VisPlaneKey) -> u16 {
        if self.used == self.list.len() {
            let (top, bottom) = (vec![], vec![]);
            self.list.push(VisPlane { key, first: 0, end: 0, top, bottom });
        }
        let index = self.used;
        self.used += 1;
        let packed = key.packed();
        self.keys
            .push((packed, std::mem::replace(&mut self.buckets[bucket(packed)], index as u16)));
        let plane = &mut self.list[index];
        plane.key = key;
        (plane.first, plane.end) = (self.width, 0);
        // What is more than there are columns ends the last span.
        plane.top.resize(self.width + SPAN_BLOCK, 0);
        plane.bottom.resize(self.width + SPAN_BLOCK, 0);
        plane.bottom.fill(NO_ROW);
        index as u16
    }

    /// The rows of the columns `first..end` of a plane, and of all beyond: first and one past the
    /// last.
    #[inline]
    pub fn columns(&mut self, index: u16, first: usize, end: usize) -> [&mut [i16]; 2] {
        let plane = &mut self.list[usize::from(index)];
        plane.first = plane.first.min(first);
        plane.end = plane.end.max(end);
        [&mut plane.top[first..], &mut plane.bottom[first..]]
    }

    /// Another plane with the key of plane `index`, which has a run of rows already where another
    /// one is needed.
    #[cold]
    pub fn split(&mut self, index: u16) -> u16 {
        self.start(self.list[usize::from(index)].key)
    }
}

fn bucket(packed: u64) -> usize {
    (packed.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> (u64::BITS - BUCKET_BITS)) as usize
}

/// A run of pixels of a row.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Span {
    pub row: u16,
    /// First column.
    pub first: u16,
    /// One past the last.
    pub end: u16,
}

impl VisPlane {
    /// Whether the plane has any column.
    pub fn is_empty(&self) -> bool {
        self.first >= self.end
    }
}
