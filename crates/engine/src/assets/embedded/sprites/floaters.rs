//! Fiends that float: the cacodemon and the lost soul.

use super::fiends::skull;
use crate::assets::embedded::model::{Material, Model};
use crate::assets::embedded::noise::unit;
use crate::assets::embedded::vector::{Frame, Vector, turn};

const HIDE: Material = Material::new(0x3C0404, 0xA81C10, 0xF0604C).mottled(0.45, 3.2);
const HORN: Material = Material::new(0x40382C, 0x9C9078, 0xE8E0C8);
const TOOTH: Material = Material::new(0x8C8060, 0xD8D0B0, 0xFFFFF0).fine();

/// Height of the cacodemon's middle above its anchor.
const MIDDLE: f32 = 29.0;

/// The cacodemon: a red ball with one eye and a great mouth. `gape` opens the mouth (0..1), `wince`
/// closes the eye and dents it.
pub(super) fn cacodemon(gape: f32, wince: f32) -> Model {
    let mut m = Model::new();
    let frame = Frame::turned(-10.0 * wince, 0.0, 0.0);
    let at = |x: f32, y: f32, z: f32| Vector(0.0, 0.0, MIDDLE) + frame.out(Vector(x, y, z));
    m.egg_in(frame, at(0.0, 0.0, 0.0), Vector(26.0, 27.0, 26.0 - 2.0 * wince), HIDE);
    // Brow over the eye, and a crown of horns that leans back.
    m.egg_in(frame, at(17.0, 0.0, 13.5 - 3.0 * wince), Vector(9.0, 14.0, 5.0), HIDE);
    for (side, lift) in [(1.0, 0.0), (-1.0, 0.0)] {
        m.limb(at(2.0, side * 17.0, 18.0), at(2.0, side * 24.0, 25.0 + lift), (4.6, 2.8), HORN);
        m.limb(at(2.0, side * 24.0, 25.0 + lift), at(6.0, side * 24.5, 34.0), (2.8, 0.5), HORN);
        m.limb(at(-14.0, side * 12.0, 16.0), at(-22.0, side * 18.0, 25.0), (3.6, 0.5), HORN);
        m.limb(at(-6.0, side * 25.0, 2.0), at(-10.0, side * 32.0, 5.0), (3.2, 0.5), HORN);
        m.limb(at(-2.0, side * 22.0, -14.0), at(-4.0, side * 28.0, -18.0), (2.8, 0.5), HORN);
    }
    m.limb(at(-8.0, 0.0, 23.0), at(-14.0, 0.0, 33.0), (4.0, 0.5), HORN);
    // The eye.
    let white = Material::new(0x4C6020, 0xA8C840, 0xF4FFB0).polished(0.9);
    m.egg_in(
        frame,
        at(20.5, 0.0, 7.0),
        Vector(7.0, 8.6, (7.6 * (1.0 - 0.72 * wince)).max(1.2)),
        white,
    );
    if wince < 0.6 {
        m.egg_in(
            frame,
            at(26.2, 0.0, 7.2),
            Vector(1.9, 3.8, 4.2),
            Material::new(0x083008, 0x147414, 0x30B838).fine(),
        );
        m.egg_in(
            frame,
            at(27.6, 0.0, 7.2),
            Vector(1.0, 1.4, 2.8),
            Material::new(0x000000, 0x080808, 0x181818).fine(),
        );
    }
    // The mouth: a wide gap with a blue glow in the throat.
    let open = 3.6 + 5.4 * gape;
    let lip = Material::new(0x2C0404, 0x7C1410, 0xB83C30);
    m.egg_in(frame, at(15.4, 0.0, -9.0), Vector(11.6, 18.0, open + 2.2), lip);
    m.egg_in(
        frame,
        at(17.4, 0.0, -9.0),
        Vector(10.6, 16.4, open),
        Material::new(0x04041C, 0x0C1468, 0x2C48D8),
    );
    for i in 0..7 {
        let y = -13.5 + 4.5 * i as f32;
        let x = 27.4 - y * y * 0.05;
        let edge = open * (1.0 - y * y / 300.0);
        let size = if i % 2 == 0 { 4.8 } else { 3.4 };
        m.limb(at(x, y, -9.0 + edge), at(x + 0.6, y, -9.0 + edge - size), (1.6, 0.3), TOOTH);
        m.limb(
            at(x - 0.6, y + 1.6, -9.0 - edge),
            at(x, y + 1.6, -9.0 - edge + size * 0.8),
            (1.5, 0.3),
            TOOTH,
        );
    }
    m
}

