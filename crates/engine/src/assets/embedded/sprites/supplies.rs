//! Things to pick up that are not weapons: medicine, ammunition, equipment, keys.

use super::creatures::ahead_from;
use crate::assets::embedded::camera::View;
use crate::assets::embedded::gallery::Gallery;
use crate::assets::embedded::model::{Material, Model};
use crate::assets::embedded::vector::{Frame, Vector, turn};

const WHITE: Material = Material::new(0x686460, 0xC4C4C0, 0xFFFFFF);
const CROSS: Material = Material::new(0x5C0404, 0xD01810, 0xFF4030).fine();
const STEEL: Material = Material::new(0x20262C, 0x68747E, 0xC4D0D8).polished(0.8);
const DARK_STEEL: Material = Material::new(0x101214, 0x34383C, 0x747C84).polished(0.6);
const BRASS: Material = Material::new(0x54380A, 0xC08C20, 0xFFE880).polished(0.9);
const LEATHER: Material = Material::new(0x241408, 0x6C4420, 0xA87844).mottled(0.2, 2.0);
const CANVAS: Material = Material::new(0x504828, 0xB4A86C, 0xECE4B0).mottled(0.2, 2.0);

/// Paints the supplies.
pub(super) fn paint(gallery: &mut Gallery) {
    let items = View::new(20.0, 24.0);
    let front = View::new(0.0, 16.0);
    // Bonuses glint: four frames, shown back and forth.
    for glint in 0..4 {
        ahead_from(gallery, "BON1", &vial(glint as f32 / 3.0), front);
    }
    ahead_from(gallery, "STIM", &first_aid(7.0, 4.0, 6.0), items);
    ahead_from(gallery, "MEDI", &first_aid(10.5, 6.0, 8.0), items);
    ahead_from(gallery, "ROCK", &rocket_round(), front);
    ahead_from(gallery, "SHEL", &shells(), items);
    ahead_from(gallery, "CELL", &cell(), items);
    ahead_from(gallery, "CLIP", &clip(), items);
    for lit in [true, false] {
        ahead_from(gallery, "PVIS", &goggles(lit), front);
    }
    for phase in 0..4 {
        ahead_from(gallery, "PINS", &blur_sphere(phase), View::new(0.0, 0.0));
    }
    for glow in [0.0, 0.35, 0.7, 1.0] {
        ahead_from(gallery, "PMAP", &computer_map(glow), View::new(10.0, 20.0));
    }
    ahead_from(gallery, "BPAK", &backpack(), View::new(25.0, 14.0));
    ahead_from(gallery, "SUIT", &radiation_suit(), View::new(0.0, 8.0));
    for lit in [false, true] {
        ahead_from(gallery, "YKEY", &key_card(lit), View::new(0.0, 10.0));
        ahead_from(gallery, "BSKU", &key_skull(lit), View::new(0.0, 6.0));
    }
}

/// A glass vial of tonic, brighter than any grass: it is what one looks for.
fn vial(glint: f32) -> Model {
    let mut m = Model::new();
    let tonic = if glint > 0.6 {
        Material::new(0x24B81C, 0x70F850, 0xE8FFD8)
    } else if glint > 0.3 {
        Material::new(0x1CA018, 0x58F03C, 0xD0FFB8)
    } else {
        Material::new(0x188C14, 0x48E030, 0xB8FF98)
    };
    m.ball(Vector(0.0, 0.0, 6.4), 6.4, tonic.polished(1.0));
    m.tube(
        Vector(0.0, 0.0, 11.0),
        Vector(0.0, 0.0, 15.0),
        (2.7, 2.3),
        Material::new(0x508050, 0xA8DCA8, 0xF0FFF0).polished(0.6),
    );
    m.tube(
        Vector(0.0, 0.0, 14.5),
        Vector(0.0, 0.0, 18.0),
        (2.9, 2.4),
        Material::new(0x4C2C10, 0xA06830, 0xE0A868),
    );
    m.ball(
        Vector(5.2, -2.0, 8.8),
        1.1,
        Material::new(0xC0FFC0, 0xF0FFF0, 0xFFFFFF).glowing().fine(),
    );
    m
}

