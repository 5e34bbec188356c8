//! Training of safe reinforcement learning agents on the worlds of the HASARD benchmark.

pub mod burn_network;
pub mod cpu;
pub mod error;
pub mod model;
pub mod random;
