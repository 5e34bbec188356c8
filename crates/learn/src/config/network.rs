//! The network's layers and their initial weights.

use serde::{Deserialize, Serialize};

/// The network's layers; heads and inputs follow from the worlds and the algorithm.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct NetworkConfig {
    /// Convolutions.
    pub convolutions: Vec<Convolution>,
    /// Units of the dense layers.
    pub dense: Vec<usize>,
    /// Units of the GRU; `null` for a feed-forward network.
    pub recurrent: Option<usize>,
    /// Policy and critics as networks of their own.
    pub separate: bool,
    /// Initial weights.
    pub initialisation: Initialisation,
}

/// A convolution without padding, followed by an ELU.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
pub struct Convolution {
    /// Output channels, a multiple of 32.
    pub channels: usize,
    /// Side of the square kernel.
    pub kernel: usize,
    /// Step of the kernel.
    pub stride: usize,
}

/// How the weights of a new network are drawn.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Initialisation {
    /// Orthogonal with gain 1 everywhere, biases zero: what the paper says.
    Orthogonal,
    /// Orthogonal on the heads; uniform within 1/sqrt(fan-in) elsewhere with zero biases, and biases drawn too in the
    /// GRU: what the released code does, whose initialiser does not reach the scripted encoder.
    OrthogonalHeads,
    /// Uniform within 1/sqrt(fan-in) everywhere, biases too: the released TRPO networks, which are never initialised.
    Uniform,
}
