//! Armament Burden: carry weapons to the delivery zone without carrying too much.

pub mod levels;
pub mod map;
mod rules;
mod tiles;

pub use rules::{COST_TERMS, Rules, TEXTURES};
