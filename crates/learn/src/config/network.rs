//! The network's layers and their initial weights.

use serde::{Deserialize, Serialize};

use crate::config::names::names;

/// The network's layers; heads and inputs follow from the worlds and the algorithm.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct NetworkConfig {
    /// Convolutions.
    pub convolutions: Vec<Convolution>,
    /// Channels of each stage of a residual encoder, which then stands in the place of the
    /// convolutions: what IMPALA's larger network has (Espeholt et al. 2018, arXiv 1802.01561,
    /// figure 3), there 16, 32 and 32, here multiples of 32. Empty for plain convolutions.
    #[serde(default)]
    pub residual: Vec<usize>,
    /// Units of the dense layers.
    pub dense: Vec<usize>,
    /// Units of the recurrent layer; `null` for a feed-forward network.
    pub recurrent: Option<usize>,
    /// What the recurrent layer is made of.
    #[serde(default)]
    pub cell: RecurrentCell,
    /// Policy and critics as networks of their own.
    pub separate: bool,
    /// Policy and critics see each picture and its mirror image, and say the mean of what follows
    /// from both, left and right exchanged in the actions: what is learned of one side is learned of
    /// the other. For twice the arithmetic.
    #[serde(default)]
    pub mirror: bool,
    /// Initial weights.
    pub initialisation: Initialisation,
    /// Factor of the initial weights of the policy's last layer. With 0.01 the first policy is
    /// nearly uniform, whatever it sees (Andrychowicz et al. 2020, arXiv 2006.05990).
    #[serde(default = "one")]
    pub policy_scale: f64,
}

/// What files of before say nothing of.
fn one() -> f64 {
    1.0
}

names! {
    /// What a recurrent layer is made of.
    #[derive(Default)]
    RecurrentCell ("recurrent cell") {
        /// Gated recurrent units (Cho et al. 2014, arXiv 1406.1078), with the reset behind the
        /// product as cuDNN and PyTorch have it: what the benchmark uses.
        #[default]
        Gru = "gru",
        /// Long short-term memory with a forget gate (Gers et al. 2000), without peepholes.
        Lstm = "lstm",
    }
}

impl RecurrentCell {
    /// Gates, the candidate among them: what input and state are multiplied for, each times the
    /// units.
    #[must_use]
    pub const fn gates(self) -> usize {
        match self {
            RecurrentCell::Gru => 3,
            RecurrentCell::Lstm => 4,
        }
    }

    /// Numbers of the state that each unit carries from step to step; the first is its output.
    #[must_use]
    pub const fn states(self) -> usize {
        match self {
            RecurrentCell::Gru => 1,
            RecurrentCell::Lstm => 2,
        }
    }
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
    /// Orthogonal on the heads; uniform within 1/sqrt(fan-in) elsewhere with zero biases, and
    /// biases drawn too in the GRU: what the released code does, whose initialiser does not reach
    /// the scripted encoder.
    OrthogonalHeads,
    /// Uniform within 1/sqrt(fan-in) everywhere, biases too: the released TRPO networks, which are
    /// never initialised.
    Uniform,
}
