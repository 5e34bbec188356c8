//! What an environment is to everything that steps it: the trait, and the batch of outputs.

pub mod batch;
pub mod buffer;
pub mod environment;
pub(crate) mod fingerprint;
pub mod happening;
pub mod insight;
pub mod step;
