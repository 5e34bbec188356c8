//! What is seen and touches nothing: soot on walls, trails of rockets.

pub mod soot;
pub mod trail;
