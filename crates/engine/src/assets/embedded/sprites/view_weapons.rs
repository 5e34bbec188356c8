//! The weapons in the player's hands: the pick-up models enlarged, seen from behind, with gloved
//! hands and muzzle flashes.

use super::arsenal;
use super::effects::fireball;
use crate::assets::embedded::camera::{View, portrait_above};
use crate::assets::embedded::colour::Colour;
use crate::assets::embedded::gallery::Gallery;
use crate::assets::embedded::model::{Material, Model};
use crate::assets::embedded::vector::{Frame, Vector, turn};

const GLOVE: Material = Material::new(0x14100C, 0x44362A, 0x80685A).mottled(0.2, 4.0);
const SKIN: Material = Material::new(0x442418, 0xA87450, 0xE8B890).mottled(0.12, 4.0);
const SLEEVE: Material = Material::new(0x0C1C0A, 0x2E5428, 0x608C50).mottled(0.25, 6.0);

const FIRE: [Colour; 4] =
    [Colour::hex(0xC04808), Colour::hex(0xFF9018), Colour::hex(0xFFE060), Colour::hex(0xFFFFF0)];
const BLUE: [Colour; 4] =
    [Colour::hex(0x1838D0), Colour::hex(0x4890FF), Colour::hex(0xA0E8FF), Colour::hex(0xFFFFFF)];
const GREEN: [Colour; 4] =
    [Colour::hex(0x188818), Colour::hex(0x48E040), Colour::hex(0xB0FF90), Colour::hex(0xFFFFFF)];

/// Lowest row of the 320 by 200 screen that a view weapon can show: the status bar hides what is
/// below.
const LOWEST_ROW: i32 = 188;

/// How a weapon is held: where its model's origin lies in the 320 by 200 screen, and how far the
/// eye is behind and above it.
#[derive(Clone, Copy)]
struct Hold {
    at: (i32, i32),
    eye: (f32, f32),
}

impl Hold {
    /// Adds a frame; `shift` moves the whole weapon on the screen (recoil, pumping).
    fn frame(self, gallery: &mut Gallery, name: &str, model: &Model, shift: (i32, i32)) {
        let (x, y) = (self.at.0 + shift.0, self.at.1 + shift.1);
        let seen = model.foreshortened(self.eye.0, self.eye.1);
        let portrait = portrait_above(&seen, View::new(180.0, 0.0), (y - LOWEST_ROW) as f32);
        // A view weapon rests at (1, 32) and lies that far minus its offset from the screen's
        // corner.
        gallery.flat_frame(
            name,
            &portrait.canvas,
            1 - x + portrait.offset_x,
            32 - y + portrait.offset_y,
        );
    }

    /// Adds a muzzle flash centred on a point of the model.
    fn flash(
        self,
        gallery: &mut Gallery,
        name: &str,
        muzzle: Vector,
        size: i32,
        tones: &[Colour],
        seed: u32,
    ) {
        let scale = self.eye.0 / (self.eye.0 + muzzle.0);
        let x = self.at.0 - (muzzle.1 * scale) as i32;
        let y = self.at.1 - ((muzzle.2 - self.eye.1) * scale + self.eye.1) as i32;
        let canvas = fireball(size, 0.95, tones, seed);
        gallery.flat_frame(name, &canvas, 1 - x + size / 2, 32 - y + size / 2);
    }
}

/// Paints the view weapons.
pub(super) fn paint(gallery: &mut Gallery) {
    pistol(gallery);
    shotgun(gallery);
    super_shotgun(gallery);
    chaingun(gallery);
    launcher(gallery);
    plasma_rifle(gallery);
    bfg(gallery);
}

/// A hand closed around a point, fingers curling to the left (`side` -1: a right hand) with the
/// forearm running to `elbow`.
fn hand(m: &mut Model, grip: Vector, elbow: Vector, side: f32, size: f32) {
    let at = |x: f32, y: f32, z: f32| grip + Vector(x, -side * y, z) * size;
    m.egg(at(-2.0, -0.6, 0.0), Vector(6.4, 6.0, 6.6) * size, GLOVE);
    for finger in 0..4 {
        let z = 4.2 - 2.9 * finger as f32;
        let x = 3.4 - 0.5 * finger as f32;
        m.limb(at(x, -4.6, z), at(x + 1.0, 2.6, z + 0.6), (1.75 * size, 1.6 * size), GLOVE);
    }
    m.limb(at(-4.4, 2.6, 4.4), at(2.6, 3.6, 5.4), (1.9 * size, 1.5 * size), GLOVE);
    let wrist = at(-4.0, -1.0, -3.4);
    m.limb(wrist, wrist.towards(elbow, 0.28), (4.0 * size, 4.6 * size), SKIN);
    m.limb(wrist.towards(elbow, 0.26), elbow, (5.2 * size, 7.4 * size), SLEEVE);
}

