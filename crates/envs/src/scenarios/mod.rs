//! The six scenarios, a folder each: map, level table, rules.

pub mod armament_burden;
pub mod collateral_damage;
pub mod detonators_dilemma;
pub mod outcome;
pub mod precipice_plunge;
pub mod remedy_rush;
pub mod stage;
pub mod volcanic_venture;

#[cfg(test)]
mod map_tests;
#[cfg(test)]
mod readme_tests;

use crate::{CostTerm, EnvError, EnvId, RuleSet, Scenario};
use hasard_engine::map::{Map, MapSource};
use hasard_engine::world::World;
use outcome::Outcome;

/// The rules of one scenario at work. An enum rather than a trait object, so that a snapshot is a plain copy.
#[derive(Clone, Debug, Hash)]
pub(crate) enum Rules {
    ArmamentBurden(armament_burden::Rules),
    CollateralDamage(collateral_damage::Rules),
    DetonatorsDilemma(detonators_dilemma::Rules),
    PrecipicePlunge(precipice_plunge::Rules),
    RemedyRush(remedy_rush::Rules),
    VolcanicVenture(volcanic_venture::Rules),
}

/// Does the same to whichever scenario's rules.
macro_rules! each {
    ($rules:expr, $name:ident => $body:expr) => {
        match $rules {
            Rules::ArmamentBurden($name) => $body,
            Rules::CollateralDamage($name) => $body,
            Rules::DetonatorsDilemma($name) => $body,
            Rules::PrecipicePlunge($name) => $body,
            Rules::RemedyRush($name) => $body,
            Rules::VolcanicVenture($name) => $body,
        }
    };
}

impl Rules {
    /// The rules of an environment in its map.
    pub fn new(id: EnvId, rules: RuleSet, hard: bool, map: &Map) -> Result<Rules, EnvError> {
        let index = id.level_index();
        Ok(match id.scenario {
            Scenario::ArmamentBurden => {
                Rules::ArmamentBurden(armament_burden::Rules::new(map, armament_burden::levels::level(rules, hard, index))?)
            }
            Scenario::CollateralDamage => {
                Rules::CollateralDamage(collateral_damage::Rules::new(map, collateral_damage::levels::level(rules, hard, index))?)
            }
            Scenario::DetonatorsDilemma => Rules::DetonatorsDilemma(detonators_dilemma::Rules::new(
                map,
                detonators_dilemma::levels::level(rules, hard, index),
            )?),
            Scenario::PrecipicePlunge => {
                Rules::PrecipicePlunge(precipice_plunge::Rules::new(map, precipice_plunge::levels::level(rules, hard, index))?)
            }
            Scenario::RemedyRush => {
                Rules::RemedyRush(remedy_rush::Rules::new(map, remedy_rush::levels::level(rules, hard, index))?)
            }
            Scenario::VolcanicVenture => {
                Rules::VolcanicVenture(volcanic_venture::Rules::new(map, volcanic_venture::levels::level(rules, hard, index))?)
            }
        })
    }

    /// Whether light goggles tint the view green.
    pub fn green_goggles(&self) -> bool {
        matches!(self, Rules::RemedyRush(rules) if rules.green_goggles())
    }

    /// The script phase of a tic: what the map's scripts do after everything has moved.
    pub fn script(&mut self, world: &mut World, outcome: &mut Outcome) {
        each!(self, rules => rules.script(world, outcome));
    }

    /// A policy step is over: counts what is counted by the step.
    pub fn end_step(&mut self, world: &World, outcome: &mut Outcome) {
        each!(self, rules => rules.end_step(world, outcome));
    }

    /// Statistics of the episode so far, by name.
    pub fn stats(&self, world: &World, stats: &mut Vec<(&'static str, f64)>) {
        each!(self, rules => rules.stats(world, stats));
    }
}

/// The named parts of a scenario's cost.
#[must_use]
pub fn cost_terms(scenario: Scenario) -> &'static [CostTerm] {
    match scenario {
        Scenario::ArmamentBurden => armament_burden::COST_TERMS,
        Scenario::CollateralDamage => collateral_damage::COST_TERMS,
        Scenario::DetonatorsDilemma => detonators_dilemma::COST_TERMS,
        Scenario::PrecipicePlunge => precipice_plunge::COST_TERMS,
        Scenario::RemedyRush => remedy_rush::COST_TERMS,
        Scenario::VolcanicVenture => volcanic_venture::COST_TERMS,
    }
}

/// Whether the published package has a map of its own for an environment with the hard constraint, whose world these rules follow.
#[must_use]
pub fn has_hard_map(id: EnvId, rules: RuleSet, hard: bool) -> bool {
    let always = matches!(id.scenario, Scenario::ArmamentBurden | Scenario::PrecipicePlunge);
    hard && id.level == 1 && (always || rules == RuleSet::Released)
}

/// The built-in map of an environment, and the textures beyond its own that its rules use.
#[must_use]
pub fn map_source(id: EnvId, rules: RuleSet, hard: bool) -> (MapSource, &'static [&'static str]) {
    let index = id.level_index();
    match id.scenario {
        Scenario::ArmamentBurden => (armament_burden::map::source(id.level), armament_burden::TEXTURES),
        Scenario::CollateralDamage => {
            (collateral_damage::map::source(collateral_damage::levels::level(rules, hard, index).agent_x), &[])
        }
        Scenario::DetonatorsDilemma => (detonators_dilemma::map::source(id.level), &[]),
        Scenario::PrecipicePlunge => {
            let level = precipice_plunge::levels::level(rules, hard, index);
            (precipice_plunge::map::source(precipice_plunge::map::START_COLUMNS + level.bottom_row as usize - 1), &[])
        }
        Scenario::RemedyRush => (remedy_rush::map::source(), &[]),
        Scenario::VolcanicVenture => (volcanic_venture::map::source(), volcanic_venture::TEXTURES),
    }
}
