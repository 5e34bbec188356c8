//! The algorithms, one file each.
//!
//! An [`Algorithm`] is given what its constraints cost, moves its multipliers, and improves the
//! policy on a minibatch. Gathering experience, advantages, targets and the optimiser are the same
//! for all.

mod algorithm;
mod cpo;
mod cup;
mod focops;
mod ipo;
#[cfg(test)]
mod loss_tests;
mod make;
pub mod multiplier;
mod p3o;
mod ppo;
mod ppo_cost;
mod ppo_lag;
mod ppo_pid;
mod ppo_saute;
mod signal;
#[cfg(test)]
pub(crate) mod small;
mod surrogate;
mod trpo;
mod trpo_lag;
mod trpo_pid;
pub mod trust_region;
mod value_phase;

pub use algorithm::Algorithm;
pub use make::{make, shaping};
pub use signal::{Signal, Signals};
pub use value_phase::value_phase;
