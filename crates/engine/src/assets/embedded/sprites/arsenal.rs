//! The weapons: one model each, shown lying on the ground for pick-up and, from behind, in the
//! player's hands.

use super::creatures::ahead_from;
use crate::assets::embedded::camera::View;
use crate::assets::embedded::gallery::Gallery;
use crate::assets::embedded::model::{Material, Model};
use crate::assets::embedded::vector::{Frame, Vector, turn};

const GUN: Material = Material::new(0x181C20, 0x586068, 0xB4C0C8).polished(0.8);
const STEEL: Material = Material::new(0x20262C, 0x68747E, 0xC8D4DC).polished(0.9);
const WOOD: Material = Material::new(0x3C1C08, 0xB06424, 0xF0A858).mottled(0.25, 2.0);
const GRIP: Material = Material::new(0x100C0A, 0x302824, 0x605650);
const BRASS: Material = Material::new(0x54380A, 0xC08C20, 0xFFE880).polished(0.9);
const HOLE: Material = Material::new(0x000000, 0x080808, 0x101010);

/// Paints the pick-ups, seen from the side and a little from above.
pub(super) fn paint(gallery: &mut Gallery) {
    let side = View::new(-78.0, 16.0);
    // The slender ones lie there larger than life, else nothing is left of them a few steps away.
    for (name, weapon, size) in [
        ("PIST", pistol as fn() -> Model, 1.5),
        ("SHOT", shotgun, 1.5),
        ("SGN2", super_shotgun, 1.35),
        ("MGUN", chaingun, 1.1),
        ("LAUN", launcher, 1.0),
        ("PLAS", plasma_rifle, 1.1),
        ("BFUG", bfg, 1.05),
    ] {
        ahead_from(gallery, name, &weapon().scaled(size), side);
    }
}

/// The pistol: 22 long.
pub(super) fn pistol() -> Model {
    let mut m = Model::new();
    m.block(Vector(1.0, 0.0, 11.0), Vector(10.0, 1.7, 2.0), GUN);
    m.block(Vector(1.0, 0.0, 12.6), Vector(10.0, 1.2, 0.7), STEEL);
    m.block(Vector(-9.6, 0.0, 13.6), Vector(0.7, 1.0, 0.8), GUN);
    m.block(Vector(9.6, 0.0, 13.6), Vector(0.6, 0.4, 0.7), GUN);
    m.tube(Vector(10.6, 0.0, 11.4), Vector(11.4, 0.0, 11.4), (0.9, 0.9), HOLE);
    m.limb(Vector(-6.0, 0.0, 8.6), Vector(-8.0, 0.0, 1.6), (2.2, 2.3), GRIP);
    m.limb(Vector(-2.6, 0.0, 8.0), Vector(-3.4, 0.0, 5.4), (0.6, 0.6), STEEL.fine());
    m.limb(Vector(-3.4, 0.0, 5.4), Vector(0.6, 0.0, 8.0), (0.5, 0.5), STEEL.fine());
    m
}

/// The pump shotgun: 38 long, one barrel, much wood.
pub(super) fn shotgun() -> Model {
    let mut m = Model::new();
    m.tube(Vector(-4.0, 0.0, 9.6), Vector(20.0, 0.0, 9.6), (1.5, 1.4), GUN);
    m.tube(Vector(0.0, 0.0, 7.2), Vector(16.0, 0.0, 7.2), (1.3, 1.3), GUN);
    m.limb(Vector(4.0, 0.0, 7.0), Vector(11.0, 0.0, 7.0), (2.4, 2.2), WOOD);
    m.block(Vector(-4.0, 0.0, 8.4), Vector(4.6, 1.7, 2.4), STEEL);
    m.limb(Vector(-7.0, 0.0, 7.4), Vector(-17.0, 0.0, 4.0), (2.0, 3.2), WOOD);
    m.limb(Vector(-4.0, 0.0, 5.6), Vector(-1.4, 0.0, 5.0), (0.6, 0.6), GUN.fine());
    m
}

