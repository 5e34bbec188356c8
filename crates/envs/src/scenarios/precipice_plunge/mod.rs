//! Precipice Plunge.

pub mod map;
