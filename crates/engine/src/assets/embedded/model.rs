//! Small solid models: eggs, limbs, tubes and blocks of painted material, from which sprites of any
//! side are taken.

use super::colour::Colour;
use super::vector::{Frame, Vector};

/// What a part is made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Material {
    /// In shadow, half lit, fully lit.
    pub(super) tones: [Colour; 3],
    /// Strength of the highlight, 0 for cloth.
    pub(super) gloss: f32,
    /// Strength of the blotches, and their size in texels.
    pub(super) mottle: f32,
    pub(super) mottle_size: f32,
    /// Whether it shines by itself: always its brightest tone, no outline.
    pub(super) glowing: bool,
    /// Whether it must stay visible although smaller than a texel (eyes, teeth).
    pub(super) fine: bool,
}

impl Material {
    /// A dull material of three tones, `0xRRGGBB` each: in shadow, half lit, fully lit.
    pub(super) const fn new(dark: u32, middle: u32, light: u32) -> Material {
        let tones = [Colour::hex(dark), Colour::hex(middle), Colour::hex(light)];
        Material { tones, gloss: 0.0, mottle: 0.0, mottle_size: 2.0, glowing: false, fine: false }
    }

    /// The same material polished.
    pub(super) const fn polished(mut self, gloss: f32) -> Material {
        self.gloss = gloss;
        self
    }

    /// The same material with blotches of a strength and size.
    pub(super) const fn mottled(mut self, strength: f32, size: f32) -> Material {
        self.mottle = strength;
        self.mottle_size = size;
        self
    }

    /// The same material glowing.
    pub(super) const fn glowing(mut self) -> Material {
        self.glowing = true;
        self
    }

    /// The same material, kept visible when tiny.
    pub(super) const fn fine(mut self) -> Material {
        self.fine = true;
        self
    }
}

/// The body of a part.
#[derive(Clone, Copy, Debug)]
pub(super) enum Shape {
    /// An ellipsoid: half lengths along the frame's forward, left, up.
    Egg { centre: Vector, half: Vector, frame: Frame },
    /// A cone with round ends.
    Limb { from: Vector, to: Vector, from_radius: f32, to_radius: f32 },
    /// A cone with flat ends.
    Tube { from: Vector, to: Vector, from_radius: f32, to_radius: f32 },
    /// A box: half lengths along the frame's forward, left, up.
    Block { centre: Vector, half: Vector, frame: Frame },
}

/// A solid with its material.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub(super) shape: Shape,
    pub(super) material: Material,
}

/// A figure made of parts; its anchor (where it stands) is the origin.
#[derive(Clone, Default)]
pub(super) struct Model {
    pub(super) parts: Vec<Part>,
}

impl Model {
    /// A figure without parts.
    pub(super) fn new() -> Model {
        Model::default()
    }

    fn add(&mut self, shape: Shape, material: Material) {
        self.parts.push(Part { shape, material });
    }

    /// Adds a sphere.
    pub(super) fn ball(&mut self, centre: Vector, radius: f32, material: Material) {
        self.egg(centre, Vector(radius, radius, radius), material);
    }

    /// Adds an upright ellipsoid.
    pub(super) fn egg(&mut self, centre: Vector, half: Vector, material: Material) {
        self.egg_in(Frame::WORLD, centre, half, material);
    }

    /// Adds an ellipsoid along a frame.
    pub(super) fn egg_in(
        &mut self,
        frame: Frame,
        centre: Vector,
        half: Vector,
        material: Material,
    ) {
        self.add(Shape::Egg { centre, half, frame }, material);
    }

    /// Adds a limb with round ends.
    pub(super) fn limb(&mut self, from: Vector, to: Vector, radii: (f32, f32), material: Material) {
        self.add(Shape::Limb { from, to, from_radius: radii.0, to_radius: radii.1 }, material);
    }

    /// Adds a limb of two bones.
    pub(super) fn jointed(&mut self, points: [Vector; 3], radii: [f32; 3], material: Material) {
        self.limb(points[0], points[1], (radii[0], radii[1]), material);
        self.limb(points[1], points[2], (radii[1], radii[2]), material);
    }

    /// Adds a tube (or cone) with flat ends.
    pub(super) fn tube(&mut self, from: Vector, to: Vector, radii: (f32, f32), material: Material) {
        self.add(Shape::Tube { from, to, from_radius: radii.0, to_radius: radii.1 }, material);
    }

    /// Adds an upright box.
    pub(super) fn block(&mut self, centre: Vector, half: Vector, material: Material) {
        self.block_in(Frame::WORLD, centre, half, material);
    }

