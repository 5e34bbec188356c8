//! Status bar, digits, faces and letters.

mod bar;
mod digits;
mod face;
mod glyphs;

use super::gallery::Gallery;

/// Paints every status-bar picture.
pub(super) fn paint(gallery: &mut Gallery) {
    bar::paint(gallery);
    digits::paint(gallery);
    face::paint(gallery);
}
