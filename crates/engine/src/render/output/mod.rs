//! Frames as bytes for the caller.

pub mod convert;
pub mod segmentation;
