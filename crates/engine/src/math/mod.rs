//! Numbers of the world: 16.16 fixed point, binary angles, frozen trigonometry, division by counts,
//! the random stream.
//!
//! Nothing here uses floating point at run time, so every platform computes the same bits.

mod angle;
mod count_division;
mod fixed;
mod quarter_sine;
mod rng;
mod tangent;

pub use angle::Angle;
pub(crate) use count_division::divided_by_count;
pub use fixed::Fixed;
pub use rng::Rng;
pub(crate) use tangent::{STEEPEST, fine_tangent};
