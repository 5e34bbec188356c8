//! Takes sprites of solid models: parallel projection, a depth buffer at twice the resolution, and one lamp that stays at the
//! viewer's upper left, so that all things in the world look lit alike.

use super::canvas::Canvas;
use super::colour::{Colour, gradient};
use super::model::{Model, Part, Shape};
use super::noise::unit;
use super::vector::{Vector, turn};

/// Depth samples along each side of a texel.
const SAMPLES: usize = 2;

/// Where the viewer stands.
#[derive(Clone, Copy)]
pub(super) struct View {
    right: Vector,
    up: Vector,
    toward: Vector,
}

impl View {
    /// The viewer stands `degrees` counter-clockwise from the model's front, looking down at it by `above` degrees.
    pub(super) fn new(degrees: f32, above: f32) -> View {
        let ((cos, sin), (level, rise)) = (turn(degrees), turn(above));
        let flat = Vector(cos, sin, 0.0);
        View { right: Vector(-sin, cos, 0.0), up: Vector::UP * level - flat * rise, toward: flat * level + Vector::UP * rise }
    }

    /// One of the eight sides that sprites are drawn from, 0 the front, counter-clockwise.
    pub(super) fn side(rotation: usize) -> View {
        View::new(rotation as f32 * 45.0, 7.0)
    }

    /// A vector along right, up and towards the viewer.
    fn see(&self, v: Vector) -> Vector {
        Vector(v.dot(self.right), v.dot(self.up), v.dot(self.toward))
    }

    fn back(&self, v: Vector) -> Vector {
        self.right * v.0 + self.up * v.1 + self.toward * v.2
    }
}

/// A sprite with its anchor.
pub(super) struct Portrait {
    pub(super) canvas: Canvas,
    pub(super) offset_x: i32,
    pub(super) offset_y: i32,
}

/// A solid prepared for one view: all in right, up, toward coordinates.
enum Solid {
    Egg { centre: Vector, axes: [Vector; 3] },
    Cone { from: Vector, along: Vector, length: f32, radii: (f32, f32), round: bool },
    Block { centre: Vector, axes: [Vector; 3], half: [f32; 3] },
}

impl Solid {
    fn new(part: &Part, view: &View) -> Solid {
        match part.shape {
            Shape::Egg { centre, half, frame } => Solid::Egg {
                centre: view.see(centre),
                axes: [
                    view.see(frame.forward) * (1.0 / half.0),
                    view.see(frame.left) * (1.0 / half.1),
                    view.see(frame.up) * (1.0 / half.2),
                ],
            },
            Shape::Block { centre, half, frame } => Solid::Block {
                centre: view.see(centre),
                axes: [view.see(frame.forward), view.see(frame.left), view.see(frame.up)],
                half: [half.0, half.1, half.2],
            },
            Shape::Limb { from, to, from_radius, to_radius } | Shape::Tube { from, to, from_radius, to_radius } => {
                let (from, to) = (view.see(from), view.see(to));
                let length = (to - from).length().max(0.01);
                let along = (to - from) * (1.0 / length);
                let round = matches!(part.shape, Shape::Limb { .. });
                Solid::Cone { from, along, length, radii: (from_radius, to_radius), round }
            }
        }
    }

    /// Smallest and largest right and up coordinate.
    fn bounds(&self) -> [f32; 4] {
        match *self {
            Solid::Egg { centre, axes } => {
                // Half extent along a direction: the length of the half axes' shares in it.
                let extent = |pick: fn(Vector) -> f32| {
                    axes.iter().map(|&a| (pick(a) / a.dot(a)) * (pick(a) / a.dot(a))).sum::<f32>().sqrt()
                };
                let (w, h) = (extent(|a| a.0), extent(|a| a.1));
                [centre.0 - w, centre.0 + w, centre.1 - h, centre.1 + h]
            }
            Solid::Cone { from, along, length, radii, .. } => {
                let to = from + along * length;
                [
                    (from.0 - radii.0).min(to.0 - radii.1),
                    (from.0 + radii.0).max(to.0 + radii.1),
                    (from.1 - radii.0).min(to.1 - radii.1),
                    (from.1 + radii.0).max(to.1 + radii.1),
                ]
            }
            Solid::Block { centre, axes, half } => {
                let extent = |pick: fn(Vector) -> f32| (0..3).map(|i| pick(axes[i]).abs() * half[i]).sum::<f32>();
                let (w, h) = (extent(|a| a.0), extent(|a| a.1));
                [centre.0 - w, centre.0 + w, centre.1 - h, centre.1 + h]
            }
        }
    }

