//! The parts of a model as one viewer sees them: where lines of sight first touch them and which
//! way their surface faces.
//!
//! All coordinates here are right, up, toward the viewer; a line of sight runs along the third.

use super::camera::View;
use super::model::{Part, Shape};
use super::vector::Vector;

/// What one line of sight meets.
#[derive(Clone, Copy)]
pub(super) struct Sample {
    /// How near to the viewer.
    pub(super) depth: f32,
    /// Index of the part.
    pub(super) part: u16,
}

impl Sample {
    /// A line of sight that meets nothing.
    pub(super) const NOTHING: Sample = Sample { depth: f32::MIN, part: u16::MAX };

    fn meet(&mut self, depth: f32, part: u16) {
        if depth > self.depth {
            *self = Sample { depth, part };
        }
    }
}

/// A row of evenly spaced lines of sight.
pub(super) struct Line {
    /// The row's up coordinate.
    pub(super) up: f32,
    /// Right coordinate of the first.
    pub(super) first_right: f32,
    /// Distance between neighbours, and its inverse.
    pub(super) step: f32,
    pub(super) per_step: f32,
}

impl Line {
    /// The samples that lie between two right coordinates.
    fn range(&self, from: f32, to: f32, count: usize) -> std::ops::Range<usize> {
        // One more at the left than strictly inside: a cast instead of a call to round up.
        let index = |right: f32| ((right - self.first_right) * self.per_step).max(0.0) as usize;
        index(from).min(count)..(index(to) + 1).min(count)
    }

    fn right(&self, index: usize) -> f32 {
        self.first_right + index as f32 * self.step
    }
}

/// A part prepared for one view.
pub(super) enum Solid {
    Egg(Egg),
    Cone(Cone),
    Block(Block),
}

impl Solid {
    /// Prepares a part.
    pub(super) fn new(part: &Part, view: &View) -> Solid {
        match part.shape {
            Shape::Egg { centre, half, frame } => Solid::Egg(Egg::new(
                view.see(centre),
                [
                    view.see(frame.forward) * (1.0 / half.0),
                    view.see(frame.left) * (1.0 / half.1),
                    view.see(frame.up) * (1.0 / half.2),
                ],
            )),
            Shape::Block { centre, half, frame } => Solid::Block(Block {
                centre: view.see(centre),
                axes: [view.see(frame.forward), view.see(frame.left), view.see(frame.up)],
                half: [half.0, half.1, half.2],
            }),
            Shape::Limb { from, to, from_radius, to_radius } => {
                Solid::Cone(Cone::new(view.see(from), view.see(to), (from_radius, to_radius), true))
            }
            Shape::Tube { from, to, from_radius, to_radius } => Solid::Cone(Cone::new(
                view.see(from),
                view.see(to),
                (from_radius, to_radius),
                false,
            )),
        }
    }

    /// Smallest and largest right, smallest and largest up coordinate.
    pub(super) fn bounds(&self) -> [f32; 4] {
        let around = |centre: Vector, (width, height): (f32, f32)| {
            [centre.0 - width, centre.0 + width, centre.1 - height, centre.1 + height]
        };
        match self {
            Solid::Egg(egg) => around(egg.centre, egg.extent),
            Solid::Block(block) => around(block.centre, block.extent()),
            Solid::Cone(cone) => {
                let (a, b, (ra, rb)) = (cone.from, cone.to, cone.radii);
                [
                    (a.0 - ra).min(b.0 - rb),
                    (a.0 + ra).max(b.0 + rb),
                    (a.1 - ra).min(b.1 - rb),
                    (a.1 + ra).max(b.1 + rb),
                ]
            }
        }
    }

    /// Lets a row of lines of sight meet the solid.
    pub(super) fn scan(&self, line: &Line, part: u16, samples: &mut [Sample]) {
        match self {
            Solid::Egg(egg) => egg.scan(line, part, samples),
            Solid::Cone(cone) => cone.scan(line, part, samples),
            Solid::Block(block) => block.scan(line, part, samples),
        }
    }

    /// The outward direction at a point of the surface.
    pub(super) fn normal(&self, point: Vector) -> Vector {
        match self {
            Solid::Egg(egg) => {
                let q = point - egg.centre;
                egg.axes
                    .iter()
                    .fold(Vector::default(), |sum, &axis| sum + axis * q.dot(axis))
                    .unit()
            }
            Solid::Cone(cone) => cone.normal(point),
            Solid::Block(block) => block.normal(point),
        }
    }
}

