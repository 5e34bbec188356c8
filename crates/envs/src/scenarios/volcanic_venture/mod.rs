//! Volcanic Venture.

pub mod map;
mod tiles;
