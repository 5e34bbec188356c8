//! Natural rock faces: cliffs, cave walls, ash.

use crate::assets::embedded::colour::{Colour, gradient};
use crate::assets::embedded::gallery::Gallery;
use crate::assets::embedded::noise::{Cells, Field};
use crate::assets::embedded::surface::Surface;

/// Paints the rock faces.
pub(super) fn paint(gallery: &mut Gallery) {
    let brown = [Colour::hex(0x1E140A), Colour::hex(0x4A3620), Colour::hex(0x745838)];
    let moss = [Colour::hex(0x1C1E0E), Colour::hex(0x42482A), Colour::hex(0x687446)];
    let grey = [Colour::hex(0x34332E), Colour::hex(0x706E64), Colour::hex(0xA4A294)];
    gallery.surface("ZIMMER3", &cliff(&brown, 301).with_mean(Colour(54.0, 39.0, 21.0)));
    gallery.surface("ZIMMER2", &overgrown(&moss, 311).with_mean(Colour(53.0, 57.0, 33.0)));
    gallery.surface("ZIMMER8", &cliff(&grey, 321).with_mean(Colour(89.0, 88.0, 80.0)));
    gallery.surface("ZIMMER4", &boulders(&brown, 331).with_mean(Colour(52.0, 38.0, 20.0)));
    gallery.surface("ASHWALL4", &overgrown(&brown, 341).with_mean(Colour(26.0, 19.0, 11.0)));
}

/// A steep face: tall ribs, split by cracks, with ledges across.
fn cliff(tones: &[Colour], seed: u32) -> Surface {
    let size = 128;
    let ribs = Field::clouds(size, size, (7, 2), 5, seed);
    let ledges = Field::clouds(size, size, (2, 7), 4, seed + 1);
    let rough = Field::clouds(size, size, (10, 10), 4, seed + 2);
    Surface::new(size, size, |x, y| {
        let warp = ((rough.at(x, y) - 0.5) * 8.0) as i32;
        let rib = 1.0 - (ribs.at(x + warp, y) * 2.0 - 1.0).abs();
        let ledge = 1.0 - (ledges.at(x, y + warp) * 2.0 - 1.0).abs();
        let raise = rib * rib * 6.0 + ledge * 3.0 + rough.at(x, y) * 2.5;
        (gradient(tones, 0.15 + 0.45 * rib + 0.2 * ledge + 0.3 * (rough.at(x, y) - 0.3)), raise)
    })
    .lit(0.26, 0.16, seed + 3)
}

/// A rock face with hanging growth.
fn overgrown(tones: &[Colour], seed: u32) -> Surface {
    let size = 128;
    let rock = Field::clouds(size, size, (6, 6), 5, seed);
    let strands = Field::clouds(size, size, (20, 4), 3, seed + 1);
    Surface::new(size, size, |x, y| {
        let sway = ((rock.at(x / 2, y) - 0.5) * 6.0) as i32;
        let strand = strands.at(x + sway, y);
        (
            gradient(tones, rock.at(x, y) * 0.6 + strand * 0.5 - 0.05),
            rock.at(x, y) * 4.0 + strand * 3.0,
        )
    })
    .lit(0.26, 0.2, seed + 2)
}

/// Rounded boulders wedged together.
fn boulders(tones: &[Colour], seed: u32) -> Surface {
    let size = 128;
    let stones = Cells::new(size, size, (5, 6), 0.9, seed);
    let rough = Field::clouds(size, size, (8, 8), 5, seed + 1);
    Surface::new(size, size, |x, y| {
        let shift = (rough.at(x, y) - 0.5) * 8.0;
        let cell =
            stones.at((x as f32 + shift).rem_euclid(128.0), (y as f32 + shift).rem_euclid(128.0));
        let dome = (cell.border / 8.0).min(1.0).sqrt();
        let tone = 0.2 + 0.3 * (cell.id & 255) as f32 / 255.0 + 0.5 * rough.at(x, y) * dome;
        (gradient(tones, tone), dome * 6.0 + rough.at(x, y) * 3.0)
    })
    .lit(0.26, 0.16, seed + 2)
}
