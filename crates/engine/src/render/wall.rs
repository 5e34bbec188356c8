//! Where a seg lies on the screen, and the drawing of its wall.

use super::View;
use super::camera::Camera;
use super::column::Column;
use super::frame::Frame;
use super::light::{Light, ONE_TABLE_DISTANCE};
use super::picture::WallPicture;
use super::scene::{Face, SceneSeg};
use crate::simd::Simd;

/// Fractional bits of screen rows.
pub(super) const ROW_BITS: u32 = 24;
/// Fractional bits of the inverse of a distance.
pub(super) const INVERSE_BITS: u32 = 44;
/// Fractional bits of the exact columns of a seg's ends.
pub(super) const END_BITS: u32 = 18;
/// The inverse of a distance beyond all maps, which keeps divisions in range.
const LEAST_INVERSE: i64 = 1 << (INVERSE_BITS - 17);

/// The plane of a line as the camera sees it: all that depends on the line is linear in the base column, so that the
/// pieces into which the BSP cut a line fit together exactly.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SeenLine {
    /// Inverse of the distance at base column 0, [`INVERSE_BITS`] fractional bits.
    pub inverse: i64,
    /// Its change a column.
    pub inverse_step: i64,
}

/// Horizontal texture positions on a line.
#[derive(Clone, Copy, Debug)]
pub(super) struct TextureLine {
    /// Position along the line of the point nearest to the eye, 16.16.
    along: i64,
    /// Position along the line that a ray gains a unit of distance at base column 0, 60 fractional bits.
    gain: i64,
    /// Its change a column.
    gain_step: i64,
    /// Last position of the line.
    last: i64,
    /// Texture position of the line's start.
    offset: i64,
}

impl TextureLine {
    /// The texture positions of one side of a line.
    pub fn new(camera: &Camera, face: &Face) -> TextureLine {
        let [tx, ty] = face.along.map(i64::from);
        TextureLine {
            along: (camera.x * tx + camera.y * ty + face.origin) >> 28,
            gain: tx * camera.ray[0] + ty * camera.ray[1],
            gain_step: tx * camera.ray_step[0] + ty * camera.ray_step[1],
            last: face.texels - 1,
            offset: face.u_offset,
        }
    }

    /// Horizontal texture position at a base column where the distance is known, 16.16. The left edge of a line's first
    /// column may lie before the line: it shows the line's first texel.
    #[inline]
    pub fn at(&self, column: i64, distance: i64) -> i64 {
        let gain = (self.gain + self.gain_step * column) >> 32;
        (self.along + ((distance * gain) >> 28)).min(self.last).max(0) + self.offset
    }
}

/// The row of a height along a line; linear in the base column.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    /// At base column 0.
    pub at: i64,
    /// Its change a column.
    pub step: i64,
}

impl SeenLine {
    /// The line of a seg that faces the camera from `away`, the distance with 44 fractional bits.
    #[inline]
    pub fn new(camera: &Camera, seg: &SceneSeg, away: i64) -> SeenLine {
        let [nx, ny] = seg.normal.map(i64::from);
        // Nearer than 1/256 unit counts as that far.
        let reciprocal = (1i64 << 62) / (away >> 20).max(1 << 16);
        let inverse = |ray: [i64; 2]| {
            let towards = -(nx * ray[0] + ny * ray[1]);
            ((i128::from(towards) * i128::from(reciprocal)) >> (98 - INVERSE_BITS)) as i64
        };
        SeenLine { inverse: inverse(camera.ray), inverse_step: inverse(camera.ray_step) }
    }

    /// The inverse of the distance at a base column.
    #[inline]
    pub fn inverse_at(&self, column: i64) -> i64 {
        (self.inverse + self.inverse_step * column).max(LEAST_INVERSE)
    }

    /// Distance at a base column, 16.16.
    #[inline]
    pub fn distance_at(&self, column: i64) -> i64 {
        ((1u64 << (INVERSE_BITS + 16)) / self.inverse_at(column) as u64) as i64
    }