/// A white case with a red cross on front and lid; half lengths given.
fn first_aid(wide: f32, deep: f32, high: f32) -> Model {
    let mut m = Model::new();
    let half = high * 0.5;
    m.block(Vector(0.0, 0.0, half), Vector(deep, wide, half), WHITE);
    m.block(
        Vector(0.0, 0.0, high * 0.72),
        Vector(deep + 0.15, wide + 0.15, 0.35),
        Material::new(0x404040, 0x787878, 0xA0A0A0),
    );
    let arm = half * 0.62;
    for face in [Vector(deep + 0.2, 0.0, half), Vector(0.0, 0.0, high + 0.2)] {
        let flat = face.0 > 0.0;
        let (tall, broad) = (
            Vector(if flat { 0.3 } else { arm * 0.8 }, arm * 0.34, if flat { arm } else { 0.3 }),
            arm,
        );
        m.block(face, tall, CROSS);
        m.block(
            face,
            Vector(if flat { 0.3 } else { arm * 0.28 }, broad, if flat { arm * 0.34 } else { 0.3 }),
            CROSS,
        );
    }
    if high > 7.0 {
        m.limb(Vector(0.0, -3.0, high + 0.6), Vector(0.0, 3.0, high + 0.6), (0.8, 0.8), DARK_STEEL);
    }
    m
}

/// A rocket standing on its fins.
fn rocket_round() -> Model {
    let mut m = Model::new();
    m.tube(
        Vector(0.0, 0.0, 3.0),
        Vector(0.0, 0.0, 15.0),
        (4.0, 4.0),
        Material::new(0x484C50, 0xA0A8B0, 0xF0F4F8).polished(0.9),
    );
    m.tube(
        Vector(0.0, 0.0, 14.8),
        Vector(0.0, 0.0, 16.4),
        (4.3, 4.3),
        Material::new(0x5C4808, 0xD4B020, 0xFFF078),
    );
    m.limb(
        Vector(0.0, 0.0, 16.6),
        Vector(0.0, 0.0, 25.0),
        (3.7, 0.8),
        Material::new(0x800808, 0xE82418, 0xFF7860).polished(0.7),
    );
    for i in 0..4 {
        let (cos, sin) = turn(45.0 + i as f32 * 90.0);
        m.limb(
            Vector(cos * 3.0, sin * 3.0, 6.0),
            Vector(cos * 5.8, sin * 5.8, 1.2),
            (1.2, 1.5),
            STEEL,
        );
    }
    m.tube(Vector(0.0, 0.0, 0.6), Vector(0.0, 0.0, 3.0), (2.0, 2.6), DARK_STEEL);
    m
}

/// Four shotgun shells: orange cases, brass feet.
fn shells() -> Model {
    let case = Material::new(0x8C3408, 0xFF8018, 0xFFC468);
    let mut m = Model::new();
    for (x, y) in [(0.0, -5.6), (1.6, -1.9), (0.0, 1.8), (1.6, 5.5)] {
        m.tube(Vector(x, y, 3.0), Vector(x, y, 11.0), (1.9, 1.85), case);
        m.tube(Vector(x, y, 0.0), Vector(x, y, 3.2), (2.1, 2.1), BRASS);
    }
    m
}

/// A power cell: a blue block with glowing cyan windows.
fn cell() -> Model {
    let mut m = Model::new();
    m.block(
        Vector(0.0, 0.0, 4.6),
        Vector(4.0, 8.2, 4.4),
        Material::new(0x0A1450, 0x2440C0, 0x6088F8).polished(0.6),
    );
    m.block(Vector(0.0, 0.0, 9.4), Vector(4.2, 8.6, 0.9), DARK_STEEL);
    m.block(Vector(0.0, 0.0, 0.7), Vector(4.3, 8.6, 0.8), DARK_STEEL);
    let glow = Material::new(0x20A0C0, 0x60E8F0, 0xC8FFFF).glowing().fine();
    for y in [-5.0, 0.0, 5.0] {
        m.block(Vector(4.2, y, 5.0), Vector(0.3, 1.3, 2.4), glow);
    }
    m
}

/// A magazine with a round on top.
fn clip() -> Model {
    let mut m = Model::new();
    m.block(Vector(0.0, 0.0, 5.0), Vector(2.6, 3.8, 5.4), STEEL);
    m.limb(Vector(0.0, -3.2, 11.8), Vector(0.0, 3.2, 11.8), (1.6, 1.0), BRASS);
    m
}

