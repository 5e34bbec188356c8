//! The network on the processor: fused kernels that reach most of what its multiply-add units can do.
//!
//! [`crate::networks::burn_network`] is the portable twin for every device of the `burn` crate; tests hold the two against each
//! other, outputs and gradients.

pub mod convolution;
pub mod elementwise;
pub mod network;
pub mod pass;
pub mod product;
pub mod simd;
pub mod weights;