    /// The nearest surface point on the line of sight through (`x`, `y`): how near it is.
    fn depth(&self, x: f32, y: f32) -> Option<f32> {
        match *self {
            Solid::Egg { centre, axes } => {
                let (dx, dy) = (x - centre.0, y - centre.1);
                let (mut a, mut b, mut c) = (0.0, 0.0, -1.0);
                for axis in axes {
                    let flat = axis.0 * dx + axis.1 * dy;
                    a += axis.2 * axis.2;
                    b += axis.2 * flat;
                    c += flat * flat;
                }
                let under = b * b - a * c;
                (under >= 0.0).then(|| centre.2 + (under.sqrt() - b) / a)
            }
            Solid::Cone { from, along, length, radii, round } => cone_depth(x, y, from, along, length, radii, round),
            Solid::Block { centre, axes, half } => {
                let (dx, dy) = (x - centre.0, y - centre.1);
                let (mut near, mut far) = (f32::MAX, f32::MIN);
                for i in 0..3 {
                    let flat = axes[i].0 * dx + axes[i].1 * dy;
                    let slope = axes[i].2;
                    if slope.abs() < 1e-5 {
                        if flat.abs() > half[i] {
                            return None;
                        }
                    } else {
                        let (one, two) = ((half[i] - flat) / slope, (-half[i] - flat) / slope);
                        near = near.min(one.max(two));
                        far = far.max(one.min(two));
                    }
                }
                (near >= far).then_some(centre.2 + near)
            }
        }
    }

    /// The outward direction at a surface point.
    fn normal(&self, p: Vector) -> Vector {
        match *self {
            Solid::Egg { centre, axes } => {
                let q = p - centre;
                (axes[0] * q.dot(axes[0]) + axes[1] * q.dot(axes[1]) + axes[2] * q.dot(axes[2])).unit()
            }
            Solid::Cone { from, along, length, radii, round } => {
                let q = p - from;
                let y = q.dot(along);
                let sine = ((radii.0 - radii.1) / length).clamp(-0.99, 0.99);
                if round {
                    if y <= radii.0 * sine {
                        return q.unit();
                    }
                    if y >= length + radii.1 * sine {
                        return (q - along * length).unit();
                    }
                    ((q - along * y).unit() * (1.0 - sine * sine).sqrt() + along * sine).unit()
                } else if y > length - 0.05 {
                    along
                } else if y < 0.05 {
                    -along
                } else {
                    ((q - along * y).unit() + along * ((radii.0 - radii.1) / length)).unit()
                }
            }
            Solid::Block { centre, axes, half } => {
                let q = p - centre;
                let share = |i: usize| q.dot(axes[i]) / half[i];
                let face = (0..3).max_by(|&i, &j| share(i).abs().total_cmp(&share(j).abs())).unwrap_or(0);
                axes[face] * if share(face) < 0.0 { -1.0 } else { 1.0 }
            }
        }
    }
}