/// An ellipsoid: the points whose shares along the three axes have squares that sum to one.
pub(super) struct Egg {
    centre: Vector,
    /// Directions of the axes, each divided by its half length.
    axes: [Vector; 3],
    /// Half width and half height as seen.
    extent: (f32, f32),
    /// The quadratic equation for the depth t at (x, y): `a t² + 2 (b·(x, y)) t + ... = 0`, and its
    /// discriminant `a - (d0 x² + 2 d1 x y + d2 y²)`.
    a: f32,
    b: (f32, f32),
    d: [f32; 3],
}

impl Egg {
    fn new(centre: Vector, axes: [Vector; 3]) -> Egg {
        let sum = |term: fn(Vector) -> f32| axes.iter().map(|&axis| term(axis)).sum::<f32>();
        let a = sum(|v| v.2 * v.2);
        let b = (sum(|v| v.2 * v.0), sum(|v| v.2 * v.1));
        let (xx, xy, yy) = (sum(|v| v.0 * v.0), sum(|v| v.0 * v.1), sum(|v| v.1 * v.1));
        let d = [a * xx - b.0 * b.0, a * xy - b.0 * b.1, a * yy - b.1 * b.1];
        // The outline is where the discriminant vanishes; its box follows from the 2 by 2 form.
        let area = (d[0] * d[2] - d[1] * d[1]).max(1e-12);
        let extent = ((a * d[2] / area).sqrt(), (a * d[0] / area).sqrt());
        Egg { centre, axes, extent, a, b, d }
    }

    fn scan(&self, line: &Line, part: u16, samples: &mut [Sample]) {
        let y = line.up - self.centre.1;
        // Where the discriminant is positive: a span around `middle`.
        let middle = -self.d[1] * y / self.d[0];
        let rest = self.a - self.d[2] * y * y + self.d[1] * self.d[1] * y * y / self.d[0];
        if rest <= 0.0 {
            return;
        }
        let reach = (rest / self.d[0]).sqrt();
        let right = self.centre.0 + middle;
        let inverse = 1.0 / self.a;
        for index in line.range(right - reach, right + reach, samples.len()) {
            let x = line.right(index) - self.centre.0;
            let away = x - middle;
            let under = rest - self.d[0] * away * away;
            if under >= 0.0 {
                let depth = self.centre.2 + (under.sqrt() - self.b.0 * x - self.b.1 * y) * inverse;
                samples[index].meet(depth, part);
            }
        }
    }
}

/// A cone. A round one is the hull of two balls: its flank touches them where the axial distance is
/// the radius times the sine of the taper, which is how far the flank reaches.
pub(super) struct Cone {
    from: Vector,
    to: Vector,
    along: Vector,
    length: f32,
    radii: (f32, f32),
    round: bool,
    /// The flank's radius at axial distance s is `offset - slope s`, for s between `start` and
    /// `end`.
    slope: f32,
    offset: f32,
    start: f32,
    end: f32,
    /// Sine of the taper.
    sine: f32,
}

impl Cone {
    fn new(from: Vector, to: Vector, radii: (f32, f32), round: bool) -> Cone {
        let length = (to - from).length().max(0.01);
        let along = (to - from) * (1.0 / length);
        let sine = ((radii.0 - radii.1) / length).clamp(-0.99, 0.99);
        let (slope, offset, start, end) = if round {
            let cosine = (1.0 - sine * sine).sqrt();
            (sine / cosine, radii.0 / cosine, radii.0 * sine, length + radii.1 * sine)
        } else {
            ((radii.0 - radii.1) / length, radii.0, 0.0, length)
        };
        Cone { from, to, along, length, radii, round, slope, offset, start, end, sine }
    }

