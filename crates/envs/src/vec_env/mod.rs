//! The batch of worlds: many environments stepped side by side by worker threads and the caller
//! that waits for them.

mod alike;
mod checks;
mod chosen;
mod crew;
mod handover;
mod job;
mod lane;
mod lane_state;
mod mixed;
mod options;
mod worker;
mod worlds;

pub use chosen::Restart;
pub use lane_state::LaneState;
pub use mixed::{MixedTask, Mixture};
pub use options::{Autoreset, FinalObservations, VecOptions};
pub use worlds::VecEnv;
