//! A frame size and an eye: the tables of the first, the rays, light and depth of the second.

crate::simd::kernel_files!(light_avx512);
pub mod camera;
pub mod depth;
pub mod horizon;
pub mod light;
pub mod line;
pub mod size;
pub mod tables;
pub mod view_space;
