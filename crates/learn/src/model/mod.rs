//! What a policy network is: its shape, its parameters, and the two things done with it (acting and learning).

mod initialise;
mod network;
mod shape;
mod stack;

pub use initialise::Initialisation;
pub use network::{ActingNetwork, LearningNetwork, NetworkWeights, PixelScale, Published, Sequences};
pub use shape::{Convolution, ImageShape, NetworkShape, Parameter, ParameterKind};
pub use stack::{Actor, ModelSequences, ModelShape, Stack};
