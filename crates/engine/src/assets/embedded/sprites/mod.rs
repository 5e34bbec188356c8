//! Things of the world: items, decorations, creatures, effects and the weapons in the player's
//! hands.

mod arsenal;
mod creatures;
mod decorations;
mod effects;
mod fiends;
mod floaters;
mod helmet;
mod humanoid;
mod soldiers;
mod supplies;
mod view_weapons;

use super::gallery::Gallery;

/// Paints every sprite.
pub(super) fn paint(gallery: &mut Gallery) {
    helmet::paint(gallery);
    supplies::paint(gallery);
    arsenal::paint(gallery);
    decorations::paint(gallery);
    effects::paint(gallery);
    creatures::paint(gallery);
    view_weapons::paint(gallery);
}
