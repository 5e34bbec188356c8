//! Tables that depend only on the frame's size.
//!
//! All per-pixel arithmetic is in the columns and rows of a *base* grid; the pixels that are drawn
//! are samples of that grid. Usually the two are the same. At 128x72 the base is 160x120, of which
//! every 1.25th column and 5/3rd row is drawn, so that the small frame equals the nearest-neighbour
//! reduction of the large one by construction.

use crate::math::{Angle, fine_tangent};
use crate::render::blocks::CHUNK;
use crate::render::blocks::ROW_PADDING;
use crate::render::blocks::column_stride;
use crate::render::blocks::padded;
use crate::render::view::size::FrameSize;
use crate::render::view::size::SizeError;

/// Height of the status bar's art, in its own pixels; its width is 320.
pub(crate) const BAR_ART_HEIGHT: u32 = 32;
/// Width of the status bar's art.
pub(crate) const BAR_ART_WIDTH: u32 = 320;

/// Fractional bits of [`View::column_ray`].
pub(crate) const COLUMN_RAY_BITS: u32 = 40;

/// Half the view, in the angles of which there are 8192 a turn.
const FINE_45_DEGREES: i32 = 1024;

/// The tables of one frame size. Immutable; shared by every renderer of that size.
#[derive(Clone, Debug)]
pub struct View {
    /// Size of the frame.
    pub(crate) size: FrameSize,
    /// Width of the base grid.
    pub(crate) base_width: u32,
    /// By how much more to the right the ray of a base column goes than that of the one before,
    /// each a unit ahead; [`COLUMN_RAY_BITS`].
    pub(crate) column_ray: i64,
    /// Rows of the base grid that show the world; the status bar is below.
    pub(crate) base_view_rows: u32,
    /// Rows of the frame that show the world.
    pub(crate) view_rows: usize,
    /// Base column of each frame column, and so on for a block beyond.
    pub(crate) columns: Box<[u32]>,
    /// What the base column rises by over [`CHUNK`] frame columns.
    pub(crate) chunk_stride: u32,
    /// Base row of each frame row above the status bar, then zeros as far as columns are drawn, and
    /// more.
    pub(crate) rows: Box<[u32]>,
    /// For each base column 0..=width, the first frame column at or right of it.
    pub(crate) first_column: Box<[u16]>,
    /// For each base row 0..=view rows, the first frame row at or below it.
    pub(crate) first_row: Box<[i16]>,
    /// The same as a formula.
    pub(crate) row_scale: RowScale,
    /// Vertical focal length in base rows, 16.16: 1.2 times the horizontal one, which is half the
    /// width.
    pub(crate) focal_y: i64,
    /// `2^32 / vertical focal length`.
    pub(crate) inverse_focal_y: i64,
    /// Direction of each frame column relative to the view direction, for the sky.
    pub(crate) column_angles: Box<[Angle]>,
    /// Base row of each frame row of the status bar.
    pub(crate) bar_rows: Box<[u32]>,
}

impl View {
    /// The tables for frames of `size`.
    ///
    /// # Errors
    /// If frames of that size cannot be drawn, see [`FrameSize::check`].
    pub fn new(size: FrameSize) -> Result<View, SizeError> {
        size.check()?;
        let base = if size == FrameSize::LEARNER { FrameSize::CLASSIC } else { size };
        Ok(View::sampled(size, base))
    }

    /// Frames of `size`, each pixel of which is the one of a frame of size `base` that lies at the
    /// same fraction.
    fn sampled(size: FrameSize, base: FrameSize) -> View {
        let (width, height) = (u32::from(base.width), u32::from(base.height));
        let base_view_rows = height - bar_rows(width, height);
        let columns: Box<[u32]> = (0..padded(usize::from(size.width)) as u32)
            .map(|x| x * width / u32::from(size.width))
            .collect();
        let all_rows: Vec<u32> =
            (0..u32::from(size.height)).map(|y| y * height / u32::from(size.height)).collect();
        let view_rows = all_rows.partition_point(|&row| row < base_view_rows);
        let mut rows = all_rows[..view_rows].to_vec();
        let first_column =
            (0..=width).map(|c| columns.partition_point(|&column| column < c) as u16).collect();
        let first_row =
            (0..=base_view_rows).map(|r| rows.partition_point(|&row| row < r) as i16).collect();

        rows.resize(column_stride(view_rows) + ROW_PADDING, 0);

        let focal_y = i64::from(width) * 6 * 65536 / 10;
        let tangents: Vec<i64> = (-FINE_45_DEGREES..=FINE_45_DEGREES).map(fine_tangent).collect();
        let column_angles =
            columns.iter().map(|&column| column_angle(&tangents, width, column)).collect();
        View {
            size,
            bar_rows: all_rows[view_rows..].into(),
            base_width: width,
            column_ray: (2 << COLUMN_RAY_BITS) / i64::from(width),
            base_view_rows,
            view_rows,
            chunk_stride: columns[CHUNK],
            columns,
            rows: rows.into(),
            first_column,
            first_row,
            row_scale: RowScale::new(u32::from(size.height), height, base_view_rows),
            focal_y,
            inverse_focal_y: (1 << 48) / focal_y,
            column_angles,
        }
    }

    /// Size of the frame.
    #[must_use]
    pub fn size(&self) -> FrameSize {
        self.size
    }

    /// Rows of the frame that show the world; the status bar fills the rest.
    #[must_use]
    pub fn view_rows(&self) -> usize {
        self.view_rows
    }

    /// Rows of the whole base grid, the status bar among them.
    pub(crate) fn base_rows(&self) -> u32 {
        if self.size == FrameSize::LEARNER {
            u32::from(FrameSize::CLASSIC.height)
        } else {
            u32::from(self.size.height)
        }
    }

