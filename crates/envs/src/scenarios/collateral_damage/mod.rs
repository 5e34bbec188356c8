//! Collateral Damage: shoot the targets, spare the passers-by.

pub mod levels;
pub mod map;
mod rules;
mod spec;

pub use spec::SPEC;
