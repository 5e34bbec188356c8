//! Checkpoints: everything that a run needs to go on as if it had never stopped.
//!
//! A checkpoint is a directory with `weights.safetensors` (the networks' parameters by name and the
//! pixel statistics: all that acting needs), `training.safetensors` (moments of the optimiser,
//! states of the lanes) and `state.json` (counters, multipliers, statistics, and a checksum of the
//! other two). It is written under another name and renamed when complete and on the disk, so that
//! under its own name it is whole, whenever the machine may stop.

mod blocks;
mod progress;
mod read;
mod store;
mod write;

pub use progress::Progress;
pub use read::Loaded;
pub use store::Store;
pub use write::Checkpoint;
pub(crate) use write::parameter_names;
