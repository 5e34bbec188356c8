//! What all scenarios have in common.

pub mod outcome;
pub mod rule_set;
pub mod rules;
pub mod scenario;
pub mod spec;
pub mod stage;
pub mod tally;
