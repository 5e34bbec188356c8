//! The statistics of evaluations: means with intervals, bounds at any level, tails.
//!
//! Everything is computed with the functions of `libm`, so that an evaluation says the same on
//! every machine.

mod bootstrap;
mod estimate;
mod quantiles;
mod tails;

pub use bootstrap::bca_interval;
pub use estimate::{Estimate, deviation, skewness, upper_bound};
pub use quantiles::{normal_quantile, t_quantile};
pub use tails::{Tails, tails};