/// Light amplification goggles, glowing red or dull.
fn goggles(lit: bool) -> Model {
    let mut m = Model::new();
    let lens = if lit {
        Material::new(0xB01008, 0xFF3818, 0xFFC080).glowing()
    } else {
        Material::new(0x300404, 0x7C1810, 0xC04838).polished(1.0)
    };
    for side in [1.0, -1.0] {
        m.tube(Vector(-3.0, side * 6.4, 6.0), Vector(3.0, side * 6.4, 6.0), (5.6, 5.6), WHITE);
        m.tube(Vector(2.8, side * 6.4, 6.0), Vector(3.6, side * 6.4, 6.0), (4.0, 4.0), lens);
        m.limb(Vector(-2.0, side * 11.0, 7.0), Vector(-8.0, side * 13.0, 8.0), (1.8, 1.4), LEATHER);
    }
    m.block(Vector(0.0, 0.0, 7.0), Vector(2.0, 2.4, 1.6), WHITE);
    m
}

/// The blur sphere: a violet ball in which lights wander.
fn blur_sphere(phase: usize) -> Model {
    let mut m = Model::new();
    let centre = Vector(0.0, 0.0, 15.0);
    m.ball(
        centre,
        14.4,
        Material::new(0x5008A0, 0xB030FF, 0xF0B0FF).mottled(0.4, 4.0).polished(1.0),
    );
    for i in 0..5 {
        let (cos, sin) = turn(phase as f32 * 18.0 + i as f32 * 72.0);
        let spark = Material::new(0x4060F0, 0x88A8FF, 0xF0F8FF).glowing().fine();
        m.ball(centre + Vector(9.5, cos * 8.5, sin * 8.5), 2.1, spark);
    }
    m.ball(
        centre + Vector(12.6, 0.0, 0.0),
        3.4,
        Material::new(0x8C1C1C, 0xE05038, 0xFFC890).glowing(),
    );
    m
}

/// A field computer with a map on its screen.
fn computer_map(glow: f32) -> Model {
    let mut m = Model::new();
    let body = Frame::turned(-28.0, 0.0, 0.0);
    let at = |x: f32, y: f32, z: f32| Vector(0.0, 0.0, 9.0) + body.out(Vector(x, y, z));
    m.block_in(body, at(0.0, 0.0, 1.0), Vector(2.0, 12.4, 9.6), STEEL);
    m.block_in(
        body,
        at(2.0, 0.0, 2.2),
        Vector(0.4, 10.4, 6.8),
        Material::new(0x041C08, 0x0C4018, 0x106420),
    );
    let bright = if glow > 0.5 {
        Material::new(0x40C040, 0x70F060, 0xC8FFB0)
    } else {
        Material::new(0x208028, 0x38B838, 0x78E868)
    };
    let wall = bright.glowing().fine();
    for (y, z, wide, high) in [
        (-4.0, 5.0, 5.0, 0.4),
        (-9.0, 1.0, 0.4, 4.2),
        (1.0, 2.0, 0.4, 3.2),
        (4.0, -1.0, 4.6, 0.4),
        (6.0, 5.0, 0.4, 2.6),
    ] {
        m.block_in(body, at(2.4, y, z), Vector(0.3, wide, high), wall);
    }
    m.ball(
        at(2.6, -2.0, 0.0),
        1.2 + glow * 0.5,
        Material::new(0xE02010, 0xFF4020, 0xFFA080).glowing().fine(),
    );
    m.block_in(body, at(2.0, 0.0, -6.6), Vector(0.5, 8.0, 1.2), DARK_STEEL);
    m
}

/// A canvas rucksack with a rolled blanket.
fn backpack() -> Model {
    let mut m = Model::new();
    m.egg(Vector(0.0, 0.0, 11.0), Vector(7.5, 10.5, 11.4), CANVAS);
    m.block(Vector(1.0, 0.0, 9.0), Vector(6.0, 8.8, 8.6), CANVAS);
    m.egg(
        Vector(4.4, 0.0, 18.0),
        Vector(5.0, 10.2, 4.0),
        Material::new(0x584C2C, 0xC4B878, 0xF4ECC0),
    );
    m.limb(
        Vector(0.0, -11.0, 25.0),
        Vector(0.0, 11.0, 25.0),
        (3.4, 3.4),
        Material::new(0x20280E, 0x5C6830, 0x98A460),
    );
    for y in [-5.0, 5.0] {
        m.block(
            Vector(8.0, y, 12.0),
            Vector(0.8, 0.9, 7.0),
            Material::new(0x1C1008, 0x402810, 0x644020),
        );
        m.block(Vector(9.0, y, 12.0), Vector(0.4, 1.1, 0.9), BRASS.fine());
        m.tube(
            Vector(0.0, y, 25.0),
            Vector(0.0, y + 1.4, 25.0),
            (3.8, 3.8),
            Material::new(0x1C1008, 0x402810, 0x644020),
        );
    }
    m.block(Vector(7.0, 0.0, 6.0), Vector(1.8, 4.6, 4.0), CANVAS);
    m
}

