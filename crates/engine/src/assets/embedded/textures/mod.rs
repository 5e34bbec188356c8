//! Walls and floors, by material.

mod cliff;
mod crates;
mod fences;
mod ground;
mod lamps;
mod liquid;
mod masonry;
mod metal;
mod panels;
mod tiles;

use super::gallery::Gallery;

/// Paints every texture and flat.
pub(super) fn paint(gallery: &mut Gallery) {
    liquid::paint(gallery);
    masonry::paint(gallery);
    ground::paint(gallery);
    metal::paint(gallery);
    cliff::paint(gallery);
    tiles::paint(gallery);
    lamps::paint(gallery);
    crates::paint(gallery);
    panels::paint(gallery);
    fences::paint(gallery);
    for name in [
        "A-BROK28", "AQF052", "FLAT5_5", "STONE5", "RROCK15", "AQRUST07", "STARGR2", "SLIME16",
        "BIGSTON3", "BRIKS20",
    ] {
        gallery.fallback(name);
    }
}
