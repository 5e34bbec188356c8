//! Floors, ceilings and the sky: the second pass of a frame.

pub mod draw;
pub mod row;
pub mod shader;
pub mod sky;
pub mod spans;
pub mod whole;