/// A hazard suit hanging on a stand.
fn radiation_suit() -> Model {
    let cloth = Material::new(0x0C2C14, 0x2C7034, 0x74B464).mottled(0.2, 3.0);
    let trim = Material::new(0x5C4808, 0xC8A418, 0xFFEC70);
    let mut m = Model::new();
    for side in [1.0, -1.0] {
        m.limb(Vector(0.0, side * 3.6, 26.0), Vector(0.0, side * 4.6, 5.0), (4.4, 3.4), cloth);
        m.egg(
            Vector(1.6, side * 4.8, 2.4),
            Vector(4.4, 3.2, 2.4),
            Material::new(0x101010, 0x303030, 0x606060),
        );
        m.limb(Vector(0.0, side * 7.4, 41.0), Vector(1.0, side * 9.4, 24.0), (3.2, 2.6), cloth);
        m.ball(Vector(1.0, side * 9.5, 22.4), 2.8, trim);
    }
    m.egg(Vector(0.0, 0.0, 34.0), Vector(5.6, 7.6, 11.0), cloth);
    m.tube(Vector(0.0, 0.0, 27.0), Vector(0.0, 0.0, 29.0), (6.2, 6.2), trim);
    m.egg(Vector(0.0, 0.0, 46.6), Vector(5.4, 5.2, 5.6), cloth);
    m.egg(
        Vector(3.6, 0.0, 46.8),
        Vector(2.6, 3.8, 2.8),
        Material::new(0x1C2020, 0x586868, 0xD0F0F0).polished(1.0),
    );
    m.limb(Vector(5.0, 0.0, 43.0), Vector(6.0, 3.0, 34.0), (1.3, 1.3), DARK_STEEL);
    m.tube(Vector(5.4, 0.0, 36.6), Vector(6.4, 0.0, 36.6), (2.2, 2.2), trim);
    m
}

/// A yellow key card.
fn key_card(lit: bool) -> Model {
    let mut m = Model::new();
    let tilt = Frame::turned(-14.0, 0.0, 8.0);
    let centre = Vector(0.0, 0.0, 8.0);
    let yellow = Material::new(0x604808, 0xD4AC18, 0xFFF060);
    m.block_in(tilt, centre, Vector(0.9, 5.4, 7.4), yellow);
    m.block_in(tilt, centre + tilt.out(Vector(1.0, 0.0, 2.6)), Vector(0.3, 3.8, 2.6), DARK_STEEL);
    let lamp = if lit { Material::new(0xFFB020, 0xFFE860, 0xFFFFC0).glowing() } else { CROSS };
    m.block_in(tilt, centre + tilt.out(Vector(1.1, 0.0, -3.6)), Vector(0.3, 3.2, 1.2), lamp.fine());
    m
}

/// A blue skull key.
fn key_skull(lit: bool) -> Model {
    let mut m = Model::new();
    let blue = Material::new(0x1020A0, 0x4870FF, 0xB8D0FF).polished(0.8);
    m.egg(Vector(0.0, 0.0, 10.4), Vector(5.6, 5.4, 5.6), blue);
    m.egg(Vector(2.2, 0.0, 4.6), Vector(3.2, 3.4, 3.4), blue);
    let eye = if lit {
        Material::new(0xE03010, 0xFF6020, 0xFFD080).glowing().fine()
    } else {
        Material::new(0x000008, 0x040414, 0x080820).fine()
    };
    for side in [1.0, -1.0] {
        m.ball(Vector(4.6, side * 2.2, 9.8), 1.5, eye);
    }
    for y in [-1.6, 0.0, 1.6] {
        m.block(
            Vector(5.2, y, 3.0),
            Vector(0.4, 0.5, 1.4),
            Material::new(0x607088, 0xB0C0E0, 0xFFFFFF).fine(),
        );
    }
    m
}
