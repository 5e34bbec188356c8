//! The six scenarios, a folder each: facts, map, level table, rules; and what all scenarios have in
//! common.

pub mod armament_burden;
pub mod collateral_damage;
pub(crate) mod common;
pub mod detonators_dilemma;
pub mod precipice_plunge;
pub mod remedy_rush;
pub mod volcanic_venture;

#[cfg(test)]
mod map_tests;
#[cfg(test)]
mod readme_tests;

pub use crate::registry::facts::{cost_terms, episode_steps, has_hard_map, map_source};
pub use common::rules::{AnyRules, Rules};
pub use common::spec::{EPISODE_TICS, Moment, ScenarioFile, ScenarioSpec, Setting, Task};
pub use common::{outcome, stage, tally};