    /// Adds a box along a frame.
    pub(super) fn block_in(
        &mut self,
        frame: Frame,
        centre: Vector,
        half: Vector,
        material: Material,
    ) {
        self.add(Shape::Block { centre, half, frame }, material);
    }

    /// Adds another figure, its axes along `frame` and its origin at `origin`.
    pub(super) fn attach(&mut self, other: &Model, frame: Frame, origin: Vector) {
        self.parts.extend(other.moved(frame, origin).parts);
    }

    /// The figure with its axes along `frame` and its origin at `origin`.
    pub(super) fn moved(&self, frame: Frame, origin: Vector) -> Model {
        let point = |p: Vector| origin + frame.out(p);
        let turn = |f: Frame| Frame {
            forward: frame.out(f.forward),
            left: frame.out(f.left),
            up: frame.out(f.up),
        };
        let parts = self.parts.iter().map(|part| {
            let shape = match part.shape {
                Shape::Egg { centre, half, frame } => {
                    Shape::Egg { centre: point(centre), half, frame: turn(frame) }
                }
                Shape::Block { centre, half, frame } => {
                    Shape::Block { centre: point(centre), half, frame: turn(frame) }
                }
                Shape::Limb { from, to, from_radius, to_radius } => {
                    Shape::Limb { from: point(from), to: point(to), from_radius, to_radius }
                }
                Shape::Tube { from, to, from_radius, to_radius } => {
                    Shape::Tube { from: point(from), to: point(to), from_radius, to_radius }
                }
            };
            Part { shape, material: part.material }
        });
        Model { parts: parts.collect() }
    }

    /// The figure enlarged around its origin.
    pub(super) fn scaled(&self, factor: f32) -> Model {
        let parts = self.parts.iter().map(|part| {
            let shape = match part.shape {
                Shape::Egg { centre, half, frame } => {
                    Shape::Egg { centre: centre * factor, half: half * factor, frame }
                }
                Shape::Block { centre, half, frame } => {
                    Shape::Block { centre: centre * factor, half: half * factor, frame }
                }
                Shape::Limb { from, to, from_radius, to_radius } => Shape::Limb {
                    from: from * factor,
                    to: to * factor,
                    from_radius: from_radius * factor,
                    to_radius: to_radius * factor,
                },
                Shape::Tube { from, to, from_radius, to_radius } => Shape::Tube {
                    from: from * factor,
                    to: to * factor,
                    from_radius: from_radius * factor,
                    to_radius: to_radius * factor,
                },
            };
            Part { shape, material: part.material }
        });
        Model { parts: parts.collect() }
    }

    /// The figure as an eye sees it that is `distance` behind the origin and `height` above it:
    /// what is farther ahead shrinks towards the point that the eye looks at. Long boxes are cut up
    /// so that they taper.
    pub(super) fn foreshortened(&self, distance: f32, height: f32) -> Model {
        let scale = |p: Vector| distance / (distance + p.0).max(distance * 0.2);
        let point = |p: Vector| Vector(p.0, p.1 * scale(p), (p.2 - height) * scale(p) + height);
        let mut out = Model::new();
        for &Part { shape, material } in &self.parts {
            match shape {
                Shape::Egg { centre, half, frame } => {
                    out.egg_in(frame, point(centre), half * scale(centre), material)
                }
                Shape::Limb { from, to, from_radius, to_radius } => {
                    out.limb(
                        point(from),
                        point(to),
                        (from_radius * scale(from), to_radius * scale(to)),
                        material,
                    );
                }
                Shape::Tube { from, to, from_radius, to_radius } => {
                    out.tube(
                        point(from),
                        point(to),
                        (from_radius * scale(from), to_radius * scale(to)),
                        material,
                    );
                }
                Shape::Block { centre, half, frame } => {
                    let pieces = (half.0 / 4.0) as i32 + 1;
                    let at = |cut: i32| {
                        centre + frame.forward * (half.0 * (2.0 * cut as f32 / pieces as f32 - 1.0))
                    };
                    for piece in 0..pieces {
                        let (from, to) = (point(at(piece)), point(at(piece + 1)));
                        let shrink = scale(at(piece).towards(at(piece + 1), 0.5));
                        let size =
                            Vector((to - from).length() * 0.52, half.1 * shrink, half.2 * shrink);
                        out.block_in(
                            Frame::facing(to - from, frame.up),
                            from.towards(to, 0.5),
                            size,
                            material,
                        );
                    }
                }
            }
        }
        out
    }
}
