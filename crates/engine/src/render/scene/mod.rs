//! A map prepared for drawing with a set of pictures.

pub mod prepared;
