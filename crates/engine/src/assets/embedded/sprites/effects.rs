//! Fire, smoke, blood and shots in flight.

use super::creatures::{ahead_from, seen_around};
use super::decorations::barrel;
use crate::assets::embedded::camera::View;
use crate::assets::embedded::canvas::Canvas;
use crate::assets::embedded::colour::{Colour, gradient};
use crate::assets::embedded::gallery::Gallery;
use crate::assets::embedded::model::{Material, Model};
use crate::assets::embedded::noise::{Field, unit};
use crate::assets::embedded::vector::{Vector, turn};

const FIRE: [Colour; 6] = [
    Colour::hex(0x401004),
    Colour::hex(0x8C2804),
    Colour::hex(0xD86008),
    Colour::hex(0xFFA020),
    Colour::hex(0xFFE060),
    Colour::hex(0xFFFFE0),
];
const SMOKE: [Colour; 3] = [Colour::hex(0x181818), Colour::hex(0x505050), Colour::hex(0x989898)];
const BLUE_FIRE: [Colour; 4] =
    [Colour::hex(0x081060), Colour::hex(0x2850F0), Colour::hex(0x80C8FF), Colour::hex(0xF0FFFF)];
const GREEN_FIRE: [Colour; 4] =
    [Colour::hex(0x084008), Colour::hex(0x28B020), Colour::hex(0x80FF60), Colour::hex(0xF4FFE8)];

/// Paints the effects.
pub(super) fn paint(gallery: &mut Gallery) {
    let rocket = seen_around(gallery, &rocket());
    gallery.frame("MISL", rocket);
    for (size, heat, seed) in [(30, 1.0, 1), (42, 0.8, 2), (52, 0.55, 3)] {
        centred(gallery, "MISL", &fireball(size, heat, &FIRE, seed));
    }
    barrel_blast(gallery);
    for (i, size) in [5, 9, 13, 17].into_iter().enumerate() {
        // A: the spark; B-D: smoke that spreads and thins.
        let canvas = if i == 0 { fireball(size, 0.85, &FIRE, 20) } else { smoke(size, i as u32) };
        centred(gallery, "PUFF", &canvas);
    }
    for (i, size) in [16, 20, 23, 25, 26].into_iter().enumerate() {
        centred(gallery, "RSMK", &smoke(size, i as u32));
    }
    for (i, size) in [9, 8, 6].into_iter().enumerate() {
        let blood = [Colour::hex(0x400404), Colour::hex(0x980C08), Colour::hex(0xE02818)];
        centred(gallery, "BLUD", &fireball(size, 0.7, &blood, 30 + i as u32));
    }
    for (name, tones, sizes) in [
        ("PLSS", &BLUE_FIRE, &[13, 15][..]),
        ("PLSE", &BLUE_FIRE, &[20, 24, 26, 22, 14][..]),
        ("BFS1", &GREEN_FIRE, &[40, 44][..]),
        ("BFE1", &GREEN_FIRE, &[60, 70, 76, 70, 56, 40][..]),
    ] {
        for (i, &size) in sizes.iter().enumerate() {
            let heat = 1.0 - 0.5 * i as f32 / sizes.len() as f32;
            centred(gallery, name, &fireball(size, heat, tones, 40 + i as u32));
        }
    }
}

/// Adds a frame whose anchor is its middle: shots and blasts are centred on their position.
fn centred(gallery: &mut Gallery, name: &str, canvas: &Canvas) {
    gallery.flat_frame(name, canvas, canvas.width / 2, canvas.height / 2);
}

