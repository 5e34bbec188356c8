//! Laid and painted floors: pavers, tiles, carpets.

use crate::assets::embedded::colour::Colour;
use crate::assets::embedded::gallery::Gallery;
use crate::assets::embedded::noise::{Cells, Field, hash, unit};
use crate::assets::embedded::surface::Surface;

/// Texels on each side of a flat.
const SIZE: usize = 64;

/// Paints the floors.
pub(super) fn paint(gallery: &mut Gallery) {
    gallery.surface("FLAT5", &pavers(401).with_mean(Colour(108.0, 72.0, 39.0)));
    gallery.surface(
        "SLIME16",
        &square_tiles(32, Colour::hex(0x806850), 411).with_mean(Colour(111.0, 88.0, 67.0)),
    );
    gallery.surface(
        "FLAT22",
        &panels(Colour::hex(0x2C2C90), 421).with_mean(Colour(41.0, 41.0, 133.0)),
    );
    gallery
        .surface("FLAT14", &carpet(Colour::hex(0x080860), 431).with_mean(Colour(2.0, 2.0, 85.0)));
    gallery.surface(
        "FLOOR1_6",
        &carpet(Colour::hex(0x700404), 441).with_mean(Colour(118.0, 2.0, 2.0)),
    );
    gallery.surface(
        "FLAT19",
        &square_tiles(64, Colour::hex(0x707070), 451).with_mean(Colour(104.0, 104.0, 104.0)),
    );
    gallery.surface(
        "FLOOR3_3",
        &square_tiles(16, Colour::hex(0x605038), 461).with_mean(Colour(84.0, 68.0, 46.0)),
    );
}

/// Six-sided pavers.
fn pavers(seed: u32) -> Surface {
    let stones = Cells::honeycomb(SIZE, SIZE, (4, 4), seed);
    let stain = Field::clouds(SIZE, SIZE, (4, 4), 5, seed + 1);
    let fine = Field::clouds(SIZE, SIZE, (20, 20), 2, seed + 2);
    Surface::new(SIZE, SIZE, |x, y| {
        let cell = stones.at(x as f32, y as f32);
        let tone = 0.86 + 0.22 * (cell.id & 255) as f32 / 255.0 + 0.35 * (stain.at(x, y) - 0.5);
        let joint = if cell.border < 0.7 { 0.6 } else { 1.0 };
        (
            Colour::hex(0x7C5430) * (tone * joint),
            (cell.border / 2.0).min(1.0) * 1.3 + fine.at(x, y) * 0.9,
        )
    })
    .lit(0.32, 0.14, seed + 3)
}

/// Square tiles with a raised rim and worn middle.
fn square_tiles(side: i32, colour: Colour, seed: u32) -> Surface {
    let stain = Field::clouds(SIZE, SIZE, (4, 4), 5, seed);
    let pits = Field::clouds(SIZE, SIZE, (16, 16), 2, seed + 1);
    Surface::new(SIZE, SIZE, |x, y| {
        let (u, v) = (x % side, y % side);
        let edge = u.min(side - 1 - u).min(v.min(side - 1 - v)) as f32;
        let id = hash(x / side, y / side, seed);
        let tone = 0.9 + 0.16 * (id & 255) as f32 / 255.0 + 0.4 * (stain.at(x, y) - 0.5);
        let groove = if edge < 1.0 { 0.55 } else { 1.0 };
        let inner = if side >= 32 { (edge - 3.0).clamp(0.0, 1.0) * 0.7 } else { 0.0 };
        (colour * (tone * groove), (edge / 1.5).min(1.0) * 1.3 - inner + pits.at(x, y) * 0.8)
    })
    .lit(0.34, 0.12, seed + 2)
}

/// Smooth panels with a lighter frame and four screws.
fn panels(colour: Colour, seed: u32) -> Surface {
    let sheen = Field::clouds(SIZE, SIZE, (3, 12), 3, seed);
    let mut surface = Surface::new(SIZE, SIZE, |x, y| {
        let (u, v) = (x % 32, y % 32);
        let edge = u.min(31 - u).min(v.min(31 - v));
        let tone = 0.85 + 0.3 * sheen.at(x, y) + if (2..5).contains(&edge) { 0.25 } else { 0.0 };
        (
            colour * if edge == 0 { 0.4 } else { tone },
            (edge as f32 / 2.0).min(1.0) * 1.4 - if edge > 5 { 0.6 } else { 0.0 },
        )
    });
    for (x, y) in [(3, 3), (28, 3), (3, 28), (28, 28)]
        .into_iter()
        .flat_map(|(x, y)| [(x, y), (x + 32, y), (x, y + 32), (x + 32, y + 32)])
    {
        surface.rivet(x, y, 1.0, colour * 1.5);
    }
    surface.lit(0.36, 0.06, seed + 1)
}

/// Carpet: a weave with a lozenge pattern.
fn carpet(colour: Colour, seed: u32) -> Surface {
    let wear = Field::clouds(SIZE, SIZE, (3, 3), 4, seed);
    Surface::new(SIZE, SIZE, |x, y| {
        let lozenge = ((x % 16 - 8).abs() + (y % 16 - 8).abs() - 8).abs() < 2;
        let thread = 0.82 + 0.3 * unit(x, y, seed + 1) + if (x + y) % 2 == 0 { 0.1 } else { 0.0 };
        let tone = thread * (0.8 + 0.4 * wear.at(x, y)) * if lozenge { 1.45 } else { 1.0 };
        (colour * tone, if lozenge { 0.4 } else { 0.0 })
    })
    .lit(0.2, 0.0, seed + 2)
}
