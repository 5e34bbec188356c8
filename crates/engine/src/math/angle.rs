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

    /// The direction of the vector `(dx, dy)`, exact to the table's 1/8192 turn and refined
    /// linearly; `(0, 0)` is east.
    #[must_use]
    pub fn of_vector(dx: Fixed, dy: Fixed) -> Angle {
        if dx.0 == 0 && dy.0 == 0 {
            return Angle(0);
        }
        let (ax, ay) = (i64::from(dx.0).abs(), i64::from(dy.0).abs());
        // First octant: the last table angle t with tan(t) at most small / large. A list has the
        // one for whole 1024ths, and between two of these lie no more than two.
        let (small, large) = if ay <= ax { (ay, ax) } else { (ax, ay) };
        let mut low = usize::from(OF_RATIO[((small << 10) / large) as usize & 2047]);
        for _ in 0..2 {
            low += usize::from(low < LAST_OF_OCTANT && excess(small, large, low + 1) >= 0);
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

    /// The direction of the vector `(dx, dy)` as ViZDoom computes it: by its slope from
    /// the nearest axis, cut to whole 2048ths, and from some axes a unit short; `(0, 0)` is north.
    #[must_use]
    pub fn of_slope(dx: Fixed, dy: Fixed) -> Angle {
        let (ax, ay) = (i64::from(dx.0).abs(), i64::from(dy.0).abs());
        let (small, large) = if ax > ay { (ay, ax) } else { (ax, ay) };
        let slope = ((small << 3) / (large >> 8).max(1)).min(2048) as i32;
        let octant = Angle::of_vector(Fixed::from_int(2048), Fixed::from_int(slope)).0;
        let quarter = 0x4000_0000_u32;
        Angle(match (dx.0 < 0, dy.0 < 0, ax > ay) {
            (false, false, true) => octant,
            (false, false, false) => quarter - 1 - octant,
            (true, false, false) => quarter + octant,
            (true, false, true) => 2 * quarter - 1 - octant,
            (true, true, true) => 2 * quarter + octant,
            (true, true, false) => 3 * quarter - 1 - octant,
            (false, true, false) => 3 * quarter + octant,
            (false, true, true) => 0u32.wrapping_sub(octant),
        })
    }
}

/// `small * cos(i) - large * sin(i)`: positive while the table angle `i` is below the vector's.
const fn excess(small: i64, large: i64, i: usize) -> i64 {
    let cosine = if i == 0 { 1 << 16 } else { QUARTER_SINE[2048 - i] as i64 };
    (small * cosine - large * QUARTER_SINE[i] as i64) >> 16
}

/// The last table angle below 45 degrees.
const LAST_OF_OCTANT: usize = 1023;

/// For each 1024th, up to 1, the last table angle of the first octant whose tangent is no greater;
/// padded.
static OF_RATIO: [u16; 2048] = {
    let mut list = [LAST_OF_OCTANT as u16; 2048];
    let (mut ratio, mut angle) = (0, 0);
    while ratio < 1024 {
        while angle < LAST_OF_OCTANT && excess(ratio, 1024, angle + 1) >= 0 {
            angle += 1;
        }
        list[ratio as usize] = angle as u16;
        ratio += 1;
    }
    list
};

/// The whole fine sine. Its second quarter mirrors the first one entry early (entry `2048 + i` is
/// entry `2047 - i`, the peak apart), so that it is not quite symmetric: the recorded view bob
/// follows exactly this table.
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
    fn the_table_angle_of_a_vector_is_the_last_one_below_it() {
        let mut rng = crate::math::Rng::new(77);
        for round in 0..20_000u32 {
            // Short vectors, long ones, and those near 45 degrees or an axis.
            let mut any = |bits: u32| (rng.next_u64() >> (64 - bits)) as i32;
            let dx = 1 + any(1 + round % 30);
            let dy = match round % 4 {
                0 => (dx - any(4)).max(0),
                1 => any(4).min(dx),
                _ => ((i64::from(dx) * i64::from(any(20))) >> 20) as i32,
            };
            let bisected = {
                let (mut low, mut high) = (0, 1024);
                while high - low > 1 {
                    let middle = (low + high) / 2;
                    if excess(i64::from(dy), i64::from(dx), middle) >= 0 {
                        low = middle
                    } else {
                        high = middle
                    }
                }
                low
            };
            let angle = Angle::of_vector(Fixed(dx), Fixed(dy)).0;
            assert!(
                (0..=1 << 19).contains(&(angle - ((bisected as u32) << 19))),
                "({dx}, {dy}): {angle:#x}, not {bisected}"
            );
        }
    }

    #[test]
    fn directions_agree_with_atan2() {
        for (dx, dy) in
            [(1, 0), (3, 1), (1, 3), (-5, 2), (-1, -1), (7, -300), (0, -1), (-1, 0), (1000, 999)]
        {
            let angle = Angle::of_vector(Fixed::from_int(dx), Fixed::from_int(dy));
            let exact = f64::from(dy).atan2(f64::from(dx)).to_degrees().rem_euclid(360.0);
            let error = (angle.to_degrees() - exact).abs();
            assert!(error.min(360.0 - error) < 0.002, "({dx}, {dy}): {angle:?} against {exact}");
        }
    }

    #[test]
    fn directions_by_slope_are_at_most_a_2048th_short() {
        let mut rng = crate::math::Rng::new(3);
        let unit = 4_294_967_296.0 / std::f64::consts::TAU / 2048.0;
        for _ in 0..10_000 {
            let [dx, dy] = [(); 2].map(|()| Fixed(rng.between(-60 << 16, 60 << 16)));
            let (by_slope, exact) =
                (Angle::of_slope(dx, dy).0, dy.to_f64().atan2(dx.to_f64()) * 2048.0 * unit);
            let difference = f64::from(by_slope.wrapping_sub(exact as i64 as u32) as i32) / unit;
            // Cut towards the nearest axis, which lies clockwise in every other octant. Short
            // vectors' slopes are cut more coarsely.
            let clockwise = (dx.0.abs() > dy.0.abs()) == ((dx.0 < 0) == (dy.0 < 0));
            let off = if clockwise { -difference } else { difference };
            let coarse = 2048.0 / f64::from(dx.0.abs().max(dy.0.abs()) >> 8);
            assert!((-0.01 - coarse..1.01).contains(&off), "{off} for {dx:?} {dy:?}");
        }
        let north = Angle::of_slope(Fixed::ZERO, Fixed::ONE);
        assert_eq!([north.0, Angle::of_slope(Fixed::ONE, Fixed::ZERO).0], [0x3FFF_FFFF, 0]);
    }
}
