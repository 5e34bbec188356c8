//! Solid scenery: lamps, columns, pillars, trees, the barrel.

use super::creatures::ahead_from;
use crate::assets::embedded::camera::View;
use crate::assets::embedded::gallery::Gallery;
use crate::assets::embedded::model::{Material, Model};
use crate::assets::embedded::noise::unit;
use crate::assets::embedded::vector::{Vector, turn};

const STEEL: Material = Material::new(0x1C2226, 0x5C666E, 0xB4C0C8).polished(0.7);
const DARK: Material = Material::new(0x101214, 0x30343A, 0x6C747C).polished(0.4);
const BARK: Material = Material::new(0x1C1008, 0x5A3E24, 0x9C7448).mottled(0.6, 2.2);
const DEAD_BARK: Material = Material::new(0x181410, 0x54483A, 0x94826A).mottled(0.6, 2.0);

/// Paints the scenery.
pub(super) fn paint(gallery: &mut Gallery) {
    let level = View::new(0.0, 8.0);
    for lit in 0..4 {
        ahead_from(gallery, "TLMP", &tech_lamp(78.0, 13.0, lit), level);
        ahead_from(gallery, "TLP2", &tech_lamp(58.0, 10.0, lit), level);
    }
    let green = Material::new(0x0E2410, 0x3C6434, 0x84AC70).mottled(0.35, 2.6);
    let red = Material::new(0x2C0A08, 0x7C2C20, 0xBC6450).mottled(0.35, 2.6);
    ahead_from(gallery, "COL1", &column(50.0, green), level);
    ahead_from(gallery, "COL2", &column(38.0, green), level);
    ahead_from(gallery, "COL4", &column(38.0, red), level);
    for beat in [1.0, 1.18] {
        ahead_from(gallery, "COL5", &heart_column(beat, green), level);
    }
    ahead_from(gallery, "ELEC", &tech_pillar(), level);
    ahead_from(gallery, "TRE1", &dead_tree(), level);
    ahead_from(gallery, "TRE2", &great_tree(), level);
    ahead_from(gallery, "SMIT", &stump(), level);
    ahead_from(gallery, "POL5", &pool_of_gore(), View::new(0.0, 14.0));
    ahead_from(gallery, "BRS1", &scattered_bones(), View::new(0.0, 20.0));
    ahead_from(gallery, "POB1", &pool_of_gore(), View::new(0.0, 14.0));
    ahead_from(gallery, "CAND", &candlestick(), level);
    for flicker in [0.0, 1.5, -1.0, 0.7] {
        ahead_from(gallery, "SMBT", &torch(flicker, 0x3070F0), level);
        ahead_from(gallery, "SMGT", &torch(flicker, 0x30D040), level);
        ahead_from(gallery, "SMRT", &torch(flicker, 0xF04028), level);
    }
    for flicker in [0.0, 2.0, -1.5] {
        ahead_from(gallery, "FTOP", &fire(flicker, 14.0), level);
        ahead_from(gallery, "FDEB", &fire(flicker, 9.0), level);
    }
    for glow in 0..2 {
        ahead_from(gallery, "BAR1", &barrel(glow == 1), View::new(0.0, 16.0));
    }
}

