//! Scenarios and environments by name, and their facts.

pub mod facts;
pub mod scenario;
