//! What a policy network is: its shape, its parameters, and the two things done with it (acting and
//! learning).

#[cfg(feature = "graphics")]
pub mod burn_network;
pub mod cpu;
mod critic_heads;
pub mod device;
pub mod distribution;
mod in_parts;
mod initialise;
mod layers;
mod mirror;
mod network;
mod pixels;
mod shape;
mod shared_network;
mod stack;

pub use layers::{EncoderLayer, ImageShape};
pub use network::{
    ActingNetwork, LearningNetwork, NetworkWeights, Place, Published, RecordedLane, Recording,
    Sequences,
};
pub use pixels::PixelScale;
pub use shape::{NetworkShape, Parameter, ParameterKind};
pub use stack::{Actor, ModelSequences, ModelShape, Notes, Stack};