/// A lamp on a post: foot, pole, caged glass tube. `lit` moves a brighter band along the tube.
fn tech_lamp(height: f32, radius: f32, lit: usize) -> Model {
    let glass = Material::new(0x6090D0, 0xA8D4FF, 0xF0FCFF).glowing();
    let bright = Material::new(0xC0E8FF, 0xF0FCFF, 0xFFFFFF).glowing();
    let mut m = Model::new();
    m.tube(Vector(0.0, 0.0, 0.0), Vector(0.0, 0.0, 3.0), (radius * 0.8, radius * 0.7), DARK);
    m.tube(Vector(0.0, 0.0, 3.0), Vector(0.0, 0.0, 6.0), (radius * 0.5, radius * 0.35), STEEL);
    let neck = height * 0.42;
    m.tube(Vector(0.0, 0.0, 6.0), Vector(0.0, 0.0, neck), (2.4, 2.0), STEEL);
    m.tube(
        Vector(0.0, 0.0, neck),
        Vector(0.0, 0.0, neck + 4.0),
        (radius * 0.3, radius * 0.55),
        DARK,
    );
    let top = height - 6.0;
    m.tube(
        Vector(0.0, 0.0, neck + 4.0),
        Vector(0.0, 0.0, top),
        (radius * 0.36, radius * 0.36),
        glass,
    );
    let band = neck + 5.0 + (top - neck - 9.0) * lit as f32 / 3.0;
    m.tube(
        Vector(0.0, 0.0, band),
        Vector(0.0, 0.0, band + 3.0),
        (radius * 0.42, radius * 0.42),
        bright,
    );
    for i in 0..4 {
        let (cos, sin) = turn(22.0 + i as f32 * 90.0);
        let (x, y) = (cos * radius * 0.5, sin * radius * 0.5);
        m.tube(Vector(x, y, neck + 4.0), Vector(x, y, top), (0.7, 0.7), STEEL);
    }
    m.tube(Vector(0.0, 0.0, top), Vector(0.0, 0.0, top + 3.0), (radius * 0.6, radius * 0.5), DARK);
    m.limb(
        Vector(0.0, 0.0, top + 3.0),
        Vector(0.0, 0.0, height - 1.0),
        (radius * 0.25, 0.5),
        STEEL,
    );
    m
}

/// A candle on a foot.
fn candlestick() -> Model {
    let mut m = Model::new();
    let wax = Material::new(0xA09878, 0xE0D8B8, 0xFFFFF0);
    m.tube(Vector(0.0, 0.0, 0.0), Vector(0.0, 0.0, 2.0), (3.5, 2.0), STEEL);
    m.tube(Vector(0.0, 0.0, 2.0), Vector(0.0, 0.0, 9.0), (1.3, 1.2), wax);
    m.egg(Vector(0.0, 0.0, 12.0), Vector(1.2, 1.2, 2.4), flame(0xF0C040));
    m
}

/// A burning bowl on a short post; `flicker` bends its flame.
fn torch(flicker: f32, colour: u32) -> Model {
    let mut m = Model::new();
    m.tube(Vector(0.0, 0.0, 0.0), Vector(0.0, 0.0, 3.0), (7.0, 5.0), DARK);
    m.tube(Vector(0.0, 0.0, 3.0), Vector(0.0, 0.0, 18.0), (2.2, 2.0), STEEL);
    m.tube(Vector(0.0, 0.0, 18.0), Vector(0.0, 0.0, 22.0), (3.0, 6.0), DARK);
    m.limb(Vector(0.0, 0.0, 22.0), Vector(0.0, flicker, 36.0), (5.0, 1.0), flame(colour));
    m
}

/// Flames on the ground, so wide to each side.
fn fire(flicker: f32, reach: f32) -> Model {
    let mut m = Model::new();
    for (i, side) in [-1.0f32, -0.4, 0.3, 0.9].into_iter().enumerate() {
        let (y, height) = (side * reach * 0.7, reach * (1.2 + 0.4 * (i % 2) as f32) + flicker);
        m.limb(
            Vector(0.0, y, 0.0),
            Vector(0.0, y + flicker, height),
            (reach * 0.3, 0.8),
            flame(0xF08020),
        );
    }
    m
}

fn flame(colour: u32) -> Material {
    Material::new(colour, colour | 0x404040, 0xFFFFC0).glowing()
}

