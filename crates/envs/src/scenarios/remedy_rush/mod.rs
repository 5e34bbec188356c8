//! Remedy Rush: pick up health, leave everything else where it lies.

pub mod levels;
pub mod map;
mod rules;
mod spec;

pub use spec::SPEC;
