//! Collateral Damage: shoot the targets, spare the passers-by.

pub mod levels;
pub mod map;
mod rules;

pub use rules::{COST_TERMS, Rules};
