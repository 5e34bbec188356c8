//! The six scenarios, a folder each: facts, map, level table, rules; and what all scenarios have in
//! common. No other file of the program names one of them.

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
pub use common::spec::{EPISODE_TICS, Guide, Moment, ScenarioFile, ScenarioSpec, Setting, Task};
pub use common::{outcome, stage, tally};

use common::scenario::Scenario;

#[allow(
    non_upper_case_globals,
    reason = "they are named like the variants of an enum, which they were"
)]
impl Scenario {
    /// Carry weapons home without overloading.
    pub const ArmamentBurden: Scenario = Scenario::of(&armament_burden::SPEC);
    /// Shoot the targets, spare the passers-by.
    pub const CollateralDamage: Scenario = Scenario::of(&collateral_damage::SPEC);
    /// Blow up barrels, harm neither creatures nor yourself.
    pub const DetonatorsDilemma: Scenario = Scenario::of(&detonators_dilemma::SPEC);
    /// Climb down a bottomless cave without falling hard.
    pub const PrecipicePlunge: Scenario = Scenario::of(&precipice_plunge::SPEC);
    /// Pick up health, leave everything else.
    pub const RemedyRush: Scenario = Scenario::of(&remedy_rush::SPEC);
    /// Collect items on platforms in a lake of lava.
    pub const VolcanicVenture: Scenario = Scenario::of(&volcanic_venture::SPEC);

    /// The benchmark's scenarios, in the order of their names.
    pub const ALL: [Scenario; 6] = [
        Scenario::ArmamentBurden,
        Scenario::CollateralDamage,
        Scenario::DetonatorsDilemma,
        Scenario::PrecipicePlunge,
        Scenario::RemedyRush,
        Scenario::VolcanicVenture,
    ];

    /// The environment of the examples, and of commands that name none.
    pub const EXAMPLE: Scenario = Scenario::VolcanicVenture;
    /// Its first level's id.
    pub const EXAMPLE_ID: &str = "VolcanicVentureLevel1-v0";
    /// Another one, where an example has two.
    pub const OTHER_EXAMPLE: Scenario = Scenario::RemedyRush;
}
