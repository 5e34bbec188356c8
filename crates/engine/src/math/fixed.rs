//! 16.16 fixed point.

use std::fmt;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Shl, Shr, Sub, SubAssign};

/// A 16.16 fixed-point number: the unit of every length (map units), height and speed (map units
/// per tic).
///
/// Multiplication floors (`(a * b) >> 16` on 64 bits) because the recorded trajectories do; all
/// operations wrap.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Fixed(pub i32);

impl Fixed {
    /// Zero.
    pub const ZERO: Fixed = Fixed(0);
    /// One map unit.
    pub const ONE: Fixed = Fixed(1 << 16);
    /// The largest value.
    pub const MAX: Fixed = Fixed(i32::MAX);
    /// The smallest value.
    pub const MIN: Fixed = Fixed(i32::MIN);

    /// A whole number of map units.
    #[must_use]
    pub const fn from_int(units: i32) -> Fixed {
        Fixed(units.wrapping_shl(16))
    }

    /// The nearest fixed-point value of `units`; for authoring and for reading recorded data, not
    /// for simulation.
    #[must_use]
    pub fn from_f64(units: f64) -> Fixed {
        Fixed((units * 65536.0).round() as i32)
    }

    /// The exact value as `f64`.
    #[must_use]
    pub fn to_f64(self) -> f64 {
        f64::from(self.0) / 65536.0
    }

    /// The value rounded down to whole map units.
    #[must_use]
    pub const fn floor(self) -> i32 {
        self.0 >> 16
    }

    /// The length of a vector, rounded down; the greatest number if that is too long.
    #[must_use]
    pub fn length_of(x: Fixed, y: Fixed) -> Fixed {
        let square = |part: Fixed| i64::from(part.0).unsigned_abs().pow(2);
        Fixed((square(x) + square(y)).isqrt().min(i32::MAX as u64) as i32)
    }

    /// The absolute value.
    #[must_use]
    pub const fn abs(self) -> Fixed {
        Fixed(self.0.wrapping_abs())
    }

    /// `self * numerator / denominator` without intermediate overflow, rounded down.
    #[must_use]
    pub const fn scale(self, numerator: i32, denominator: i32) -> Fixed {
        Fixed((self.0 as i64 * numerator as i64).div_euclid(denominator as i64) as i32)
    }
}

impl fmt::Debug for Fixed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.to_f64())
    }
}

impl fmt::Display for Fixed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.to_f64(), f)
    }
}

impl Add for Fixed {
    type Output = Fixed;
    fn add(self, other: Fixed) -> Fixed {
        Fixed(self.0.wrapping_add(other.0))
    }
}

impl Sub for Fixed {
    type Output = Fixed;
    fn sub(self, other: Fixed) -> Fixed {
        Fixed(self.0.wrapping_sub(other.0))
    }
}

impl Neg for Fixed {
    type Output = Fixed;
    fn neg(self) -> Fixed {
        Fixed(self.0.wrapping_neg())
    }
}

impl AddAssign for Fixed {
    fn add_assign(&mut self, other: Fixed) {
        *self = *self + other;
    }
}

impl SubAssign for Fixed {
    fn sub_assign(&mut self, other: Fixed) {
        *self = *self - other;
    }
}

impl Mul for Fixed {
    type Output = Fixed;
    fn mul(self, other: Fixed) -> Fixed {
        Fixed(((i64::from(self.0) * i64::from(other.0)) >> 16) as i32)
    }
}

/// Saturates where the quotient leaves the range, as division by zero does (towards the sign of the
/// dividend).
impl Div for Fixed {
    type Output = Fixed;
    fn div(self, other: Fixed) -> Fixed {
        if (self.0.unsigned_abs() >> 14) >= other.0.unsigned_abs() {
            return if (self.0 ^ other.0) < 0 { Fixed::MIN } else { Fixed::MAX };
        }
        Fixed(((i64::from(self.0) << 16) / i64::from(other.0)) as i32)
    }
}

impl Mul<i32> for Fixed {
    type Output = Fixed;
    fn mul(self, times: i32) -> Fixed {
        Fixed(self.0.wrapping_mul(times))
    }
}

impl Div<i32> for Fixed {
    type Output = Fixed;
    fn div(self, by: i32) -> Fixed {
        Fixed(self.0 / by)
    }
}

impl Shl<u32> for Fixed {
    type Output = Fixed;
    fn shl(self, bits: u32) -> Fixed {
        Fixed(self.0 << bits)
    }
}

impl Shr<u32> for Fixed {
    type Output = Fixed;
    fn shr(self, bits: u32) -> Fixed {
        Fixed(self.0 >> bits)
    }
}
