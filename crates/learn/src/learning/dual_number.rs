//! Numbers that carry their derivatives, so that a loss written as its formula knows its own
//! gradient.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number and its derivatives in `N` variables: forward-mode differentiation.
///
/// A sample's loss depends on two or three numbers (the probability ratio, a divergence, a value),
/// so that carrying all derivatives along is cheaper than recording what was done and going back
/// through it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct DualNumber<const N: usize> {
    /// The value that the derivatives are of.
    pub value: f64,
    /// Its derivative in each variable.
    pub slopes: [f64; N],
}

impl<const N: usize> DualNumber<N> {
    /// The variable of an index.
    #[must_use]
    pub fn variable(value: f64, index: usize) -> DualNumber<N> {
        let mut slopes = [0.0; N];
        slopes[index] = 1.0;
        DualNumber { value, slopes }
    }

    /// A number that depends on no variable.
    #[must_use]
    pub const fn constant(value: f64) -> DualNumber<N> {
        DualNumber { value, slopes: [0.0; N] }
    }

    /// A function's value here, by the chain rule from its derivative here.
    fn chain(self, value: f64, derivative: f64) -> DualNumber<N> {
        DualNumber { value, slopes: self.slopes.map(|slope| slope * derivative) }
    }

    /// The exponential.
    #[must_use]
    pub fn exp(self) -> DualNumber<N> {
        let value = libm::exp(self.value);
        self.chain(value, value)
    }

    /// The square.
    #[must_use]
    pub fn square(self) -> DualNumber<N> {
        self * self
    }

    /// The smaller of two; where they are equal, this one.
    #[must_use]
    pub fn min(self, other: DualNumber<N>) -> DualNumber<N> {
        if other.value < self.value { other } else { self }
    }

    /// The larger of two; where they are equal, this one.
    #[must_use]
    pub fn max(self, other: DualNumber<N>) -> DualNumber<N> {
        if other.value > self.value { other } else { self }
    }

    /// Within bounds; constant beyond them.
    #[must_use]
    pub fn clamp(self, low: f64, high: f64) -> DualNumber<N> {
        if (low..=high).contains(&self.value) {
            self
        } else {
            DualNumber::constant(self.value.clamp(low, high))
        }
    }
}

impl<const N: usize> Add for DualNumber<N> {
    type Output = DualNumber<N>;

    fn add(self, other: DualNumber<N>) -> DualNumber<N> {
        DualNumber {
            value: self.value + other.value,
            slopes: std::array::from_fn(|i| self.slopes[i] + other.slopes[i]),
        }
    }
}

impl<const N: usize> Sub for DualNumber<N> {
    type Output = DualNumber<N>;

    fn sub(self, other: DualNumber<N>) -> DualNumber<N> {
        self + -other
    }
}

impl<const N: usize> Mul for DualNumber<N> {
    type Output = DualNumber<N>;

    #[allow(clippy::suspicious_arithmetic_impl, reason = "the product rule is a sum")]
    fn mul(self, other: DualNumber<N>) -> DualNumber<N> {
        let slopes =
            std::array::from_fn(|i| self.slopes[i] * other.value + self.value * other.slopes[i]);
        DualNumber { value: self.value * other.value, slopes }
    }
}

impl<const N: usize> Neg for DualNumber<N> {
    type Output = DualNumber<N>;

    fn neg(self) -> DualNumber<N> {
        self.chain(-self.value, -1.0)
    }
}

impl<const N: usize> Add<f64> for DualNumber<N> {
    type Output = DualNumber<N>;

    fn add(self, number: f64) -> DualNumber<N> {
        self.chain(self.value + number, 1.0)
    }
}

impl<const N: usize> Sub<f64> for DualNumber<N> {
    type Output = DualNumber<N>;

    fn sub(self, number: f64) -> DualNumber<N> {
        self.chain(self.value - number, 1.0)
    }
}

impl<const N: usize> Mul<f64> for DualNumber<N> {
    type Output = DualNumber<N>;

    fn mul(self, number: f64) -> DualNumber<N> {
        self.chain(self.value * number, number)
    }
}

impl<const N: usize> Div<f64> for DualNumber<N> {
    type Output = DualNumber<N>;

    fn div(self, number: f64) -> DualNumber<N> {
        self.chain(self.value / number, 1.0 / number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every operation in one expression, with either side of each bound, against central
    /// differences.
    #[test]
    fn derivatives_equal_differences() {
        let function = |[x, y]: [DualNumber<2>; 2]| {
            let bounded = (x * y - 0.3).clamp(-0.5, 0.5).max(y / 4.0) + (-x).min(y.square()) * 1.7;
            bounded * (x * 0.5 + 0.1).exp() - y.max(x).min(x * 3.0)
        };
        let at =
            |x: f64, y: f64| function([DualNumber::constant(x), DualNumber::constant(y)]).value;
        let h = 1e-6;
        for (x, y) in [(0.4, -0.7), (1.3, 0.9), (-0.8, 2.1), (-1.1, -0.2), (0.2, 0.5)] {
            let found = function([DualNumber::variable(x, 0), DualNumber::variable(y, 1)]);
            assert_eq!(found.value, at(x, y));
            let expected = [
                (at(x + h, y) - at(x - h, y)) / (2.0 * h),
                (at(x, y + h) - at(x, y - h)) / (2.0 * h),
            ];
            for (found, expected) in found.slopes.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-8, "at {x}, {y}: {found} against {expected}");
            }
        }
    }
}