    /// The line of a seg whose ends lie on `self` at `positions`, base columns with [`END_BITS`] fractional bits, put at
    /// the whole columns `columns`: where light and the rows of edges are taken from.
    #[inline]
    pub fn between(&self, positions: [i64; 2], columns: [i64; 2]) -> SeenLine {
        let [first, end] = positions.map(|position| {
            let change = (i128::from(self.inverse_step) * i128::from(position)) >> END_BITS;
            (self.inverse + change as i64).max(LEAST_INVERSE)
        });
        let inverse_step = (end - first) / (columns[1] - columns[0]).max(1);
        SeenLine { inverse: first - inverse_step * columns[0], inverse_step }
    }

    /// Where a height, relative to the eye in 16.16, is seen.
    #[inline]
    pub fn edge(&self, camera: &Camera, view: &View, height: i64) -> Edge {
        let scale = i128::from(height * view.focal_y);
        let rows = |inverse: i64| ((scale * i128::from(inverse)) >> (32 + INVERSE_BITS - ROW_BITS)) as i64;
        Edge { at: (camera.horizon << (ROW_BITS - 16)) - rows(self.inverse), step: -rows(self.inverse_step) }
    }
}

impl Edge {
    /// The base row at a base column, anywhere.
    #[inline(always)]
    pub fn base_row(&self, column: i64) -> i64 {
        (self.at + self.step * column) >> ROW_BITS
    }

    /// The first frame row that the edge cuts, or one below, at a base column; `first_rows` is [`View::first_row`].
    #[inline]
    pub fn row(&self, first_rows: &[i16], column: u32) -> i32 {
        let base = ((self.at + self.step * i64::from(column)) >> ROW_BITS).max(0) as usize;
        i32::from(first_rows[base.min(first_rows.len() - 1)])
    }
}

/// A part of a wall that one texture covers.
pub(super) struct WallShader<'a> {
    pub camera: &'a Camera,
    pub view: &'a View,
    pub tables: &'a [[u8; 256]; 32],
    /// For texture positions.
    pub line: &'a SeenLine,
    /// For the light.
    pub ends: &'a SeenLine,
    pub texture: TextureLine,
    pub picture: &'a WallPicture,
    pub light: Light,
    /// Height of the texture's top row, relative to the eye, 16.16.
    pub hung_from: i64,
}

impl WallShader<'_> {
    /// Draws rows `tops[i]..bottoms[i]` of the frame columns from `first` on, into the frame's columns.
    pub fn draw<const DEPTH: bool>(&self, simd: Simd, frame: &mut Frame, first: usize, tops: &[i16], bottoms: &[i16]) {
        let picture = self.picture;
        let start = (self.hung_from * picture.inverse_height) >> 16;
        // Texels are those of the rows' lower edges.
        let (centre, fraction) = (self.camera.horizon >> 16, self.camera.horizon & 0xFFFF);
        for (i, (&top, &bottom)) in tops.iter().zip(bottoms).enumerate() {
            if top >= bottom {
                continue;
            }
            let (top, bottom) = (top as usize, bottom as usize);
            let x = first + i;
            let column = i64::from(self.view.columns[x]);
            let distance = self.line.distance_at(column);
            let texels = picture.column(self.texture.at(column, distance));
            let nearness = (self.ends.inverse_at(column) * ONE_TABLE_DISTANCE) >> (INVERSE_BITS - 16);
            let table = &self.tables[self.light.table(nearness)];
            // Rows of texture a base row, as a fraction of its height with 32 bits: what overflows is whole heights.
            let step = (((distance * self.view.inverse_focal_y) >> 24).wrapping_mul(picture.inverse_height)) >> 24;
            let at = start.wrapping_add(step.wrapping_mul(1 - centre)).wrapping_sub((step * fraction) >> 16) as u32;
            let column = Column { texels, table, at, step: step as u32 };
            column.draw(simd, frame.columns.colour_of(x), &self.view.rows, top, bottom);
            if DEPTH {
                let depth = frame.depths.wall(distance);
                frame.columns.depth_of(x)[top..bottom].fill(depth);
            }
            // The class of a wall is what the frame was cleared to.
        }
    }
}
