//! The HASARD benchmark: scenarios, ids, action spaces, the single [`Env`] and the batch of worlds [`VecEnv`].

mod action;
mod batch;
mod options;
pub mod scenarios;

pub use action::{ActionGroup, ActionSpace, DeltaButton};
pub use batch::{Batch, Episode};
pub use options::{EnvOptions, FrameSize, Layout, ObservationKind, RuleSet};