    /// Whether the frame lacks columns and rows of the base grid.
    pub(crate) fn is_reduced(&self) -> bool {
        self.base_width as usize != self.width()
    }

    /// Frame columns.
    pub(crate) fn width(&self) -> usize {
        usize::from(self.size.width)
    }
}

/// Direction of the left edge of a base column relative to the view direction: the first fine
/// angle, from the right, whose tangent lies at the edge or to the left of it. `tangents` are those
/// of half the view to the right and half to the left.
fn column_angle(tangents: &[i64], width: u32, column: u32) -> Angle {
    // To the left is positive. Half a base column is the unit.
    let (width, left) = (i64::from(width), i64::from(width) - 2 * i64::from(column));
    let first = tangents.partition_point(|&tangent| tangent * width < left << 16);
    Angle::from_fine(first as i32 - FINE_45_DEGREES)
}

/// From base rows to the first frame row at or below them, without a table: the frame row `y` shows
/// base row `y * base height / height`, rounded down, so that the first at or below `row` is `row *
/// height / base height`, rounded up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowScale {
    pub factor: i32,
    pub addend: i32,
    /// One past the last base row that shows the world.
    pub last: i32,
}

impl RowScale {
    /// Fractional bits of the factor; few enough that 1080 rows fit.
    pub const BITS: u32 = 20;

    fn new(height: u32, base_height: u32, last: u32) -> RowScale {
        let factor = (height << RowScale::BITS).div_ceil(base_height) as i32;
        let addend = (((base_height - 1) << RowScale::BITS) / base_height) as i32;
        RowScale { factor, addend, last: last as i32 }
    }

    /// The frame row; base rows out of view count as the nearest end of it.
    #[inline(always)]
    pub(crate) fn frame_row(&self, base: i64) -> i16 {
        let base = base.clamp(0, i64::from(self.last)) as i32;
        ((base * self.factor + self.addend) >> RowScale::BITS) as i16
    }
}

/// Rows of a frame for each row of the status bar's art, as a fraction: the art is stretched with
/// the screen, by 1.2 more vertically, but never over more than 32 of 200 parts of the height; 320
/// columns show it as it is.
pub(crate) fn bar_scale(width: u32, height: u32) -> [u32; 2] {
    if width == BAR_ART_WIDTH {
        [1, 1]
    } else if 3 * width < 4 * height {
        [3 * width, 800]
    } else {
        [height, 200]
    }
}

/// Rows of the status bar.
fn bar_rows(width: u32, height: u32) -> u32 {
    let [rows, art] = bar_scale(width, height);
    (BAR_ART_HEIGHT * rows).div_ceil(art)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(width: u16, height: u16) -> View {
        View::new(FrameSize { width, height }).unwrap()
    }

    #[test]
    fn the_bar_takes_the_measured_rows() {
        for (width, height, view_rows) in
            [(160, 120, 100), (320, 240, 208), (640, 480, 403), (1280, 1024, 870)]
        {
            assert_eq!(view(width, height).view_rows, view_rows, "{width}x{height}");
        }
    }

    #[test]
    fn the_sky_turns_in_fine_angles() {
        let view = view(160, 120);
        let angles: Vec<i32> = view.column_angles.iter().map(|angle| angle.0 as i32).collect();
        assert_eq!(
            (angles[0], angles[80]),
            (1 << 29, 0),
            "45 degrees to the left, and straight ahead"
        );
        // Column 79's left edge is atan(1/80) = 16.296 fine angles to the left, column 81's as many
        // to the right.
        assert_eq!((angles[79], angles[81]), (17 << 19, -(16 << 19)));
        // Measured at 640 columns where the edge lies next to a fine angle:
        // at 380.0006, 213.9988, 57.0048, -133.9805 and -364.9978.
        let wide = View::new(FrameSize { width: 640, height: 480 }).unwrap();
        let fine = [224, 267, 306, 353, 412]
            .map(|column: usize| wide.column_angles[column].0 as i32 >> 19);
        assert_eq!(fine, [380, 215, 58, -134, -365]);
    }

    #[test]
    fn the_learners_frame_samples_the_classic_one() {
        let (small, large) = (view(128, 72), view(160, 120));
        assert_eq!(small.columns[..6], [0, 1, 2, 3, 5, 6]);
        assert_eq!(small.rows[..6], [0, 1, 3, 5, 6, 8]);
        assert_eq!(small.base_view_rows, large.base_view_rows);
        assert_eq!((small.view_rows, small.bar_rows.len()), (60, 12));
    }

    #[test]
    fn the_scale_of_rows_is_their_table() {
        for (width, height) in
            [(128, 72), (160, 120), (64, 48), (640, 480), (1001, 700), (1920, 1080)]
        {
            let view = view(width, height);
            for (base, &row) in view.first_row.iter().enumerate() {
                assert_eq!(
                    view.row_scale.frame_row(base as i64),
                    row,
                    "base row {base} of {width}x{height}"
                );
            }
            assert_eq!(view.row_scale.frame_row(i64::MIN), 0);
            assert_eq!(view.row_scale.frame_row(i64::MAX), view.view_rows as i16);
        }
    }

    #[test]
    fn chunks_of_columns_repeat() {
        for view in [view(128, 72), view(160, 120), view(1001, 700)] {
            for x in 0..view.columns.len() - CHUNK {
                assert_eq!(view.columns[x + CHUNK], view.columns[x] + view.chunk_stride);
            }
        }
    }

    #[test]
    fn sizes_out_of_range_are_refused() {
        for (width, height) in [(63, 48), (64, 47), (1921, 1080), (1920, 1081), (0, 0)] {
            assert!(View::new(FrameSize { width, height }).is_err());
        }
    }
}
