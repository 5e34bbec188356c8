//! Floors, ceilings and the sky: the second pass of a frame.

pub mod plane;
pub mod row;
pub mod sky;
#[cfg(target_arch = "x86_64")]
pub mod spans;
#[cfg(target_arch = "x86_64")]
pub mod whole_avx512;