/// A short stone column.
fn column(height: f32, stone: Material) -> Model {
    let mut m = Model::new();
    m.tube(Vector(0.0, 0.0, 0.0), Vector(0.0, 0.0, 4.0), (15.0, 14.0), stone);
    m.tube(Vector(0.0, 0.0, 4.0), Vector(0.0, 0.0, 7.0), (11.5, 10.5), stone);
    m.tube(Vector(0.0, 0.0, 7.0), Vector(0.0, 0.0, height - 7.0), (10.0, 9.4), stone);
    for i in 0..7 {
        let (cos, sin) = turn(i as f32 * 30.0 - 90.0);
        let (x, y) = (cos * 9.4, sin * 9.4);
        m.tube(Vector(x, y, 7.0), Vector(x, y, height - 7.0), (1.5, 1.4), stone);
    }
    m.tube(Vector(0.0, 0.0, height - 7.0), Vector(0.0, 0.0, height - 4.0), (10.0, 12.5), stone);
    m.tube(Vector(0.0, 0.0, height - 4.0), Vector(0.0, 0.0, height), (14.4, 14.8), stone);
    m
}

/// A column with a beating heart on it.
fn heart_column(beat: f32, stone: Material) -> Model {
    let mut m = column(31.0, stone);
    let heart = Material::new(0x400404, 0xB01C14, 0xF86050).mottled(0.3, 1.6).polished(0.8);
    let centre = Vector(0.0, 0.0, 36.0);
    m.egg(centre, Vector(5.0, 5.6, 5.6) * beat, heart);
    m.egg(centre + Vector(0.0, -2.6, 2.4), Vector(3.8, 3.6, 3.8) * beat, heart);
    m.limb(centre + Vector(0.0, 1.5, 4.0), centre + Vector(0.0, 4.6, 9.0), (1.7, 1.3), heart);
    m.limb(centre + Vector(0.0, -1.5, 4.0), centre + Vector(0.0, -3.0, 9.4), (1.5, 1.1), heart);
    m
}

/// A tall technical pillar with coloured lamps.
fn tech_pillar() -> Model {
    let mut m = Model::new();
    m.tube(Vector(0.0, 0.0, 0.0), Vector(0.0, 0.0, 8.0), (16.0, 14.0), DARK);
    m.tube(Vector(0.0, 0.0, 120.0), Vector(0.0, 0.0, 128.0), (14.0, 16.0), DARK);
    m.tube(Vector(0.0, 0.0, 8.0), Vector(0.0, 0.0, 120.0), (10.5, 10.5), STEEL);
    for z in [22.0, 50.0, 78.0, 106.0] {
        m.tube(Vector(0.0, 0.0, z), Vector(0.0, 0.0, z + 5.0), (13.0, 13.0), DARK);
        let lamp = Material::new(0x1020A0, 0x3060F0, 0xA0C8FF).glowing();
        m.tube(Vector(0.0, 0.0, z + 7.0), Vector(0.0, 0.0, z + 9.0), (11.2, 11.2), lamp);
    }
    for side in [1.0, -1.0] {
        m.limb(
            Vector(6.0, side * 10.0, 8.0),
            Vector(6.0, side * 10.0, 120.0),
            (1.8, 1.8),
            Material::new(0x3C1408, 0x8C3818, 0xC87040),
        );
    }
    for i in 0..6 {
        let colour = [0x30E030, 0xF0C020, 0xE03020][i % 3];
        m.block(
            Vector(10.6, -4.0 + 4.0 * (i % 3) as f32, 34.0 + 28.0 * (i / 3) as f32),
            Vector(0.4, 1.2, 1.2),
            Material::new(colour, colour, colour).glowing().fine(),
        );
    }
    m
}

/// Adds a branch that forks again and again.
fn branch(
    m: &mut Model,
    from: Vector,
    reach: Vector,
    radius: f32,
    forks: u32,
    seed: i32,
    bark: Material,
) -> Vector {
    let bend =
        Vector(0.3, unit(seed, 1, 5) - 0.5, unit(seed, 2, 5) - 0.3) * (reach.length() * 0.35);
    let middle = from + reach * 0.5 + bend;
    let tip = from + reach;
    m.limb(from, middle, (radius, radius * 0.8), bark);
    m.limb(middle, tip, (radius * 0.8, radius * 0.5), bark);
    if forks > 0 {
        for (i, side) in [1.0, -1.0].into_iter().enumerate() {
            let spread = 0.5 + 0.5 * unit(seed, 3 + i as i32, 5);
            let away = Vector(
                (unit(seed, 7, 5) - 0.5) * reach.length(),
                side * spread * reach.length() * 0.6,
                reach.2 * 0.5 + 2.0,
            );
            let root = if i == 0 { middle } else { tip };
            branch(m, root, away * 0.85, radius * 0.55, forks - 1, seed * 2 + i as i32 + 1, bark);
        }
    }
    tip
}

