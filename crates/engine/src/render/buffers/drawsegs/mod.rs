//! Drawsegs: what the walls leave for the sprites.

pub mod list;
mod overlap;
