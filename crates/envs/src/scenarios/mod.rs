//! The six scenarios, a folder each: facts, map, level table, rules; and what all scenarios have in
//! common.

pub mod armament_burden;
pub mod collateral_damage;
pub mod detonators_dilemma;
mod facts;
pub mod outcome;
pub mod precipice_plunge;
pub mod remedy_rush;
mod rules;
mod spec;
pub mod stage;
pub mod tally;
pub mod volcanic_venture;

#[cfg(test)]
mod map_tests;
#[cfg(test)]
mod readme_tests;

pub(crate) use facts::{clock, controls, misplaced, rules as make_rules};
pub use facts::{cost_terms, episode_steps, has_hard_map, map_source};
pub use rules::{AnyRules, Rules};
pub(crate) use spec::at;
pub use spec::{EPISODE_TICS, Moment, ScenarioFile, ScenarioSpec, Setting, Task};
