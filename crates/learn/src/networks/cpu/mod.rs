//! The network on the processor: fused kernels that reach most of what its multiply-add units can do.
//!
//! Tests hold outputs and gradients against a plain network in 64 bits, written down from its definition; and, where graphics
//! cards are built in, against their twin in the `burn` crate.

pub mod convolution;
pub mod elementwise;
pub mod network;
pub mod pass;
pub mod product;
pub mod simd;
pub mod weights;