    fn scan(&self, line: &Line, part: u16, samples: &mut [Sample]) {
        // Only the stretch of the axis that passes within the larger radius of this row matters.
        let wide = self.radii.0.max(self.radii.1);
        let rise = self.to.1 - self.from.1;
        let (low, high) = if rise.abs() < 0.01 {
            (0.0, 1.0)
        } else {
            let (one, two) =
                ((line.up - wide - self.from.1) / rise, (line.up + wide - self.from.1) / rise);
            (one.min(two).clamp(0.0, 1.0), one.max(two).clamp(0.0, 1.0))
        };
        let run = self.to.0 - self.from.0;
        let (one, two) = (self.from.0 + run * low, self.from.0 + run * high);
        let y = line.up - self.from.1;
        let slant = self.along.2;
        let a = 1.0 - slant * slant * (1.0 + self.slope * self.slope);
        let inverse = 1.0 / a;
        for index in line.range(one.min(two) - wide, one.max(two) + wide, samples.len()) {
            let x = line.right(index) - self.from.0;
            let level = x * self.along.0 + y * self.along.1;
            let radius = self.offset - self.slope * level;
            let b = slant * (self.slope * radius - level);
            let c = x * x + y * y - level * level - radius * radius;
            let under = b * b - a * c;
            if a > 1e-4 {
                // The whole body lies inside its endless flank: a line of sight that misses the
                // flank misses all.
                if under < 0.0 {
                    continue;
                }
                let t = (under.sqrt() - b) * inverse;
                let s = level + slant * t;
                if s >= self.start && s <= self.end {
                    samples[index].meet(self.from.2 + t, part);
                    continue;
                }
            } else if under >= 0.0 && a < -1e-4 {
                for t in [(under.sqrt() - b) * inverse, (-under.sqrt() - b) * inverse] {
                    let s = level + slant * t;
                    if s >= self.start && s <= self.end {
                        samples[index].meet(self.from.2 + t, part);
                    }
                }
            }
            self.meet_ends(x, y, level, part, &mut samples[index]);
        }
    }

    fn meet_ends(&self, x: f32, y: f32, level: f32, part: u16, sample: &mut Sample) {
        let far = self.to - self.from;
        if self.round {
            for (centre, radius) in [(Vector::default(), self.radii.0), (far, self.radii.1)] {
                let (dx, dy) = (x - centre.0, y - centre.1);
                let under = radius * radius - dx * dx - dy * dy;
                if under >= 0.0 {
                    sample.meet(self.from.2 + centre.2 + under.sqrt(), part);
                }
            }
        } else if self.along.2.abs() > 1e-4 {
            for (s, centre, radius) in
                [(0.0, Vector::default(), self.radii.0), (self.length, far, self.radii.1)]
            {
                let t = (s - level) / self.along.2;
                let p = Vector(x, y, t) - centre;
                if p.dot(p) <= radius * radius {
                    sample.meet(self.from.2 + t, part);
                }
            }
        }
    }

    fn normal(&self, point: Vector) -> Vector {
        let q = point - self.from;
        let s = q.dot(self.along);
        if self.round {
            if s <= self.start {
                return q.unit();
            }
            if s >= self.end {
                return (point - self.to).unit();
            }
            let cosine = (1.0 - self.sine * self.sine).sqrt();
            ((q - self.along * s).unit() * cosine + self.along * self.sine).unit()
        } else if s > self.length - 0.05 {
            self.along
        } else if s < 0.05 {
            -self.along
        } else {
            ((q - self.along * s).unit() + self.along * self.slope).unit()
        }
    }
}

/// A box.
pub(super) struct Block {
    centre: Vector,
    axes: [Vector; 3],
    half: [f32; 3],
}

impl Block {
    /// Half width and half height as seen.
    fn extent(&self) -> (f32, f32) {
        let reach = |pick: fn(Vector) -> f32| {
            (0..3).map(|i| pick(self.axes[i]).abs() * self.half[i]).sum::<f32>()
        };
        (reach(|v| v.0), reach(|v| v.1))
    }

    fn scan(&self, line: &Line, part: u16, samples: &mut [Sample]) {
        let y = line.up - self.centre.1;
        let (width, _) = self.extent();
        for index in line.range(self.centre.0 - width, self.centre.0 + width, samples.len()) {
            let x = line.right(index) - self.centre.0;
            // Between each pair of faces the line of sight is inside from `far` to `near`.
            let (mut near, mut far) = (f32::MAX, f32::MIN);
            for (axis, half) in self.axes.iter().zip(self.half) {
                let level = axis.0 * x + axis.1 * y;
                if axis.2.abs() < 1e-5 {
                    if level.abs() > half {
                        (near, far) = (f32::MIN, f32::MAX);
                    }
                } else {
                    let (one, two) = ((half - level) / axis.2, (-half - level) / axis.2);
                    near = near.min(one.max(two));
                    far = far.max(one.min(two));
                }
            }
            if near >= far {
                samples[index].meet(self.centre.2 + near, part);
            }
        }
    }

    fn normal(&self, point: Vector) -> Vector {
        let q = point - self.centre;
        let share = |i: usize| q.dot(self.axes[i]) / self.half[i];
        let face = (0..3).max_by(|&i, &j| share(i).abs().total_cmp(&share(j).abs())).unwrap_or(0);
        self.axes[face] * if share(face) < 0.0 { -1.0 } else { 1.0 }
    }
}