/// The nearest point of a cone. A round one is the hull of two balls: its flank touches them where the axial distance is the
/// radius times the sine of the taper, which is how far the flank reaches.
fn cone_depth(x: f32, y: f32, from: Vector, along: Vector, length: f32, radii: (f32, f32), round: bool) -> Option<f32> {
    let sine = ((radii.0 - radii.1) / length).clamp(-0.99, 0.99);
    // Flank radius at axial distance s: (offset - slope * s).
    let (slope, offset, start, end) = if round {
        let cosine = (1.0 - sine * sine).sqrt();
        (sine / cosine, radii.0 / cosine, radii.0 * sine, length + radii.1 * sine)
    } else {
        ((radii.0 - radii.1) / length, radii.0, 0.0, length)
    };
    let q = Vector(x - from.0, y - from.1, 0.0);
    let (q_along, d_along) = (q.dot(along), along.2);
    let r0 = offset - slope * q_along;
    let a = 1.0 - d_along * d_along * (1.0 + slope * slope);
    let b = -q_along * d_along + slope * d_along * r0;
    let c = q.dot(q) - q_along * q_along - r0 * r0;
    let mut best: Option<f32> = None;
    let mut offer = |depth: f32| best = Some(best.map_or(depth, |old| old.max(depth)));
    let under = b * b - a * c;
    if under >= 0.0 && a.abs() > 1e-5 {
        for t in [(-b + under.sqrt()) / a, (-b - under.sqrt()) / a] {
            let s = q_along + d_along * t;
            if s >= start && s <= end {
                offer(t);
            }
        }
    }
    if round {
        for (centre, radius) in [(Vector(0.0, 0.0, 0.0), radii.0), (along * length, radii.1)] {
            let (dx, dy) = (q.0 - centre.0, q.1 - centre.1);
            let under = radius * radius - dx * dx - dy * dy;
            if under >= 0.0 {
                offer(centre.2 + under.sqrt());
            }
        }
    } else if d_along.abs() > 1e-4 {
        for (s, radius) in [(0.0, radii.0), (length, radii.1)] {
            let t = (s - q_along) / d_along;
            let p = Vector(q.0, q.1, t) - along * s;
            if p.dot(p) <= radius * radius {
                offer(t);
            }
        }
    }
    best.map(|t| from.2 + t)
}

/// What one depth sample saw.
#[derive(Clone, Copy)]
struct Sample {
    depth: f32,
    part: u16,
}

const NOTHING: Sample = Sample { depth: f32::MIN, part: u16::MAX };

/// Takes the sprite of a model: cropped to what is seen, shaded, with the rim and the edges between near and far darkened.
pub(super) fn portrait(model: &Model, view: View) -> Portrait {
    let solids: Vec<Solid> = model.parts.iter().map(|part| Solid::new(part, &view)).collect();
    let mut bounds = [f32::MAX, f32::MIN, f32::MAX, f32::MIN];
    for solid in &solids {
        let b = solid.bounds();
        bounds = [bounds[0].min(b[0]), bounds[1].max(b[1]), bounds[2].min(b[2]), bounds[3].max(b[3])];
    }
    let (left, top) = (bounds[0].floor() as i32, bounds[3].ceil() as i32);
    let (width, height) = ((bounds[1].ceil() as i32 - left).max(1), (top - bounds[2].floor() as i32).max(1));
    let (columns, rows) = (width as usize * SAMPLES, height as usize * SAMPLES);
    let step = 1.0 / SAMPLES as f32;
    let right_of = |column: usize| left as f32 + (column as f32 + 0.5) * step;
    let up_of = |row: usize| top as f32 - (row as f32 + 0.5) * step;

    let mut samples = vec![NOTHING; columns * rows];
    for (part, solid) in solids.iter().enumerate() {
        let [from_x, to_x, from_y, to_y] = solid.bounds();
        let first_column = ((from_x - left as f32) * SAMPLES as f32) as usize;
        let last_column = (((to_x - left as f32) * SAMPLES as f32) as usize + 1).min(columns);
        let first_row = ((top as f32 - to_y) * SAMPLES as f32) as usize;
        let last_row = (((top as f32 - from_y) * SAMPLES as f32) as usize + 1).min(rows);
        for row in first_row..last_row {
            for column in first_column..last_column {
                if let Some(depth) = solid.depth(right_of(column), up_of(row)) {
                    let sample = &mut samples[row * columns + column];
                    if depth > sample.depth {
                        *sample = Sample { depth, part: part as u16 };
                    }
                }
            }
        }
    }

    let texels = texels(&samples, columns, width as usize, height as usize, model);
    let mut canvas = Canvas::new(width, height);
    for y in 0..height {
        for x in 0..width {
            let Some(texel) = texels[(y * width + x) as usize] else { continue };
            let (part, solid) = (&model.parts[texel.part as usize], &solids[texel.part as usize]);
            let point = Vector(right_of(texel.column), up_of(texel.row), texel.depth);
            let shadow = crease(&texels, x, y, width, height, texel.depth);
            canvas.set(x, y, shade(part, solid.normal(point), view.back(point), shadow));
        }
    }
    let glows =
        |x: i32, y: i32| texels[(y * width + x) as usize].is_some_and(|texel| model.parts[texel.part as usize].material.glowing);
    let before = canvas.clone();
    canvas.each(|x, y, colour| {
        let empty = |x, y| before.get(x, y).is_none();
        let rim = empty(x - 1, y) || empty(x + 1, y) || empty(x, y - 1) || empty(x, y + 1);
        if rim && !glows(x, y) { colour * 0.55 } else { colour }
    });
    Portrait { canvas, offset_x: -left, offset_y: top }
}

