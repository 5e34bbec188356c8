//! Things of the world: items, decorations, creatures, effects and the weapons in the player's hands.

mod bonus;
mod creatures;
mod fiends;
mod floaters;
mod humanoid;
mod soldiers;

use super::gallery::Gallery;

/// Paints every sprite.
pub(super) fn paint(gallery: &mut Gallery) {
    bonus::paint(gallery);
    creatures::paint(gallery);
}