/// The rocket in flight, nose forward; anchored at its middle.
fn rocket() -> Model {
    let steel = Material::new(0x24282C, 0x70787E, 0xD0D8DC).polished(0.9);
    let mut m = Model::new();
    let z = 4.0;
    m.tube(Vector(-8.0, 0.0, z), Vector(6.0, 0.0, z), (2.8, 2.8), steel);
    m.limb(
        Vector(6.0, 0.0, z),
        Vector(11.0, 0.0, z),
        (2.6, 0.6),
        Material::new(0x580404, 0xC01810, 0xFF5840).polished(0.7),
    );
    for i in 0..4 {
        let (cos, sin) = turn(45.0 + i as f32 * 90.0);
        m.limb(
            Vector(-4.0, cos * 2.6, z + sin * 2.6),
            Vector(-9.0, cos * 5.4, z + sin * 5.4),
            (0.9, 1.1),
            steel,
        );
    }
    let flame = Material::new(0xD04804, 0xFFA820, 0xFFFFC0).glowing();
    m.limb(Vector(-8.0, 0.0, z), Vector(-17.0, 0.0, z), (2.6, 0.7), flame);
    m.ball(Vector(-8.6, 0.0, z), 3.2, Material::new(0xFF9010, 0xFFE070, 0xFFFFF0).glowing());
    m
}

/// A ragged ball of fire, smoke or gore; `heat` is how much of its tones' upper end shows.
pub(super) fn fireball(size: i32, heat: f32, tones: &[Colour], seed: u32) -> Canvas {
    let mut canvas = Canvas::new(size, size);
    let cells = (size as usize / 4).clamp(2, 9);
    let billow = Field::clouds(size as usize, size as usize, (cells, cells), 3, seed);
    let radius = size as f32 / 2.0;
    for x in 0..size {
        for y in 0..size {
            let (u, v) = ((x as f32 + 0.5) / radius - 1.0, (y as f32 + 0.5) / radius - 1.0);
            let out = (u * u + v * v).sqrt();
            let level = billow.at(x, y);
            if out + (0.5 - level) * 0.75 < 0.86 {
                canvas.set(x, y, gradient(tones, heat * (1.12 - out) * (0.45 + 1.0 * level)));
            }
        }
    }
    canvas
}

/// A wisp of smoke: curls with gaps between them, thinner with every `age`.
fn smoke(size: i32, age: u32) -> Canvas {
    let mut canvas = Canvas::new(size, size);
    let curls = Field::clouds(
        size as usize,
        size as usize,
        (size as usize / 3, size as usize / 3),
        2,
        20 + age,
    );
    let radius = size as f32 / 2.0;
    for x in 0..size {
        for y in 0..size {
            let (u, v) = ((x as f32 + 0.5) / radius - 1.0, (y as f32 + 0.5) / radius - 1.0);
            let level = curls.at(x, y);
            if (u * u + v * v).sqrt() + (0.42 + 0.08 * age as f32 - level) < 0.85 {
                canvas.set(x, y, gradient(&SMOKE, 0.25 + 0.75 * level - 0.3 * v));
            }
        }
    }
    canvas
}

/// The barrel bursting: light breaks out of its seams and lid, then fire that grows and breaks up.
fn barrel_blast(gallery: &mut Gallery) {
    let hot = Material::new(0xD05008, 0xFFB030, 0xFFFFC0).glowing();
    let mut swollen = barrel(true).scaled(1.06);
    for z in [5.0, 9.5, 20.5, 25.0] {
        swollen.tube(Vector(0.0, 0.0, z), Vector(0.0, 0.0, z + 2.0), (12.2, 12.2), hot);
    }
    swollen.limb(Vector(0.0, 0.0, 31.0), Vector(0.0, 0.0, 40.0), (8.0, 3.0), hot);
    ahead_from(gallery, "BEXP", &swollen, View::new(0.0, 16.0));
    for (size, heat, seed) in [(48, 1.1, 10), (60, 1.0, 11), (72, 0.8, 12), (76, 0.55, 13)] {
        let mut canvas = fireball(size, heat, &FIRE, seed);
        // Splinters.
        for i in 0..9 {
            let (cos, sin) = turn(i as f32 * 40.0 + seed as f32 * 13.0);
            let away = size as f32 * (0.28 + 0.2 * unit(i, 1, seed));
            let (x, y) =
                ((size as f32 / 2.0 + cos * away) as i32, (size as f32 / 2.0 + sin * away) as i32);
            canvas.bevel(x, y, 3, 3, Colour::hex(0x5C6062), 0.5);
        }
        gallery.flat_frame("BEXP", &canvas, size / 2, size / 2 + 18);
    }
}