/// A bare, twisted tree; 56 tall.
fn dead_tree() -> Model {
    let mut m = Model::new();
    for i in 0..5 {
        let (cos, sin) = turn(i as f32 * 72.0 + 10.0);
        m.limb(Vector(0.0, 0.0, 6.0), Vector(cos * 9.0, sin * 9.0, 0.4), (3.4, 1.0), DEAD_BARK);
    }
    m.limb(Vector(0.0, 0.0, 1.0), Vector(0.0, 1.6, 16.0), (5.4, 4.2), DEAD_BARK);
    m.limb(Vector(0.0, 1.6, 16.0), Vector(0.0, -1.0, 30.0), (4.2, 3.0), DEAD_BARK);
    branch(&mut m, Vector(0.0, 1.4, 18.0), Vector(3.0, 11.0, 12.0), 2.3, 2, 3, DEAD_BARK);
    branch(&mut m, Vector(0.0, -0.6, 25.0), Vector(2.0, -12.0, 10.0), 2.1, 2, 8, DEAD_BARK);
    branch(&mut m, Vector(0.0, -1.0, 30.0), Vector(0.0, 3.0, 14.0), 2.4, 2, 5, DEAD_BARK);
    m.egg(
        Vector(4.0, 0.6, 19.0),
        Vector(1.8, 1.6, 2.4),
        Material::new(0x080604, 0x100C08, 0x1C140C),
    );
    m
}

/// A broad old tree with a crown of leaves; 108 tall.
fn great_tree() -> Model {
    let leaves = Material::new(0x0A1A08, 0x2C4C1C, 0x6C9444).mottled(0.8, 2.6);
    let mut m = Model::new();
    for i in 0..6 {
        let (cos, sin) = turn(i as f32 * 60.0);
        m.limb(Vector(0.0, 0.0, 12.0), Vector(cos * 20.0, sin * 20.0, 0.6), (6.0, 1.6), BARK);
    }
    m.limb(Vector(0.0, 0.0, 2.0), Vector(0.0, 2.0, 34.0), (11.0, 8.0), BARK);
    m.limb(Vector(0.0, 2.0, 34.0), Vector(0.0, -2.0, 66.0), (8.0, 5.6), BARK);
    for (root, reach) in [
        (Vector(0.0, 1.0, 42.0), Vector(4.0, 28.0, 26.0)),
        (Vector(0.0, 0.0, 48.0), Vector(6.0, -30.0, 22.0)),
        (Vector(0.0, -1.0, 60.0), Vector(0.0, 14.0, 30.0)),
        (Vector(0.0, -2.0, 62.0), Vector(-4.0, -14.0, 30.0)),
    ] {
        m.limb(root, root + reach, (4.4, 2.0), BARK);
        for i in 0..4 {
            let at = root + reach * (0.55 + 0.18 * i as f32);
            let shift = |k: i32| (unit(i, k + reach.1 as i32, 17) - 0.5) * 18.0;
            let size = 8.0 + 4.0 * unit(i, reach.1 as i32, 18);
            m.egg(
                at + Vector(shift(1), shift(2), shift(3) * 0.6 + 3.0),
                Vector(size, size * 1.2, size * 0.8),
                leaves,
            );
        }
    }
    m.egg(Vector(0.0, 0.0, 92.0), Vector(16.0, 20.0, 13.0), leaves);
    m
}

