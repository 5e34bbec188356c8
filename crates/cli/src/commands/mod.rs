//! The commands, one file each.

pub mod bench;
pub mod envs;
pub mod export_wad;
pub mod render;
pub mod rollout;
pub mod trace;
