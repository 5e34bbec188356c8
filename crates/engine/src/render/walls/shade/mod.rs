//! Columns of a wall worked out side by side, a file for each family of vectors.

#[cfg(target_arch = "x86_64")]
pub mod avx2;
#[cfg(target_arch = "x86_64")]
pub mod avx512;
