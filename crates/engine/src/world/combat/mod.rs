//! Shots, missiles, blasts, and the damage that they do.

pub mod damage;
pub mod explosion;
pub mod hitscan;
pub mod missile;
