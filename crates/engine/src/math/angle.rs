//! 32-bit binary angles and their frozen trigonometry.

use super::Fixed;
use super::quarter_sine::QUARTER_SINE;
use std::fmt;
use std::ops::{Add, AddAssign, Neg, Sub, SubAssign};

/// A 32-bit binary angle: the full circle is 2^32, 0 is east, counter-clockwise is positive.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Angle(pub u32);

impl Angle {
    /// East.
    pub const EAST: Angle = Angle(0);
    /// 45 degrees.
    pub const DEG_45: Angle = Angle(0x2000_0000);
    /// North, a quarter turn.
    pub const DEG_90: Angle = Angle(0x4000_0000);
    /// West, half a turn.
    pub const DEG_180: Angle = Angle(0x8000_0000);

    /// From degrees, for authoring and for reading recorded data.
    #[must_use]
    pub fn from_degrees(degrees: f64) -> Angle {
        Angle((degrees / 360.0 * 4_294_967_296.0).round() as i64 as u32)
    }

    /// Degrees in `[0, 360)`.
    #[must_use]
    pub fn to_degrees(self) -> f64 {
        f64::from(self.0) * 360.0 / 4_294_967_296.0
    }

    /// From 65536ths of a turn, the unit of scripts and of turn commands.
    #[must_use]
    pub const fn from_turn_65536(units: i32) -> Angle {
        Angle((units as u32) << 16)
    }

    /// From 8192ths of a turn, the unit of the sine table.
    #[must_use]
    pub const fn from_fine(fine: i32) -> Angle {
        Angle((fine as u32) << 19)
    }

    /// Sine by the 8192-entry fine table (`angle >> 19`).
    #[must_use]
    pub fn sin(self) -> Fixed {
        fine_sine(self.0 >> 19)
    }

    /// Cosine by the 8192-entry fine table.
    #[must_use]
    pub fn cos(self) -> Fixed {
        fine_sine((self.0 >> 19).wrapping_add(2048))
    }

    /// Tangent, saturating at the poles.
    #[must_use]
    pub fn tan(self) -> Fixed {
        self.sin() / self.cos()
    }

    /// The direction of the vector `(dx, dy)`, exact to the table's 1/8192 turn and refined linearly; `(0, 0)` is east.
    #[must_use]
    pub fn of_vector(dx: Fixed, dy: Fixed) -> Angle {
        if dx.0 == 0 && dy.0 == 0 {
            return Angle(0);
        }
        let (ax, ay) = (i64::from(dx.0).abs(), i64::from(dy.0).abs());
        // First octant: find t with tan(t) = small / large by bisection over the quarter table (0..=45 degrees).
        let (small, large) = if ay <= ax { (ay, ax) } else { (ax, ay) };
        let (mut low, mut high) = (0usize, 1024usize);
        while high - low > 1 {
            let middle = (low + high) / 2;
            if excess(small, large, middle) >= 0 { low = middle } else { high = middle }
        }
        let (below, above) = (excess(small, large, low), excess(small, large, low + 1));
        let fraction = if below > above { ((below << 19) / (below - above)) as u32 } else { 0 };
        let octant = ((low as u32) << 19) + fraction.min(1 << 19);
        let quadrant = if ay <= ax { octant } else { 0x4000_0000 - octant };
        Angle(match (dx.0 < 0, dy.0 < 0) {
            (false, false) => quadrant,
            (true, false) => 0x8000_0000 - quadrant,
            (true, true) => 0x8000_0000 + quadrant,
            (false, true) => 0u32.wrapping_sub(quadrant),
        })
    }
}

/// `small * cos(i) - large * sin(i)`: positive while the table angle `i` is below the vector's.
fn excess(small: i64, large: i64, i: usize) -> i64 {
    let cosine = if i == 0 { 1 << 16 } else { i64::from(QUARTER_SINE[2048 - i]) };
    (small * cosine - large * i64::from(QUARTER_SINE[i])) >> 16
}

/// The whole fine sine. Its second quarter mirrors the first one entry early (entry `2048 + i` is entry `2047 - i`, the
/// peak apart), so that it is not quite symmetric: the recorded view bob follows exactly this table.
static FINE_SINE: [i32; 8192] = {
    let mut table = [0; 8192];
    let mut i = 0;
    while i < 2048 {
        table[i] = QUARTER_SINE[i];
        table[2048 + i] = QUARTER_SINE[2047 - i];
        table[4096 + i] = -table[i];
        table[6144 + i] = -table[2048 + i];
        i += 1;
    }
    table[2048] = 1 << 16;
    table[6144] = -(1 << 16);
    table
};

/// Sine of a fine angle, 8192ths of a turn.
fn fine_sine(fine: u32) -> Fixed {
    Fixed(FINE_SINE[(fine & 8191) as usize])
}

impl fmt::Debug for Angle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}deg", self.to_degrees())
    }
}

impl Add for Angle {
    type Output = Angle;
    fn add(self, other: Angle) -> Angle {
        Angle(self.0.wrapping_add(other.0))
    }
}

impl Sub for Angle {
    type Output = Angle;
    fn sub(self, other: Angle) -> Angle {
        Angle(self.0.wrapping_sub(other.0))
    }
}

impl Neg for Angle {
    type Output = Angle;
    fn neg(self) -> Angle {
        Angle(self.0.wrapping_neg())
    }
}

impl AddAssign for Angle {
    fn add_assign(&mut self, other: Angle) {
        *self = *self + other;
    }
}

impl SubAssign for Angle {
    fn sub_assign(&mut self, other: Angle) {
        *self = *self - other;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frozen_table_is_the_sine() {
        for (i, &value) in QUARTER_SINE.iter().enumerate() {
            let exact = (i as f64 * std::f64::consts::TAU / 8192.0).sin() * 65536.0;
            assert_eq!(f64::from(value), exact.floor(), "entry {i}");
        }
    }

    #[test]
    fn the_second_quarter_mirrors_the_first_one_entry_early() {
        let sine = |fine| Angle::from_fine(fine).sin().0;
        assert_eq!((sine(2047), sine(2048), sine(2049), sine(2050)), (65535, 65536, 65535, 65535));
        assert_eq!((sine(4094), sine(4095), sine(4096), sine(4097)), (50, 0, 0, -50));
        for i in 1..2048 {
            assert_eq!(sine(2048 + i), sine(2047 - i), "entry {i} of the second quarter");
            assert_eq!(sine(4096 + i), -sine(i), "entry {i} of the third quarter");
        }
    }

    #[test]
    fn directions_agree_with_atan2() {
        for (dx, dy) in [(1, 0), (3, 1), (1, 3), (-5, 2), (-1, -1), (7, -300), (0, -1), (-1, 0), (1000, 999)] {
            let angle = Angle::of_vector(Fixed::from_int(dx), Fixed::from_int(dy));
            let exact = f64::from(dy).atan2(f64::from(dx)).to_degrees().rem_euclid(360.0);
            let error = (angle.to_degrees() - exact).abs();
            assert!(error.min(360.0 - error) < 0.002, "({dx}, {dy}): {angle:?} against {exact}");
        }
    }
}
