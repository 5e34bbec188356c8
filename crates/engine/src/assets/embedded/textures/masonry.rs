//! Bricks and dressed stone laid in courses.

use crate::assets::embedded::colour::Colour;
use crate::assets::embedded::gallery::Gallery;
use crate::assets::embedded::noise::{Field, hash};
use crate::assets::embedded::surface::Surface;

const SAND: Colour = Colour::hex(0xB0906E);
const GREEN_STONE: Colour = Colour::hex(0x868C78);

/// Paints the masonry.
pub(super) fn paint(gallery: &mut Gallery) {
    gallery.surface(
        "A-BROK28",
        &worn_blocks(128, Courses { length: 64, height: 32 }, SAND, 31)
            .with_mean(Colour(120.0, 97.0, 77.0)),
    );
    gallery.surface(
        "FLAT5_5",
        &worn_blocks(64, Courses { length: 32, height: 16 }, SAND, 41)
            .with_mean(Colour(87.0, 67.0, 50.0)),
    );
    gallery.surface(
        "FLOOR0_5",
        &slabs(64, Courses { length: 64, height: 32 }, 51).with_mean(Colour(97.0, 97.0, 97.0)),
    );
    gallery.surface(
        "AQF052",
        &slabs(64, Courses { length: 32, height: 16 }, 61).with_mean(Colour(83.0, 83.0, 83.0)),
    );
    gallery.surface(
        "BIGBRIK1",
        &worn_blocks(128, Courses { length: 64, height: 32 }, SAND, 71)
            .with_mean(Colour(49.0, 30.0, 15.0)),
    );
    gallery.surface(
        "BSTONE3",
        &worn_blocks(128, Courses { length: 32, height: 32 }, SAND, 75)
            .with_mean(Colour(92.0, 69.0, 40.0)),
    );
    gallery.surface(
        "BIGSTON3",
        &worn_blocks(128, Courses { length: 128, height: 64 }, GREEN_STONE, 79)
            .with_mean(Colour(62.0, 66.0, 56.0)),
    );
    gallery.surface(
        "STONE7",
        &worn_blocks(128, Courses { length: 32, height: 16 }, SAND, 83)
            .with_mean(Colour(87.0, 60.0, 31.0)),
    );
    gallery.surface("BRIKS20", &bricks(128, 87).with_mean(Colour(96.0, 56.0, 40.0)));
    gallery.surface(
        "TILES6",
        &slabs(64, Courses { length: 32, height: 32 }, 91).with_mean(Colour(104.0, 104.0, 106.0)),
    );
}

/// A running bond: every second course shifted by half a brick.
#[derive(Clone, Copy)]
struct Courses {
    length: i32,
    height: i32,
}

/// A texel's place in the bond.
struct InBrick {
    /// A random number naming the brick.
    id: u32,
    /// Texels to the nearest edge of the brick.
    edge: f32,
}

impl Courses {
    /// Where a (possibly displaced) point lies; `size` is the texture's side, around which the bond
    /// closes.
    fn at(self, x: f32, y: f32, size: i32, seed: u32) -> InBrick {
        let (length, height) = (self.length as f32, self.height as f32);
        let (x, y) = (x + size as f32, y + size as f32);
        let row = (y / height) as i32;
        let x = if row % 2 == 1 { x + length * 0.5 } else { x };
        let column = (x / length) as i32;
        let (u, v) = (x - column as f32 * length, y - row as f32 * height);
        let id = hash(column % (size / self.length), row % (size / self.height), seed);
        InBrick { id, edge: u.min(length - u).min(v.min(height - v)) }
    }
}

/// How strongly one brick differs from the next, from its random number: -1..1.
fn tone(id: u32) -> f32 {
    (id & 255) as f32 / 127.5 - 1.0
}

/// Weathered blocks with wavy joints, chipped edges and pits.
fn worn_blocks(size: usize, courses: Courses, stone: Colour, seed: u32) -> Surface {
    let wave = Field::clouds(size, size, (6, 6), 3, seed);
    let stain = Field::clouds(size, size, (3, 3), 5, seed + 1);
    let pits = Field::clouds(size, size, (size / 6, size / 6), 2, seed + 2);
    Surface::new(size, size, |x, y| {
        let (dx, dy) = ((wave.at(x, y) - 0.5) * 3.0, (wave.at(y + 37, x) - 0.5) * 3.0);
        let brick = courses.at(x as f32 + dx, y as f32 + dy, size as i32, seed);
        let chip = (stain.at(x * 2, y * 2) - 0.5) * 2.5;
        let raise = ((brick.edge + chip) / 3.0).clamp(0.0, 1.0);
        let joint = 1.0 - (brick.edge / 1.6).clamp(0.0, 1.0);
        let face = stone * (0.92 + 0.10 * tone(brick.id) + 0.36 * (stain.at(x, y) - 0.5));
        let pit = (0.32 - pits.at(x, y)).max(0.0) * 3.0;
        (face.mix(stone * 0.5, joint * 0.75), raise * 1.7 + stain.at(x, y) * 1.5 - pit)
    })
    .lit(0.38, 0.16, seed + 3)
}

/// Smooth slabs with narrow joints and hairline scratches.
fn slabs(size: usize, courses: Courses, seed: u32) -> Surface {
    let stain = Field::clouds(size, size, (3, 3), 5, seed);
    let fine = Field::clouds(size, size, (16, 16), 2, seed + 1);
    Surface::new(size, size, |x, y| {
        let slab = courses.at(x as f32 + 0.5, y as f32 + 0.5, size as i32, seed);
        let joint = slab.edge < 1.0;
        let tone = 1.0 + 0.05 * tone(slab.id) + 0.22 * (stain.at(x, y) - 0.5);
        let face = Colour::hex(0x707274) * if joint { tone * 0.62 } else { tone };
        (face, (slab.edge / 2.0).min(1.0) + fine.at(x, y) * 0.4)
    })
    .lit(0.34, 0.07, seed + 2)
}

/// Small fired bricks of uneven colour in pale mortar.
fn bricks(size: usize, seed: u32) -> Surface {
    let courses = Courses { length: 16, height: 8 };
    let stain = Field::clouds(size, size, (4, 4), 4, seed);
    let fine = Field::clouds(size, size, (24, 24), 2, seed + 1);
    Surface::new(size, size, |x, y| {
        let wobble = (stain.at(x, y) - 0.5) * 1.2;
        let brick = courses.at(x as f32 + 0.5, y as f32 + 0.5 + wobble, size as i32, seed);
        let mortar = brick.edge < 0.9;
        let burnt = if brick.id.is_multiple_of(7) { 0.62 } else { 1.0 };
        let face =
            Colour::hex(0xA05038).mix(Colour::hex(0x8C6448), tone(brick.id >> 8) * 0.5 + 0.5);
        let colour = if mortar {
            Colour::hex(0x8C8070) * 0.72
        } else {
            face * (burnt + 0.14 * tone(brick.id))
        };
        (
            colour * (0.8 + 0.4 * stain.at(x, y)),
            (brick.edge / 1.6).min(1.0) * 1.3 + fine.at(x, y) * 0.9,
        )
    })
    .lit(0.34, 0.16, seed + 2)
}
