//! The commands, one file each.

pub mod envs;
pub mod rollout;
pub mod trace;
