//! What is drawn over the world: the weapon and the status bar.

pub mod status_bar;
pub mod weapon;
pub mod weapon_cache;
