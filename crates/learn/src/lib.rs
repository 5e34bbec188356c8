//! Training of safe reinforcement learning agents on the worlds of the HASARD benchmark.

pub mod advantage;
pub mod burn_network;
pub mod config;
pub mod cpu;
pub mod device;
pub mod distribution;
pub mod error;
pub mod model;
pub mod normaliser;
pub mod random;
