//! Directions and points of the small solid models: x forward, y to the left, z up, in texels.

use std::ops::{Add, Mul, Neg, Sub};

/// A point or direction.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(super) struct Vector(pub(super) f32, pub(super) f32, pub(super) f32);

impl Vector {
    pub(super) const FORWARD: Vector = Vector(1.0, 0.0, 0.0);
    pub(super) const LEFT: Vector = Vector(0.0, 1.0, 0.0);
    pub(super) const UP: Vector = Vector(0.0, 0.0, 1.0);

    pub(super) fn dot(self, other: Vector) -> f32 {
        self.0 * other.0 + self.1 * other.1 + self.2 * other.2
    }

    pub(super) fn cross(self, other: Vector) -> Vector {
        Vector(
            self.1 * other.2 - self.2 * other.1,
            self.2 * other.0 - self.0 * other.2,
            self.0 * other.1 - self.1 * other.0,
        )
    }

    pub(super) fn length(self) -> f32 {
        self.dot(self).sqrt()
    }

    /// The direction of this vector; that of a zero vector is up.
    pub(super) fn unit(self) -> Vector {
        let length = self.length();
        if length < 1e-6 { Vector::UP } else { self * (1.0 / length) }
    }

    /// The point at `part` of the way to `other`.
    pub(super) fn towards(self, other: Vector, part: f32) -> Vector {
        self + (other - self) * part
    }
}

impl Add for Vector {
    type Output = Vector;
    fn add(self, other: Vector) -> Vector {
        Vector(self.0 + other.0, self.1 + other.1, self.2 + other.2)
    }
}

impl Sub for Vector {
    type Output = Vector;
    fn sub(self, other: Vector) -> Vector {
        Vector(self.0 - other.0, self.1 - other.1, self.2 - other.2)
    }
}

impl Mul<f32> for Vector {
    type Output = Vector;
    fn mul(self, factor: f32) -> Vector {
        Vector(self.0 * factor, self.1 * factor, self.2 * factor)
    }
}

impl Neg for Vector {
    type Output = Vector;
    fn neg(self) -> Vector {
        self * -1.0
    }
}

/// Cosine and sine of an angle in degrees, from a polynomial: the platform's own functions differ
/// in the last bits.
pub(super) fn turn(degrees: f32) -> (f32, f32) {
    (sine(degrees + 90.0), sine(degrees))
}

fn sine(degrees: f32) -> f32 {
    let mut turns = degrees / 360.0;
    turns -= turns.floor();
    let (quarter, sign) = if turns < 0.5 { (turns, 1.0) } else { (turns - 0.5, -1.0) };
    // 0..0.25..0.5 of a turn: fold on the top, then the Taylor polynomial up to the seventh power.
    let folded = if quarter > 0.25 { 0.5 - quarter } else { quarter };
    let x = folded * std::f32::consts::TAU;
    let square = x * x;
    sign * x * (1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0)))
}

/// Three directions at right angles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) forward: Vector,
    pub(super) left: Vector,
    pub(super) up: Vector,
}

impl Frame {
    /// The frame of the model itself.
    pub(super) const WORLD: Frame =
        Frame { forward: Vector::FORWARD, left: Vector::LEFT, up: Vector::UP };

    /// A frame whose forward is given and whose up leans as little as possible from `up`.
    pub(super) fn facing(forward: Vector, up: Vector) -> Frame {
        let forward = forward.unit();
        let left = up.cross(forward).unit();
        Frame { forward, left, up: forward.cross(left) }
    }

    /// The frame that results from leaning forward by `pitch`, to the left side by `roll`, then
    /// turning left by `yaw` degrees.
    pub(super) fn turned(pitch: f32, roll: f32, yaw: f32) -> Frame {
        let ((cp, sp), (cr, sr), (cy, sy)) = (turn(pitch), turn(roll), turn(yaw));
        let rotate = |v: Vector| {
            let v = Vector(v.0, v.1 * cr + v.2 * sr, v.2 * cr - v.1 * sr);
            let v = Vector(v.0 * cp + v.2 * sp, v.1, v.2 * cp - v.0 * sp);
            Vector(v.0 * cy - v.1 * sy, v.0 * sy + v.1 * cy, v.2)
        };
        Frame {
            forward: rotate(Vector::FORWARD),
            left: rotate(Vector::LEFT),
            up: rotate(Vector::UP),
        }
    }

    /// A vector given along this frame's directions, in the model's.
    pub(super) fn out(self, v: Vector) -> Vector {
        self.forward * v.0 + self.left * v.1 + self.up * v.2
    }
}

/// The middle joint of a limb of two bones of lengths `first` and `second` from `root` to `end`,
/// bent towards `bend`. An end out of reach gives the straight limb.
pub(super) fn joint(root: Vector, end: Vector, first: f32, second: f32, bend: Vector) -> Vector {
    let reach = (end - root).length().max(0.01);
    let along = (end - root) * (1.0 / reach);
    let foot =
        ((first * first - second * second + reach * reach) / (2.0 * reach)).clamp(-first, first);
    let aside = bend - along * bend.dot(along);
    root + along * foot + aside.unit() * (first * first - foot * foot).max(0.0).sqrt()
}
