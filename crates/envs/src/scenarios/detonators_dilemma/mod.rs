//! Detonator's Dilemma: blow up barrels without harming the creatures around them, or yourself.

pub mod levels;
mod rules;

pub use rules::{COST_TERMS, Rules};
