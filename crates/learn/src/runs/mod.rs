//! A run from its first frame to its directory: the session in memory, the trainer around it,
//! checkpoints, evaluation, reports.

pub mod agent;
pub mod agent_file;
mod buttons;
pub mod calibration;
pub mod checkpoint;
pub mod checksum;
pub mod claim;
pub mod episode_row;
pub mod evaluate;
pub mod evaluation;
pub mod examiner;
mod first_episodes;
pub mod heatmap;
pub mod init_from;
pub mod measure;
pub mod metrics_explained;
pub mod metrics_log;
pub mod progress_bar;
pub mod report;
mod rounding;
pub mod run_directory;
pub mod selection;
pub mod session;
pub mod temperature;
pub mod tensorboard;
pub mod together;
pub mod trainer;
pub mod watch;
pub mod writer;
pub mod zoo;
pub mod zoo_results;
