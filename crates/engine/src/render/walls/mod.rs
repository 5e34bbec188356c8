//! Walls, front to back through the BSP: the first pass of a frame.

#[cfg(target_arch = "x86_64")]
pub mod batch;
pub mod bsp;
pub mod clip;
pub mod column;
pub mod decals;
pub mod pass;
pub mod seg;
pub mod shade;
pub mod shader;
