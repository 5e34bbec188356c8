//! Walls and floors, by material.

mod ground;
mod liquid;
mod masonry;
mod metal;

use super::gallery::Gallery;

/// Paints every texture and flat.
pub(super) fn paint(gallery: &mut Gallery) {
    liquid::paint(gallery);
    masonry::paint(gallery);
    ground::paint(gallery);
    metal::paint(gallery);
    for name in ["A-BROK28", "AQF052", "FLAT5_5", "STONE5", "RROCK15", "AQRUST07"] {
        gallery.fallback(name);
    }
}
