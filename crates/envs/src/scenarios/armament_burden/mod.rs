//! Armament Burden: carry weapons to the delivery zone without carrying too much.

pub mod levels;
pub mod map;
mod rules;
mod spec;
mod tiles;

pub use spec::SPEC;
