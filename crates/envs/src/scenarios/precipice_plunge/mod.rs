//! Precipice Plunge: climb down a cave whose floor sank away, without falling hard.

pub mod levels;
pub mod map;
mod rules;
mod spec;

pub use spec::SPEC;
