//! An agent that acts more or less decidedly than it was trained to.
//!
//! The logits of a policy divided by a temperature T: probabilities become p^(1/T), normalised. Below
//! 1 the likelier actions become likelier still, towards 0 an agent always takes the likeliest; above
//! 1 it acts more at random. The deviations of turns by degrees are multiplied by T. It is a number of
//! an agent's file and changes its last layer as the agent is loaded to act; a training that begins
//! with the file begins with what was trained.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::networks::distribution::ActionShape;

/// What logits are divided by, 0.01 to 100; 1 if nothing is said.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
#[serde(try_from = "f64", into = "f64")]
pub struct Temperature(f64);

impl Default for Temperature {
    fn default() -> Temperature {
        Temperature(1.0)
    }
}

impl TryFrom<f64> for Temperature {
    type Error = String;

    fn try_from(number: f64) -> Result<Temperature, String> {
        let fits = (0.01..=100.0).contains(&number);
        fits.then_some(Temperature(number)).ok_or_else(|| {
            "a temperature is a number from 0.01, the likeliest actions, to 100; 1 is an agent as it was trained".into()
        })
    }
}

impl From<Temperature> for f64 {
    fn from(temperature: Temperature) -> f64 {
        temperature.0
    }
}

impl FromStr for Temperature {
    type Err = String;

    fn from_str(text: &str) -> Result<Temperature, String> {
        text.parse().unwrap_or(f64::NAN).try_into()
    }
}

impl fmt::Display for Temperature {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl Temperature {
    /// Whether an agent acts as it was trained to.
    #[must_use]
    pub fn is_as_trained(&self) -> bool {
        *self == Temperature::default()
    }

    /// Changes a tensor of a network as an agent acts by it.
    pub(super) fn apply(self, action: &ActionShape, tensor: &str, weights: &mut [f32]) {
        let is_bias = match tensor {
            _ if self.is_as_trained() => return,
            "network0.head0.weight" => false,
            "network0.head0.bias" => true,
            _ => return,
        };
        for row in weights.chunks_exact_mut(action.parameters()) {
            let (logits, normals) = row.split_at_mut(action.sizes.iter().sum());
            for weight in logits {
                *weight = (f64::from(*weight) / self.0) as f32;
            }
            for normal in normals.chunks_exact_mut(2).filter(|_| is_bias) {
                normal[1] += libm::log(self.0) as f32;
            }
        }
    }
}
