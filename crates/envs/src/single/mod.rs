//! The single environment.

pub mod blueprint;
pub mod env;
pub mod lookout;
pub mod observer;
pub mod simulation;
pub mod snapshot;
