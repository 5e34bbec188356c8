//! Volcanic Venture: items lie on platforms and on lava; lava costs health.

pub mod levels;
pub mod map;
mod rules;
mod spec;
mod tiles;

pub use spec::SPEC;
