//! Walls, front to back through the BSP: the first pass of a frame.

pub mod batch;
pub mod bsp;
pub mod clip;
pub mod column;
pub mod decals;
pub mod pass;
pub mod seg;
pub mod shade;
pub mod shader;