fn pistol(gallery: &mut Gallery) {
    let hold = Hold { at: (164, 188), eye: (200.0, 150.0) };
    // Kick tilts the muzzle up and the slide back.
    let figure = |kick: f32| {
        let mut m = Model::new();
        let tilt = Frame::turned(-14.0 * kick, 0.0, 0.0);
        m.attach(&arsenal::pistol().scaled(4.3), tilt, Vector(10.0 - 8.0 * kick, 0.0, 4.0));
        hand(&mut m, Vector(-22.0, -3.0, 26.0), Vector(-90.0, -34.0, -30.0), -1.0, 2.1);
        hand(&mut m, Vector(-16.0, 9.0, 20.0), Vector(-86.0, 50.0, -30.0), 1.0, 2.0);
        m
    };
    for (kick, drop) in [(0.0, 0), (1.0, 3), (0.5, 1), (0.2, 0), (0.0, 0)] {
        hold.frame(gallery, "PISG", &figure(kick), (0, drop));
    }
    hold.flash(gallery, "PISF", Vector(60.0, 0.0, 56.0), 32, &FIRE, 61);
}

fn shotgun(gallery: &mut Gallery) {
    let hold = Hold { at: (174, 188), eye: (200.0, 150.0) };
    // Pumping draws the fore-end back and lowers the gun.
    let figure = |pump: f32| {
        let mut m = Model::new();
        let tilt = Frame::turned(6.0 * pump, 16.0 * pump, 10.0 * pump);
        m.attach(&arsenal::shotgun().scaled(3.2), tilt, Vector(10.0, 0.0, 12.0));
        let fore = tilt.out(Vector(24.0 - 22.0 * pump, 2.0, 21.0)) + Vector(10.0, 0.0, 12.0);
        hand(&mut m, fore, Vector(-50.0, 52.0, -44.0), 1.0, 1.8);
        hand(&mut m, Vector(-22.0, -5.0, 24.0), Vector(-60.0, -34.0, -40.0), -1.0, 1.8);
        m
    };
    for (pump, drop) in [(0.0, 0), (0.4, 4), (0.8, 8), (1.0, 10)] {
        hold.frame(gallery, "SHTG", &figure(pump), (0, drop));
    }
    for (size, seed) in [(44, 62), (54, 63)] {
        hold.flash(gallery, "SHTF", Vector(76.0, 0.0, 43.0), size, &FIRE, seed);
    }
}

fn super_shotgun(gallery: &mut Gallery) {
    let hold = Hold { at: (166, 190), eye: (200.0, 150.0) };
    // Opening breaks the barrels downwards and swings the gun aside.
    let figure = |open: f32| {
        let mut m = Model::new();
        let tilt = Frame::turned(24.0 * open, 20.0 * open, 22.0 * open);
        m.attach(&arsenal::super_shotgun().scaled(3.2), tilt, Vector(10.0, 0.0, 12.0));
        let fore = tilt.out(Vector(26.0, 3.0, 20.0)) + Vector(10.0, 0.0, 12.0);
        let busy = if open > 0.6 { Vector(-14.0, 14.0, 30.0) } else { fore };
        hand(&mut m, busy, Vector(-50.0, 52.0, -44.0), 1.0, 1.8);
        hand(&mut m, Vector(-22.0, -6.0, 24.0), Vector(-60.0, -34.0, -40.0), -1.0, 1.8);
        m
    };
    for (open, drop) in
        [(0.0, 0), (0.3, 6), (0.7, 10), (1.0, 12), (1.0, 14), (0.8, 12), (0.4, 8), (0.15, 3)]
    {
        hold.frame(gallery, "SHT2", &figure(open), (0, drop));
    }
    for (size, seed) in [(58, 64), (70, 65)] {
        hold.flash(gallery, "SHT2", Vector(84.0, 0.0, 42.0), size, &FIRE, seed);
    }
}

