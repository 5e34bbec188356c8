//! A frame size and an eye: the tables of the first, the rays, light and depth of the second.

pub mod camera;
pub mod depth;
pub mod horizon;
pub mod light;
#[cfg(target_arch = "x86_64")]
pub mod light_avx512;
pub mod line;
pub mod size;
pub mod tables;
pub mod view_space;
