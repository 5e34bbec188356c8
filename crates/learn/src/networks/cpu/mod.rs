//! The network on the processor: fused kernels that reach most of what its multiply-add units can
//! do.
//!
//! From the bottom up: [`tile`], [`bfloat16`], [`product`], [`outer`], [`pack`] and [`panels`]
//! multiply matrices ([`symmetric`] those that are their own transposes), [`elementwise`] does the
//! rest of the arithmetic (and [`vectors`] that of the second-order algorithms), [`convolution`]
//! turns convolutions into products, of which `residual` makes the other encoder; [`forward`]
//! writes a [`tape`] that [`backward`], [`encoder_gradient`] and [`gradient`] read; [`network`] is
//! what the rest of the crate sees.
//!
//! Tests hold outputs and gradients against a plain network in 64 bits, written down from its
//! definition; and, where graphics cards are built in, against their twin in the `burn` crate.

pub mod backward;
pub mod bfloat16;
mod buffers;
mod cells;
pub mod convolution;
pub mod elementwise;
pub mod encoder_gradient;
pub mod forward;
pub mod gradient;
pub mod network;
pub mod outer;
pub mod pack;
pub mod panels;
mod pixels;
pub mod product;
mod rectified;
mod residual;
pub mod symmetric;
pub mod tape;
pub mod tile;
pub(crate) mod vectorised;
pub mod vectors;
pub mod weights;