/// What a texel shows: the sample that stands for it.
#[derive(Clone, Copy)]
struct Texel {
    depth: f32,
    part: u16,
    column: usize,
    row: usize,
}

/// Chooses the sample of each texel: it needs half of its samples covered, unless something fine is among them.
fn texels(samples: &[Sample], columns: usize, width: usize, height: usize, model: &Model) -> Vec<Option<Texel>> {
    let mut texels = Vec::with_capacity(width * height);
    for y in 0..height {
        for x in 0..width {
            let (mut seen, mut chosen, mut chosen_fine) = (0, None::<Texel>, false);
            for i in 0..SAMPLES * SAMPLES {
                let (column, row) = (x * SAMPLES + i % SAMPLES, y * SAMPLES + i / SAMPLES);
                let sample = samples[row * columns + column];
                if sample.part == u16::MAX {
                    continue;
                }
                seen += 1;
                let fine = model.parts[sample.part as usize].material.fine;
                let nearer = chosen.is_none_or(|texel| sample.depth > texel.depth);
                if (fine && !chosen_fine) || (fine == chosen_fine && nearer) {
                    chosen = Some(Texel { depth: sample.depth, part: sample.part, column, row });
                    chosen_fine = fine;
                }
            }
            texels.push(chosen.filter(|_| seen * 2 >= SAMPLES * SAMPLES || chosen_fine));
        }
    }
    texels
}

/// How much a texel lies in the shade of nearer ones around it, 0..1.
fn crease(texels: &[Option<Texel>], x: i32, y: i32, width: i32, height: i32, depth: f32) -> f32 {
    let mut shade = 0.0;
    for (dx, dy, weight) in
        [(-1, 0, 0.3), (1, 0, 0.2), (0, -1, 0.35), (0, 1, 0.15), (-2, -1, 0.15), (1, -2, 0.15), (-1, -3, 0.15)]
    {
        let (at_x, at_y) = (x + dx, y + dy);
        if at_x >= 0
            && at_y >= 0
            && at_x < width
            && at_y < height
            && let Some(other) = texels[(at_y * width + at_x) as usize]
        {
            shade += weight * ((other.depth - depth - 0.8) / 3.0).clamp(0.0, 1.0);
        }
    }
    shade.min(1.0)
}

fn shade(part: &Part, normal: Vector, place: Vector, shadow: f32) -> Colour {
    let material = &part.material;
    if material.glowing {
        return material.tones[2].mix(material.tones[0], (1.0 - normal.2) * 0.8);
    }
    let lamp = Vector(-0.48, 0.62, 0.62);
    let direct = normal.dot(lamp).max(0.0);
    let sky = 0.5 + 0.5 * normal.1;
    let mut light = 0.08 + 0.66 * direct + 0.26 * sky;
    if material.mottle > 0.0 {
        light += material.mottle * (blotch(place, material.mottle_size) - 0.5);
    }
    let gloss = ((direct - 0.8).max(0.0) * 5.0) * material.gloss;
    (gradient(&material.tones, light) + Colour::grey(150.0) * (gloss * gloss)) * (1.0 - 0.55 * shadow)
}

/// Smooth random blotches in space, 0..1.
fn blotch(place: Vector, size: f32) -> f32 {
    let p = Vector(place.0 / size + 64.0, place.1 / size + 64.0, place.2 / size + 64.0);
    let (x, y, z) = (p.0 as i32, p.1 as i32, p.2 as i32);
    let (u, v, w) = (p.0 - x as f32, p.1 - y as f32, p.2 - z as f32);
    let corner = |dx: i32, dy: i32, dz: i32| unit(x + dx, y + dy, (z + dz) as u32);
    let mix = |a: f32, b: f32, part: f32| a + (b - a) * part;
    let layer = |dz| mix(mix(corner(0, 0, dz), corner(1, 0, dz), u), mix(corner(0, 1, dz), corner(1, 1, dz), u), v);
    mix(layer(0), layer(1), w)
}
