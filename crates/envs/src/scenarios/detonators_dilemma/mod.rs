//! Detonator's Dilemma: blow up barrels without harming the creatures around them, or yourself.

pub mod levels;
pub mod map;
mod rules;
mod terrain;

pub use rules::{COST_TERMS, Rules};
