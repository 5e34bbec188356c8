//! Where the horizon lies at a pitch, and how far away floors are in each row below it.

use super::View;

/// Steepest pitch that is drawn, in fine angles of 8192 a turn: 60 degrees, beyond what a player can look.
const STEEPEST: i32 = 8192 / 6;
/// Fractional bits of the series.
const BITS: u32 = 60;

/// Tangents of the fine angles up to the steepest, 16.16. The sine table is too coarse to divide by itself.
static TANGENTS: [i32; STEEPEST as usize + 1] = {
    let mut table = [0; STEEPEST as usize + 1];
    let mut i = 0;
    while i < table.len() {
        let (sine, cosine) = sine_and_cosine(i as i128);
        table[i] = (((sine << 16) + cosine / 2) / cosine) as i32;
        i += 1;
    }
    table
};

/// Sine and cosine of a fine angle by their power series.
const fn sine_and_cosine(fine: i128) -> (i128, i128) {
    // Pi with 60 fractional bits.
    const PI: i128 = 0x3243_F6A8_885A_308D;
    let angle = PI * fine / 4096;
    let (mut sine, mut cosine) = (0, 0);
    let (mut term, mut n) = (1i128 << BITS, 0);
    while n < 24 {
        let signed = if n % 4 < 2 { term } else { -term };
        if n % 2 == 0 {
            cosine += signed;
        } else {
            sine += signed;
        }
        n += 1;
        term = ((term * angle) >> BITS) / n;
    }
    (sine, cosine)
}

/// The horizon in base rows, 16.16, at a pitch (negative looks up): a shear, so that verticals stay vertical.
pub(super) fn at_pitch(view: &View, pitch: i32) -> i64 {
    // A quarter turn less the pitch, cut to fine angles.
    let fine = ((0x4000_0000 - i64::from(pitch)) >> 19) as i32 - 2048;
    let fine = fine.clamp(-STEEPEST, STEEPEST);
    let tangent = i64::from(TANGENTS[fine.unsigned_abs() as usize]);
    // Negative ones are rounded towards zero after a half was added, as the published engine was seen to do: a thousandth
    // of a row, which moves distant floors by half a texel.
    let tangent = if fine < 0 { 1 - tangent } else { tangent };
    (i64::from(view.base_view_rows) << 15) + ((view.focal_y * tangent) >> 16)
}

/// The part of a row, 16.16, that floors in the row of the horizon count as below it at least.
const NEAREST: i64 = 64;

/// What the rows of a frame have in common for every floor and ceiling.
#[derive(Clone, Debug, Default)]
pub(super) struct RowSlopes {
    /// The horizon that they are for.
    horizon: Option<i64>,
    /// By frame row: distance of a floor one unit below the eye, or of a ceiling one above; 16.16.
    pub distances: Vec<i64>,
    /// By frame row: rows from the horizon, 16.16, for the light.
    pub rows: Vec<i64>,
    /// By frame row: texel row of the sky, once somebody has asked.
    sky: Vec<u16>,
}

impl RowSlopes {
    /// The texel row of the sky in each frame row, which `compute` gives for a horizon when they are first asked for.
    pub fn sky_rows<Rows: Iterator<Item = u16>>(&mut self, compute: impl FnOnce(i64) -> Rows) -> &[u16] {
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
        let (rows, below) = (&view.rows[..view.view_rows], |row: u32| (i64::from(row) << 16) - horizon);
        self.rows.clear();
        self.rows.extend(rows.iter().map(|&row| below(row).abs()));
        self.distances.clear();
        self.sky.clear();
        // The middle of the row decides how far the floor is in it.
        let middle = |row: u32| (below(row) + (1 << 15)).abs().max(NEAREST);
        self.distances.extend(rows.iter().map(|&row| (view.focal_y << 16) / middle(row)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Angle;
    use crate::render::FrameSize;

    fn view(width: u16, height: u16) -> View {
        View::new(FrameSize { width, height }).unwrap()
    }

    #[test]
    fn tangents_are_rounded_to_the_nearest() {
        for (fine, &tangent) in TANGENTS.iter().enumerate() {
            let exact = (fine as f64 * std::f64::consts::TAU / 8192.0).tan() * 65536.0;
            assert_eq!(f64::from(tangent), exact.round(), "fine angle {fine}");
        }
    }

    #[test]
    fn pitch_shears_by_the_measured_rows() {
        for (width, height, level) in [(160, 120, 50.0), (320, 240, 104.0), (640, 480, 201.5), (1280, 1024, 435.0)] {
            let rows = |degrees: f64| at_pitch(&view(width, height), Angle::from_degrees(degrees).0 as i32) as f64 / 65536.0;
            let focal = f64::from(width) * 0.6;
            assert_eq!(rows(0.0), level);
            for degrees in [-32.0, 16.479_492_187_5, 56.0] {
                let exact = level - focal * f64::to_radians(degrees).tan();
                // A pitch is cut to 0.044 degrees.
                assert!((rows(degrees) - exact).abs() < focal * 0.0025, "{degrees} degrees at {width}x{height}");
            }
            // 375 fine angles down: the tangent 0.29583 is 19387.1 of 65536 parts, of which 19386 are left.
            let shear = level - rows(16.479_492_187_5);
            assert!((shear - focal * 19386.0 / 65536.0).abs() < 1e-3, "{shear}");
        }
    }

    #[test]
    fn every_row_of_every_pitch_has_a_slope() {
        let mut slopes = RowSlopes::default();
        for (width, height) in [(64, 48), (1920, 1080), (64, 1080), (1920, 48), (128, 72)] {
            let view = view(width, height);
            for pitch in [i32::MIN, -(1 << 29), 0, 1 << 29, i32::MAX] {
                slopes.update(&view, at_pitch(&view, pitch));
                assert_eq!((slopes.distances.len(), slopes.rows.len()), (view.view_rows, view.view_rows));
                assert!(slopes.distances.iter().all(|&distance| distance > 0));
            }
        }
    }

    #[test]
    fn slopes_are_those_of_the_rows_middles() {
        let (view, mut slopes) = (view(160, 120), RowSlopes::default());
        slopes.update(&view, 50 << 16);
        // The focal length is 96 rows.
        let at = |row: usize| slopes.distances[row] as f64 / 65536.0;
        assert!((at(90) - 96.0 / 40.5).abs() < 1e-4 && (at(0) - 96.0 / 49.5).abs() < 1e-4);
        assert_eq!((slopes.rows[90], slopes.rows[0]), (40 << 16, 50 << 16));
    }
}
