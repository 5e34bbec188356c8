//! What players do: thinking, view, inventory, weapons.

pub mod face;
pub mod inventory;
pub mod pickup;
pub mod think;
pub mod view_height;
pub mod weapon;