/// The double-barrelled shotgun: 43 long, two thick blued barrels, red-brown furniture.
pub(super) fn super_shotgun() -> Model {
    let cherry = Material::new(0x580404, 0xC82414, 0xFF6850).polished(0.5);
    let blued = Material::new(0x10141C, 0x38445C, 0x7888A4).polished(0.9);
    let mut m = Model::new();
    for y in [-1.9, 1.9] {
        m.tube(Vector(-3.0, y, 9.2), Vector(22.0, y, 9.2), (2.0, 2.0), blued);
        m.tube(Vector(21.9, y, 9.2), Vector(22.4, y, 9.2), (1.3, 1.3), HOLE);
    }
    m.tube(Vector(5.0, 0.0, 9.2), Vector(6.6, 0.0, 9.2), (4.2, 4.2), BRASS);
    m.tube(Vector(17.0, 0.0, 9.2), Vector(18.4, 0.0, 9.2), (4.2, 4.2), BRASS);
    m.limb(Vector(1.0, 0.0, 6.6), Vector(12.0, 0.0, 7.2), (2.8, 2.0), cherry);
    m.block(Vector(-5.0, 0.0, 8.6), Vector(3.6, 3.4, 3.2), GUN);
    m.limb(Vector(-8.0, 0.0, 7.4), Vector(-20.0, 0.0, 4.4), (2.6, 4.0), cherry);
    m
}

/// The chaingun in the pieces that move against each other.
pub(super) struct Chaingun {
    /// Housing, grips and ammunition box.
    pub(super) body: Model,
    /// The barrels around their axis, which lies 13 above the body's origin.
    pub(super) barrels: Model,
}

/// The chaingun: 50 long, six barrels, an ammunition box with a brass belt.
pub(super) fn chaingun() -> Model {
    let Chaingun { mut body, barrels } = chaingun_parts();
    body.attach(&barrels, Frame::WORLD, Vector(0.0, 0.0, 13.0));
    body
}

/// The chaingun's body and barrels.
pub(super) fn chaingun_parts() -> Chaingun {
    let mut barrels = Model::new();
    for i in 0..6 {
        let (cos, sin) = turn(i as f32 * 60.0);
        let (y, z) = (cos * 3.0, sin * 3.0);
        barrels.tube(Vector(2.0, y, z), Vector(26.0, y, z), (1.2, 1.2), GUN);
    }
    barrels.tube(Vector(22.0, 0.0, 0.0), Vector(24.6, 0.0, 0.0), (5.0, 5.0), STEEL);
    barrels.tube(Vector(10.0, 0.0, 0.0), Vector(12.0, 0.0, 0.0), (5.0, 5.0), STEEL);
    let mut m = Model::new();
    m.tube(Vector(-14.0, 0.0, 13.0), Vector(3.0, 0.0, 13.0), (6.0, 6.0), GUN);
    m.tube(Vector(-20.0, 0.0, 13.0), Vector(-14.0, 0.0, 13.0), (3.6, 5.4), GUN);
    m.block(
        Vector(-7.0, 0.0, 4.2),
        Vector(6.4, 4.2, 4.4),
        Material::new(0x20240E, 0x565E2C, 0x949E5C),
    );
    for i in 0..4 {
        m.ball(Vector(-12.0 + 3.4 * i as f32, -5.4, 9.6), 1.5, BRASS.fine());
    }
    m.limb(Vector(-18.0, 0.0, 10.0), Vector(-21.0, 0.0, 3.0), (2.0, 2.0), GRIP);
    m.limb(Vector(-12.0, 0.0, 20.0), Vector(2.0, 0.0, 20.0), (1.2, 1.2), GRIP);
    m.limb(Vector(-12.0, 0.0, 17.0), Vector(-12.0, 0.0, 20.0), (1.0, 1.0), GRIP);
    m.limb(Vector(2.0, 0.0, 17.0), Vector(2.0, 0.0, 20.0), (1.0, 1.0), GRIP);
    Chaingun { body: m, barrels }
}