fn chaingun(gallery: &mut Gallery) {
    let hold = Hold { at: (160, 200), eye: (200.0, 150.0) };
    for (turned, drop) in [(0.0, 0), (30.0, 2)] {
        let mut m = Model::new();
        // The barrels turn about their own axis, 13 above the model's origin.
        let (cos, sin) = turn(turned);
        let spin = Frame {
            forward: Vector::FORWARD,
            left: Vector(0.0, cos, sin),
            up: Vector(0.0, -sin, cos),
        };
        let scale = 3.4;
        let gun = arsenal::chaingun_parts();
        let origin = Vector(0.0, 0.0, 4.0);
        m.attach(&gun.body.scaled(scale), Frame::WORLD, origin);
        m.attach(&gun.barrels.scaled(scale), spin, origin + Vector(0.0, 0.0, 13.0 * scale));
        hand(&mut m, Vector(-34.0, -26.0, 30.0), Vector(-60.0, -60.0, -40.0), -1.0, 1.9);
        hand(&mut m, Vector(-14.0, 26.0, 30.0), Vector(-56.0, 62.0, -40.0), 1.0, 1.9);
        hold.frame(gallery, "CHGG", &m, (0, drop));
    }
    for (size, seed, aside) in [(46, 66, -6.0), (50, 67, 6.0)] {
        hold.flash(gallery, "CHGF", Vector(92.0, aside, 50.0), size, &FIRE, seed);
    }
}

fn launcher(gallery: &mut Gallery) {
    let hold = Hold { at: (160, 206), eye: (200.0, 150.0) };
    let mut m = Model::new();
    m.attach(&arsenal::launcher().scaled(3.6), Frame::WORLD, Vector(-20.0, 0.0, 6.0));
    hand(&mut m, Vector(-2.0, -24.0, 40.0), Vector(-60.0, -58.0, -36.0), -1.0, 2.0);
    hand(&mut m, Vector(12.0, 24.0, 40.0), Vector(-56.0, 60.0, -36.0), 1.0, 2.0);
    hold.frame(gallery, "MISG", &m, (0, 0));
    hold.frame(gallery, "MISG", &m, (0, 7));
    for (size, seed) in [(26, 68), (38, 69), (46, 70), (36, 71)] {
        hold.flash(gallery, "MISF", Vector(92.0, 0.0, 50.0), size, &FIRE, seed);
    }
}

fn plasma_rifle(gallery: &mut Gallery) {
    let hold = Hold { at: (160, 198), eye: (200.0, 150.0) };
    for lowered in [0.0, 1.0] {
        let mut m = Model::new();
        let tilt = Frame::turned(10.0 * lowered, 12.0 * lowered, -10.0 * lowered);
        m.attach(&arsenal::plasma_rifle().scaled(3.8), tilt, Vector(8.0, 0.0, 6.0));
        hand(&mut m, Vector(-30.0, -8.0, 26.0), Vector(-66.0, -40.0, -40.0), -1.0, 1.8);
        hand(&mut m, Vector(20.0, 12.0, 28.0), Vector(-50.0, 54.0, -40.0), 1.0, 1.8);
        hold.frame(gallery, "PLSG", &m, (0, (6.0 * lowered) as i32));
    }
    for (size, seed) in [(36, 72), (42, 73)] {
        hold.flash(gallery, "PLSF", Vector(104.0, 0.0, 42.0), size, &BLUE, seed);
    }
}

fn bfg(gallery: &mut Gallery) {
    let hold = Hold { at: (160, 208), eye: (200.0, 150.0) };
    let mut m = Model::new();
    m.attach(&arsenal::bfg().scaled(3.3), Frame::WORLD, Vector(0.0, 0.0, 6.0));
    hand(&mut m, Vector(-34.0, -20.0, 34.0), Vector(-66.0, -58.0, -36.0), -1.0, 2.0);
    hand(&mut m, Vector(10.0, 28.0, 34.0), Vector(-50.0, 64.0, -36.0), 1.0, 2.0);
    for drop in [0, 3, 8] {
        hold.frame(gallery, "BFGG", &m, (0, drop));
    }
    for (size, seed) in [(54, 74), (86, 75)] {
        hold.flash(gallery, "BFGF", Vector(94.0, 0.0, 48.0), size, &GREEN, seed);
    }
}
