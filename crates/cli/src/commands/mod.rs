//! The commands, one file each.

pub mod bench;
pub mod check;
pub mod claim;
pub mod completions;
pub mod contact_sheet;
pub mod envs;
pub mod eval;
pub mod export_agent;
pub mod export_wad;
pub mod highlights;
mod init_from;
mod kept_task;
pub mod metrics;
pub mod new;
pub mod play;
pub mod record;
pub mod render;
pub mod report;
mod resume;
pub mod rollout;
pub mod scoreboard;
pub mod serve;
pub mod settings;
pub mod site;
pub mod sweep;
pub mod trace;
pub mod train;
mod train_again;
mod train_settings;
pub mod verify;

pub use resume::flag_of;
