//! Fixed policies, and episodes played by them.

pub mod carrier;
pub mod policy;
pub mod rollout;
