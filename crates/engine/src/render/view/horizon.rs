//! Where the horizon lies at a pitch, and how far away floors are in each row below it.

use crate::math::{STEEPEST, fine_tangent};
use crate::render::view::tables::View;

/// The horizon in base rows, 16.16, at a pitch (negative surfaces up): a shear, so that verticals
/// stay vertical.
pub(crate) fn at_pitch(view: &View, pitch: i32) -> i64 {
    // A quarter turn less the pitch, cut to fine angles.
    let fine = ((0x4000_0000 - i64::from(pitch)) >> 19) as i32 - 2048;
    // Beyond what a player can look.
    let tangent = fine_tangent(fine.clamp(-STEEPEST, STEEPEST));
    (i64::from(view.base_view_rows) << 15) + ((view.focal_y * tangent) >> 16)
}

/// The part of a row, 16.16, that floors in the row of the horizon count as below it at least.
const NEAREST: i64 = 64;

/// How much longer the vertical focal length is for floors than the horizontal one, 16.16: 1.2, but
/// cut as in ViZDoom, which moves distant floors by a thousandth of a texel.
const FLOOR_ASPECT: i64 = 78_643;

/// What the rows of a frame have in common for every floor and ceiling.
#[derive(Clone, Debug, Default)]
pub(crate) struct PlaneRows {
    /// The horizon that they are for.
    horizon: Option<i64>,
    /// By frame row: distance of a floor one unit below the eye, or of a ceiling one above; 16.16.
    pub distances: Vec<i64>,
    /// By frame row: rows from the horizon, 16.16, for the light.
    pub rows: Vec<i64>,
    /// By frame row: texel row of the sky, once somebody has asked.
    sky: Vec<u16>,
}

impl PlaneRows {
    /// The texel row of the sky in each frame row, which `compute` gives for a horizon when they
    /// are first asked for.
    pub fn sky_rows<Rows: Iterator<Item = u16>>(
        &mut self,
        compute: impl FnOnce(i64) -> Rows,
    ) -> &[u16] {
        if self.sky.is_empty() {
            self.sky.extend(compute(self.horizon.unwrap_or_default()));
        }
        &self.sky
    }

    /// Brings them up to date; most worlds never move the horizon.
    pub fn update(&mut self, view: &View, horizon: i64) {
        if self.horizon.replace(horizon) == Some(horizon) {
            return;
        }
        let (rows, below) =
            (&view.rows[..view.view_rows], |row: u32| (i64::from(row) << 16) - horizon);
        self.rows.clear();
        self.rows.extend(rows.iter().map(|&row| below(row).abs()));
        self.distances.clear();
        self.sky.clear();
        // The middle of the row decides how far the floor is in it.
        let middle = |row: u32| (below(row) + (1 << 15)).abs().max(NEAREST);
        let focal = (i64::from(view.base_width) * FLOOR_ASPECT) >> 1;
        self.distances.extend(rows.iter().map(|&row| (focal << 16) / middle(row)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Angle;
    use crate::render::view::size::FrameSize;

    fn view(width: u16, height: u16) -> View {
        View::new(FrameSize { width, height }).unwrap()
    }

    #[test]
    fn pitch_shears_by_the_measured_rows() {
        for (width, height, level) in
            [(160, 120, 50.0), (320, 240, 104.0), (640, 480, 201.5), (1280, 1024, 435.0)]
        {
            let rows = |degrees: f64| {
                at_pitch(&view(width, height), Angle::from_degrees(degrees).0 as i32) as f64
                    / 65536.0
            };
            let focal = f64::from(width) * 0.6;
            assert_eq!(rows(0.0), level);
            for degrees in [-32.0, 16.479_492_187_5, 56.0] {
                let exact = level - focal * f64::to_radians(degrees).tan();
                // A pitch is cut to 0.044 degrees.
                assert!(
                    (rows(degrees) - exact).abs() < focal * 0.0025,
                    "{degrees} degrees at {width}x{height}"
                );
            }
            // 375 fine angles down: the tangent 0.29583 is 19387.1 of 65536 parts, of which 19386
            // are left.
            let shear = level - rows(16.479_492_187_5);
            assert!((shear - focal * 19386.0 / 65536.0).abs() < 1e-3, "{shear}");
        }
    }

    #[test]
    fn every_row_of_every_pitch_has_a_slope() {
        let mut slopes = PlaneRows::default();
        for (width, height) in [(64, 48), (1920, 1080), (64, 1080), (1920, 48), (128, 72)] {
            let view = view(width, height);
            for pitch in [i32::MIN, -(1 << 29), 0, 1 << 29, i32::MAX] {
                slopes.update(&view, at_pitch(&view, pitch));
                assert_eq!(
                    (slopes.distances.len(), slopes.rows.len()),
                    (view.view_rows, view.view_rows)
                );
                assert!(slopes.distances.iter().all(|&distance| distance > 0));
            }
        }
    }

    #[test]
    fn slopes_are_those_of_the_rows_middles() {
        let (view, mut slopes) = (view(160, 120), PlaneRows::default());
        slopes.update(&view, 50 << 16);
        // The focal length is 96 rows.
        let at = |row: usize| slopes.distances[row] as f64 / 65536.0;
        assert!((at(90) - 96.0 / 40.5).abs() < 1e-4 && (at(0) - 96.0 / 49.5).abs() < 1e-4);
        assert_eq!((slopes.rows[90], slopes.rows[0]), (40 << 16, 50 << 16));
    }
}
