//! The HASARD benchmark: scenarios, ids, action spaces, the single environment and the batch of worlds [`VecEnv`].

mod action;
mod batch;
mod bench;
mod env;
mod environment;
mod error;
mod eye;
mod game;
mod options;
mod policy;
mod registry;
mod rollout;
pub mod scenarios;
mod vec_env;

pub use action::{ActionGroup, ActionSpace, BUTTONS, DELTA_DEGREES, DeltaButton, parse_command};
pub use batch::{Batch, Episode};
pub use bench::{BenchReport, bench};
pub use env::{Env, Snapshot};
pub use environment::{CostTerm, Environment, Step};
pub use error::EnvError;
pub use hasard_engine::render::FrameSize;
pub use options::{EnvOptions, Layout, ObservationKind, RuleSet};
pub use policy::{Move, Policy, PolicyRun};
pub use registry::{EnvId, Scenario};
pub use rollout::rollout;
pub use vec_env::{Autoreset, FinalObservations, LaneState, VecEnv, VecOptions};
