//! The HASARD benchmark: scenarios, ids, action spaces, the single environment and the batch of worlds [`VecEnv`].

mod action;
mod batch;
mod environment;
mod error;
mod options;
mod registry;
pub mod scenarios;
mod vec_env;

pub use action::{ActionGroup, ActionSpace, BUTTONS, DELTA_DEGREES, DeltaButton, parse_command};
pub use batch::{Batch, Episode};
pub use environment::{CostTerm, Environment, Step};
pub use error::EnvError;
pub use options::{EnvOptions, FrameSize, Layout, ObservationKind, RuleSet};
pub use registry::{EnvId, Scenario};
pub use vec_env::{Autoreset, FinalObservations, LaneState, VecEnv, VecOptions};
