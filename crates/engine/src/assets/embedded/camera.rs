//! Takes sprites of solid models: parallel projection, a depth buffer at twice the resolution, and
//! one lamp that stays at the viewer's upper left, so that all things in the world look lit alike.

use super::canvas::Canvas;
use super::colour::{Colour, gradient};
use super::model::{Model, Part};
use super::noise::hash;
use super::solid::{Line, Sample, Solid};
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
    /// The viewer stands `degrees` counter-clockwise from the model's front, looking down at it by
    /// `above` degrees.
    pub(super) fn new(degrees: f32, above: f32) -> View {
        let ((cos, sin), (level, rise)) = (turn(degrees), turn(above));
        let flat = Vector(cos, sin, 0.0);
        View {
            right: Vector(-sin, cos, 0.0),
            up: Vector::UP * level - flat * rise,
            toward: flat * level + Vector::UP * rise,
        }
    }

    /// One of the eight sides that sprites are drawn from, 0 the front, counter-clockwise.
    pub(super) fn side(rotation: usize) -> View {
        View::new(rotation as f32 * 45.0, 7.0)
    }

    /// A vector along right, up and towards the viewer.
    pub(super) fn see(&self, v: Vector) -> Vector {
        Vector(v.dot(self.right), v.dot(self.up), v.dot(self.toward))
    }

    /// The opposite of [`View::see`].
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

/// Takes the sprite of a model: cropped to what is seen, shaded, with the rim and the edges between
/// near and far darkened.
pub(super) fn portrait(model: &Model, view: View) -> Portrait {
    portrait_above(model, view, f32::MIN)
}

/// As [`portrait`], but nothing lower than `lowest` (above the anchor, in texels) is drawn.
pub(super) fn portrait_above(model: &Model, view: View, lowest: f32) -> Portrait {
    let solids: Vec<Solid> = model.parts.iter().map(|part| Solid::new(part, &view)).collect();
    let mut bounds = [f32::MAX, f32::MIN, f32::MAX, f32::MIN];
    for solid in &solids {
        let b = solid.bounds();
        bounds =
            [bounds[0].min(b[0]), bounds[1].max(b[1]), bounds[2].min(b[2]), bounds[3].max(b[3])];
    }
    let (left, top) = (bounds[0].floor() as i32, bounds[3].ceil() as i32);
    let (width, height) = (
        (bounds[1].ceil() as i32 - left).max(1),
        (top - bounds[2].max(lowest).floor() as i32).max(1),
    );
    let (columns, rows) = (width as usize * SAMPLES, height as usize * SAMPLES);
    let step = 1.0 / SAMPLES as f32;
    let right_of = |column: usize| left as f32 + (column as f32 + 0.5) * step;
    let up_of = |row: usize| top as f32 - (row as f32 + 0.5) * step;

    let mut samples = vec![Sample::NOTHING; columns * rows];
    for (part, solid) in solids.iter().enumerate() {
        let [_, _, from_y, to_y] = solid.bounds();
        let first_row = ((top as f32 - to_y) * SAMPLES as f32).max(0.0) as usize;
        let last_row = (((top as f32 - from_y) * SAMPLES as f32).max(0.0) as usize + 1).min(rows);
        for row in first_row..last_row {
            let line =
                Line { up: up_of(row), first_right: right_of(0), step, per_step: SAMPLES as f32 };
            solid.scan(&line, part as u16, &mut samples[row * columns..][..columns]);
        }
    }

    let texels = Texels::new(&samples, columns, width as usize, height as usize, model);
    let mut canvas = Canvas::new(width, height);
    for x in 0..width {
        for y in 0..height {
            let Some(texel) = texels.at(x, y) else { continue };
            let (part, solid) = (&model.parts[texel.part as usize], &solids[texel.part as usize]);
            let point = Vector(right_of(texel.column), up_of(texel.row), texel.depth);
            let shaded = shade(part, solid.normal(point), view.back(point));
            let kept =
                if part.material.glowing { 1.0 } else { texels.kept_light(x, y, texel.depth) };
            canvas.set(x, y, shaded * kept);
        }
    }
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

/// The texels of a portrait.
struct Texels {
    width: i32,
    height: i32,
    texels: Vec<Option<Texel>>,
}

impl Texels {
    /// Chooses the sample of each texel: it needs half of its samples covered, unless something
    /// fine is among them.
    fn new(
        samples: &[Sample],
        columns: usize,
        width: usize,
        height: usize,
        model: &Model,
    ) -> Texels {
        let mut texels = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                let (mut seen, mut chosen, mut chosen_fine) = (0, None::<Texel>, false);
                for i in 0..SAMPLES * SAMPLES {
                    let (column, row) = (x * SAMPLES + i % SAMPLES, y * SAMPLES + i / SAMPLES);
                    let sample = samples[row * columns + column];
                    if sample.part == Sample::NOTHING.part {
                        continue;
                    }
                    seen += 1;
                    let fine = model.parts[sample.part as usize].material.fine;
                    let nearer = chosen.is_none_or(|texel| sample.depth > texel.depth);
                    if (fine && !chosen_fine) || (fine == chosen_fine && nearer) {
                        chosen =
                            Some(Texel { depth: sample.depth, part: sample.part, column, row });
                        chosen_fine = fine;
                    }
                }
                texels.push(chosen.filter(|_| seen * 2 >= SAMPLES * SAMPLES || chosen_fine));
            }
        }
        Texels { width: width as i32, height: height as i32, texels }
    }

    fn at(&self, x: i32, y: i32) -> Option<Texel> {
        if x < 0 || y < 0 || x >= self.width || y >= self.height {
            return None;
        }
        self.texels[(y * self.width + x) as usize]
    }

    /// The part of its light that a texel keeps: less beside nearer ones, which shade it, and on
    /// the outline.
    fn kept_light(&self, x: i32, y: i32, depth: f32) -> f32 {
        let (mut shade, mut rim) = (0.0, false);
        for (dx, dy, weight) in [
            (-1, 0, 0.3),
            (1, 0, 0.2),
            (0, -1, 0.35),
            (0, 1, 0.15),
            (-2, -1, 0.15),
            (1, -2, 0.15),
            (-1, -3, 0.15),
        ] {
            match self.at(x + dx, y + dy) {
                Some(other) => {
                    shade += weight * ((other.depth - depth - 0.8) * 0.33).clamp(0.0, 1.0)
                }
                None => rim |= dx * dx + dy * dy == 1,
            }
        }
        (1.0 - 0.55_f32 * f32::min(shade, 1.0)) * if rim { 0.55 } else { 1.0 }
    }
}

