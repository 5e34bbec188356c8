//! Remedy Rush.

pub mod map;