/// The cacodemon bursting and sinking: `step` of `count`.
pub(super) fn burst_cacodemon(step: usize, count: usize) -> Model {
    let part = step as f32 / (count - 1) as f32;
    let gore = Material::new(0x10102C, 0x283C9C, 0x6480F0).mottled(0.5, 2.0);
    let squash = 1.0 - 0.78 * part;
    let mut m = Model::new();
    let (wide, high) = (26.0 + 9.0 * part, 26.0 * squash);
    let middle = Vector(0.0, 0.0, high + 3.0 + (MIDDLE - 29.0) * squash + 2.0 * (1.0 - part));
    m.egg(middle, Vector(wide, wide, high), HIDE);
    m.egg(
        middle + Vector(wide * 0.55, 0.0, high * 0.2),
        Vector(wide * 0.5, wide * (0.3 + 0.4 * part), high * (0.4 + 0.4 * part)),
        gore,
    );
    for i in 0..9 {
        let (cos, sin) = turn(i as f32 * 40.0);
        let away = wide * (0.5 + 0.6 * part);
        let up = high * (0.4 + 0.8 * unit(i, 3, 7));
        m.ball(middle + Vector(8.0, cos * away, sin * up), 2.0 + 2.6 * unit(i, 1, 7), gore);
    }
    for side in [1.0, -1.0] {
        let root = middle + Vector(2.0, side * wide * 0.75, high * 0.6);
        m.limb(root, root + Vector(2.0, side * 8.0, 9.0 * squash + 2.0), (3.8, 0.5), HORN);
    }
    m
}

/// The lost soul: a burning skull. `flicker` picks the shape of the flames; `gape` opens the jaw.
pub(super) fn lost_soul(flicker: u32, gape: f32) -> Model {
    let mut m = Model::new();
    let centre = Vector(2.0, 0.0, 28.0);
    flames(&mut m, centre, 12.0, flicker);
    skull(&mut m, Frame::turned(-4.0, 0.0, 0.0), centre, 11.0, gape);
    for side in [1.0, -1.0] {
        let root = centre + Vector(0.0, side * 7.5, 6.5);
        m.limb(root, root + Vector(2.0, side * 7.0, 4.0), (3.0, 2.0), HORN);
        m.limb(
            root + Vector(2.0, side * 7.0, 4.0),
            root + Vector(6.0, side * 7.5, 10.0),
            (2.0, 0.4),
            HORN,
        );
    }
    m
}

/// The lost soul going out: the skull breaks up, the fire swells, then thins.
pub(super) fn dying_soul(step: usize, count: usize) -> Model {
    let part = step as f32 / (count - 1) as f32;
    let mut m = Model::new();
    let centre = Vector(2.0, 0.0, 28.0);
    if step < 2 {
        skull(&mut m, Frame::turned(-12.0, 8.0, 0.0), centre, 11.0, 1.6);
    }
    let swell = 12.0 * (1.0 + 0.8 * part) * if step == count - 1 { 0.6 } else { 1.0 };
    flames(&mut m, centre + Vector(8.0 * part, 0.0, 0.0), swell, 5 + step as u32);
    for i in 0..8 {
        let (cos, sin) = turn(i as f32 * 45.0 + 20.0);
        let away = 6.0 + 20.0 * part;
        m.ball(centre + Vector(10.0, cos * away, sin * away), 2.6 * (1.1 - part), HORN);
    }
    m
}

/// Tongues of fire that stream back and up from a ball.
fn flames(m: &mut Model, centre: Vector, size: f32, flicker: u32) {
    let outer = Material::new(0xB03404, 0xF07010, 0xFFA830).glowing();
    let inner = Material::new(0xFFA018, 0xFFD040, 0xFFFFB0).glowing();
    for i in 0..11 {
        let (cos, sin) = turn(i as f32 * 30.0 - 60.0);
        let long = 0.55 + 0.75 * unit(i, flicker as i32, 31);
        let root = centre + Vector(-0.45 * size, cos * size * 0.62, sin * size * 0.62);
        let tip = root
            + Vector(-0.85 * size * long, cos * size * 0.5, sin * size * 0.4 + size * 0.75 * long);
        m.limb(root, tip, (size * 0.34, 0.6), outer);
        m.limb(
            root + Vector(0.22 * size, 0.0, 0.0),
            root.towards(tip, 0.62) + Vector(0.2 * size, 0.0, 0.0),
            (size * 0.22, 0.4),
            inner,
        );
    }
}