/// The rocket launcher: 59 long, a wide olive tube.
pub(super) fn launcher() -> Model {
    let olive = Material::new(0x142808, 0x4C7824, 0x98CC5C).mottled(0.15, 3.0);
    let mut m = Model::new();
    m.tube(Vector(-24.0, 0.0, 12.0), Vector(18.0, 0.0, 12.0), (4.6, 4.6), olive);
    m.tube(Vector(18.0, 0.0, 12.0), Vector(30.0, 0.0, 12.0), (5.4, 6.2), GUN);
    m.tube(Vector(29.8, 0.0, 12.0), Vector(30.4, 0.0, 12.0), (4.8, 4.8), HOLE);
    m.tube(Vector(-29.0, 0.0, 12.0), Vector(-24.0, 0.0, 12.0), (5.6, 4.8), GUN);
    for x in [-17.0, 13.0] {
        m.tube(Vector(x, 0.0, 12.0), Vector(x + 1.6, 0.0, 12.0), (4.9, 4.9), STEEL);
    }
    m.block(Vector(4.0, 0.0, 18.0), Vector(5.0, 1.4, 1.8), GUN);
    m.tube(
        Vector(-1.0, 0.0, 18.4),
        Vector(-0.2, 0.0, 18.4),
        (1.8, 1.8),
        Material::new(0x301010, 0xA02820, 0xF07050),
    );
    m.limb(Vector(-6.0, 0.0, 8.0), Vector(-7.6, 0.0, 1.6), (1.9, 2.0), GRIP);
    m.limb(Vector(8.0, 0.0, 8.0), Vector(8.0, 0.0, 2.4), (1.7, 1.8), GRIP);
    m
}

/// The plasma rifle: 51 long, blue-black with glowing coils.
pub(super) fn plasma_rifle() -> Model {
    let shell = Material::new(0x0A1250, 0x2038A8, 0x6080F0).polished(0.8);
    let coil = Material::new(0x2080C0, 0x50C8F0, 0xD0FFFF).glowing();
    let mut m = Model::new();
    m.block(Vector(-6.0, 0.0, 9.0), Vector(11.0, 3.6, 4.0), shell);
    m.tube(Vector(4.0, 0.0, 9.6), Vector(20.0, 0.0, 9.6), (3.0, 2.4), GUN);
    for i in 0..4 {
        let x = 5.5 + 3.6 * i as f32;
        m.tube(Vector(x, 0.0, 9.6), Vector(x + 1.5, 0.0, 9.6), (3.7, 3.7), coil);
    }
    m.tube(Vector(20.0, 0.0, 9.6), Vector(25.0, 0.0, 9.6), (3.4, 2.8), STEEL);
    m.tube(Vector(24.9, 0.0, 9.6), Vector(25.4, 0.0, 9.6), (1.9, 1.9), coil);
    m.block(Vector(-6.0, 0.0, 13.6), Vector(8.0, 1.8, 1.2), GUN);
    m.block(Vector(-5.0, -3.8, 9.6), Vector(5.0, 0.3, 1.2), coil);
    m.limb(Vector(-9.0, 0.0, 6.0), Vector(-11.0, 0.0, 1.4), (1.8, 1.8), GRIP);
    m.limb(Vector(-16.0, 0.0, 8.6), Vector(-24.0, 0.0, 5.6), (2.8, 3.4), GUN);
    m
}

/// The BFG: 56 long, a great pale barrel with a green glow.
pub(super) fn bfg() -> Model {
    let pale = Material::new(0x34383A, 0x8C9698, 0xE4ECEC).polished(0.9);
    let glow = Material::new(0x189018, 0x50E848, 0xE0FFD0).glowing();
    let mut m = Model::new();
    m.tube(Vector(-8.0, 0.0, 12.4), Vector(10.0, 0.0, 12.4), (7.4, 7.4), pale);
    m.tube(Vector(10.0, 0.0, 12.4), Vector(16.0, 0.0, 12.4), (7.4, 9.4), pale);
    m.tube(Vector(16.0, 0.0, 12.4), Vector(27.0, 0.0, 12.4), (9.4, 8.2), GUN);
    m.tube(Vector(26.9, 0.0, 12.4), Vector(27.5, 0.0, 12.4), (6.2, 6.2), glow);
    for i in 0..3 {
        let x = -5.0 + 5.0 * i as f32;
        m.tube(Vector(x, 0.0, 12.4), Vector(x + 1.8, 0.0, 12.4), (7.9, 7.9), glow);
    }
    m.tube(Vector(-17.0, 0.0, 12.4), Vector(-8.0, 0.0, 12.4), (5.0, 7.0), GUN);
    m.limb(Vector(-17.0, 0.0, 12.0), Vector(-26.0, 0.0, 9.0), (3.6, 4.4), GUN);
    m.limb(Vector(-11.0, 0.0, 7.0), Vector(-13.0, 0.0, 1.6), (2.2, 2.2), GRIP);
    m.limb(Vector(6.0, 0.0, 5.6), Vector(6.0, 0.0, 1.6), (2.0, 2.0), GRIP);
    m.block(Vector(2.0, 0.0, 21.0), Vector(7.0, 1.8, 1.6), GUN);
    m
}