/// A splintered stump; 40 tall.
fn stump() -> Model {
    let mut m = Model::new();
    for i in 0..5 {
        let (cos, sin) = turn(i as f32 * 72.0 + 36.0);
        m.limb(Vector(0.0, 0.0, 7.0), Vector(cos * 11.0, sin * 11.0, 0.6), (4.0, 1.2), BARK);
    }
    m.limb(Vector(0.0, 0.0, 2.0), Vector(0.0, 0.6, 24.0), (7.4, 6.0), BARK);
    for (y, z) in [(-4.0, 39.0), (-1.0, 33.0), (2.4, 36.0), (5.0, 30.0)] {
        m.limb(Vector(1.0, y * 0.9, 22.0), Vector(0.0, y, z), (2.6, 0.5), BARK);
    }
    m.limb(Vector(0.0, 5.0, 16.0), Vector(2.0, 13.0, 24.0), (2.0, 0.8), BARK);
    m
}

/// A pool of blood with bits in it.
fn pool_of_gore() -> Model {
    let blood = Material::new(0x300404, 0x7C0C08, 0xC02018).mottled(0.3, 1.6).polished(0.8);
    let mut m = Model::new();
    m.egg(Vector(0.0, 0.0, 0.6), Vector(14.0, 20.0, 1.0), blood);
    for (x, y, size) in [(4.0, -8.0, 3.0), (-2.0, 5.0, 3.6), (6.0, 9.0, 2.4), (0.0, -2.0, 2.8)] {
        m.egg(
            Vector(x, y, 1.4),
            Vector(size, size * 1.3, size * 0.7),
            Material::new(0x4C1410, 0xA04840, 0xE08C80),
        );
    }
    m
}

/// A heap of bones.
fn scattered_bones() -> Model {
    let bone = Material::new(0x4A4030, 0xA89C80, 0xF0E8D0);
    let mut m = Model::new();
    for i in 0..6 {
        let (cos, sin) = turn(unit(i, 0, 91) * 180.0);
        let centre = Vector((unit(i, 1, 91) - 0.5) * 14.0, (unit(i, 2, 91) - 0.5) * 22.0, 1.4);
        m.limb(
            centre - Vector(cos, sin, 0.0) * 5.0,
            centre + Vector(cos, sin, 0.1) * 5.0,
            (1.2, 1.2),
            bone,
        );
    }
    m.egg(Vector(5.0, 1.0, 4.0), Vector(4.0, 3.8, 3.8), bone);
    m
}

/// An explosive barrel, its lid showing what it holds.
pub(super) fn barrel(glow: bool) -> Model {
    let body = Material::new(0x202426, 0x70787C, 0xC8D0D0).polished(0.5).mottled(0.14, 2.6);
    // A painted band distinguishes a barrel from all else that is grey, as far as it can be seen.
    let paint = Material::new(0x6C5008, 0xE0B818, 0xFFF070).mottled(0.2, 2.2);
    let slime = if glow {
        Material::new(0x30A020, 0x68E848, 0xC8FF90).glowing()
    } else {
        Material::new(0x247C18, 0x50C838, 0xA0F070).glowing()
    };
    let mut m = Model::new();
    m.tube(Vector(0.0, 0.0, 0.5), Vector(0.0, 0.0, 30.0), (10.4, 10.4), body);
    m.tube(Vector(0.0, 0.0, 8.5), Vector(0.0, 0.0, 22.5), (10.7, 10.7), paint);
    for z in [0.5, 7.6, 22.0, 28.4] {
        m.tube(Vector(0.0, 0.0, z), Vector(0.0, 0.0, z + 1.8), (11.2, 11.2), STEEL);
    }
    m.tube(Vector(0.0, 0.0, 29.8), Vector(0.0, 0.0, 30.3), (9.2, 9.2), slime);
    // Hazard sign: three leaves around a dot.
    let sign = Material::new(0x080808, 0x141210, 0x242018);
    m.egg(Vector(10.6, 0.0, 15.6), Vector(0.8, 0.9, 0.9), sign);
    for i in 0..3 {
        let (cos, sin) = turn(90.0 + i as f32 * 120.0);
        m.egg(Vector(10.4, cos * 2.6, 15.6 + sin * 2.6), Vector(0.8, 1.5, 1.5), sign);
    }
    m.limb(Vector(10.6, 4.0, 26.0), Vector(10.6, 4.6, 22.0), (1.3, 0.7), slime);
    m
}
