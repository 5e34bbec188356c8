//! Armament Burden.

pub mod map;
mod tiles;
