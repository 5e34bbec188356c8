//! Detonator's Dilemma: blow up barrels without harming the creatures around them, or yourself.

pub mod levels;
pub mod map;
mod rules;
mod spec;
mod terrain;

pub use spec::SPEC;
