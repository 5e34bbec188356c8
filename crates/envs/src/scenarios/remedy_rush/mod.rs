//! Remedy Rush: pick up health, leave everything else where it lies.

pub mod levels;
pub mod map;
mod rules;

pub use rules::{COST_TERMS, Rules};
