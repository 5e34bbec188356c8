//! Detonator's Dilemma.

pub mod map;
mod terrain;
