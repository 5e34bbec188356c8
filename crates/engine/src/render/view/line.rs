//! A line on the screen: what is linear in the base column along it.

use crate::math::divided_by_count;
use crate::render::view::camera::Camera;
use crate::render::view::tables::View;

/// Fractional bits of screen rows.
pub(crate) const ROW_BITS: u32 = 24;

/// Fractional bits of the inverse of a distance.
pub(crate) const INVERSE_BITS: u32 = 44;

/// Fractional bits of the exact columns of a seg's ends.
pub(crate) const END_BITS: u32 = 18;

/// The inverse of a distance beyond all maps, which keeps divisions in range.
pub(crate) const LEAST_INVERSE: i64 = 1 << (INVERSE_BITS - 17);

/// Whether doubles hold a number that changes by `step` a base column exactly in all columns.
#[cfg(target_arch = "x86_64")]
#[inline]
pub(crate) fn fits_doubles(at: i64, step: i64) -> bool {
    /// Bits of a base column's number.
    const COLUMN_BITS: u32 = 11;
    (at.unsigned_abs() | step.unsigned_abs() << COLUMN_BITS) >> (f64::MANTISSA_DIGITS - 1) == 0
}

/// The plane of a line as the camera sees it: all that depends on the line is linear in the base
/// column, so that the pieces into which the BSP cut a line fit together exactly.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ProjectedLine {
    /// Inverse of the distance at base column 0, [`INVERSE_BITS`] fractional bits.
    pub inverse: i64,
    /// Its change a column.
    pub inverse_step: i64,
}

/// Horizontal texture positions on a line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TextureLine {
    /// Position along the line of the point nearest to the eye, in texels.
    pub along: i64,
    /// Texels that a ray gains along the line a unit of distance, at base column 0.
    pub gain: i64,
    /// Its change a column.
    pub gain_step: i64,
    /// First position that is shown, 16.16 as are the next two.
    pub least: i64,
    /// Last position of the line.
    pub last: i64,
    /// Texture position of the line's start.
    pub offset: i64,
}

impl TextureLine {
    /// Fractional bits of [`TextureLine::along`].
    pub const ALONG_BITS: u32 = 44;
    /// Fractional bits of [`TextureLine::gain`].
    pub const GAIN_BITS: u32 = 60;

    /// Horizontal texture position at a base column where the distance is known, 16.16.
    #[inline]
    pub fn at(&self, column: i64, distance: i64) -> i64 {
        let gain = self.gain.wrapping_add(self.gain_step.wrapping_mul(column)) >> 32;
        (self.along.wrapping_add(distance.wrapping_mul(gain)) >> 28).min(self.last).max(self.least)
            + self.offset
    }
}

/// The row of a height along a line; linear in the base column.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Edge {
    /// At base column 0.
    pub at: i64,
    /// Its change a column.
    pub step: i64,
}

impl ProjectedLine {
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

    /// The line of a seg whose ends lie on `self` at `positions`, base columns with [`END_BITS`]
    /// fractional bits, put at the whole columns `columns`: where light and the rows of edges are
    /// taken from.
    #[inline]
    pub fn between(&self, positions: [i64; 2], columns: [i64; 2]) -> ProjectedLine {
        let [first, end] = positions.map(|position| {
            let change = (i128::from(self.inverse_step) * i128::from(position)) >> END_BITS;
            (self.inverse + change as i64).max(LEAST_INVERSE)
        });
        // Every seg in view waits for this one.
        let inverse_step = divided_by_count(end - first, columns[1] - columns[0]);
        ProjectedLine { inverse: first - inverse_step * columns[0], inverse_step }
    }

    /// Where a height, relative to the eye in 16.16, is seen.
    #[inline]
    pub fn edge(&self, camera: &Camera, view: &View, height: i64) -> Edge {
        let scale = i128::from(height * view.focal_y);
        let rows =
            |inverse: i64| ((scale * i128::from(inverse)) >> (32 + INVERSE_BITS - ROW_BITS)) as i64;
        Edge {
            at: (camera.horizon << (ROW_BITS - 16)) - rows(self.inverse),
            step: -rows(self.inverse_step),
        }
    }
}

impl Edge {
    /// Whether doubles hold its rows exactly in all columns: they do but for walls at the eye.
    #[cfg(target_arch = "x86_64")]
    #[inline]
    pub fn is_exact(&self) -> bool {
        fits_doubles(self.at, self.step)
    }

    /// The base row at a base column, anywhere.
    #[inline(always)]
    pub fn base_row(&self, column: i64) -> i64 {
        (self.at + self.step * column) >> ROW_BITS
    }

    /// The first frame row that the edge cuts, or one below, at a base column; `first_rows` is
    /// [`View::first_row`].
    #[inline]
    pub fn row(&self, first_rows: &[i16], column: u32) -> i32 {
        let base = ((self.at + self.step * i64::from(column)) >> ROW_BITS).max(0) as usize;
        i32::from(first_rows[base.min(first_rows.len() - 1)])
    }
}