fn shade(part: &Part, normal: Vector, place: Vector) -> Colour {
    let material = &part.material;
    if material.glowing {
        return gradient(&material.tones, 0.12 + 0.62 * normal.2 * normal.2);
    }
    let lamp = Vector(-0.48, 0.62, 0.62);
    let direct = normal.dot(lamp).max(0.0);
    let sky = 0.5 + 0.5 * normal.1;
    let mut light = 0.08 + 0.66 * direct + 0.26 * sky;
    if material.mottle > 0.0 {
        light += material.mottle * (blotch(place, material.mottle_size) - 0.5);
    }
    let gloss = ((direct - 0.8).max(0.0) * 5.0) * material.gloss;
    gradient(&material.tones, light) + Colour::grey(150.0) * (gloss * gloss)
}

/// Random values on a cubic lattice of 16 points a side, worked out by the compiler.
static LATTICE: [u8; 4096] = {
    let mut values = [0; 4096];
    let mut i = 0;
    while i < 4096 {
        values[i] = (hash(i as i32, 0, 99) >> 13) as u8;
        i += 1;
    }
    values
};

/// Smooth random blotches in space, 0..1.
fn blotch(place: Vector, size: f32) -> f32 {
    let p = place * (1.0 / size) + Vector(64.0, 64.0, 64.0);
    let (x, y, z) = (p.0 as usize, p.1 as usize, p.2 as usize);
    let (u, v, w) = (p.0 - x as f32, p.1 - y as f32, p.2 - z as f32);
    let corner = |dx, dy, dz| {
        f32::from(LATTICE[((x + dx) & 15) << 8 | ((y + dy) & 15) << 4 | ((z + dz) & 15)])
    };
    let mix = |a: f32, b: f32, part: f32| a + (b - a) * part;
    let layer = |dz| {
        mix(
            mix(corner(0, 0, dz), corner(1, 0, dz), u),
            mix(corner(0, 1, dz), corner(1, 1, dz), u),
            v,
        )
    };
    mix(layer(0), layer(1), w) / 255.0
}
