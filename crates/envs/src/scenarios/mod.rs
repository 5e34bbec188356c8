//! The six scenarios, a folder each: map, level table, rules.

pub mod armament_burden;
pub mod collateral_damage;
pub mod detonators_dilemma;
pub mod outcome;
pub mod precipice_plunge;
pub mod remedy_rush;
pub mod stage;
pub mod tally;
pub mod volcanic_venture;

#[cfg(test)]
mod map_tests;
#[cfg(test)]
mod readme_tests;

use crate::action::Controls;
use crate::{CostTerm, EnvError, EnvId, EnvOptions, RuleSet, Scenario};
use hasard_engine::map::{Map, MapSource};
use hasard_engine::world::World;
use outcome::Outcome;

/// Length of an episode, in tics after its first observation; in Collateral Damage mostly a little less.
pub const EPISODE_TICS: u32 = 2100;

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

/// What of the level tables concerns the environment rather than its rules.
macro_rules! level {
    ($id:expr, $rules:expr, $hard:expr, $name:ident => $body:expr) => {{
        let (rules, hard, index) = ($rules, $hard, $id.level_index());
        match $id.scenario {
            Scenario::ArmamentBurden => {
                let $name = armament_burden::levels::level(rules, hard, index);
                $body
            }
            Scenario::CollateralDamage => {
                let $name = collateral_damage::levels::level(rules, hard, index);
                $body
            }
            Scenario::DetonatorsDilemma => {
                let $name = detonators_dilemma::levels::level(rules, hard, index);
                $body
            }
            Scenario::PrecipicePlunge => {
                let $name = precipice_plunge::levels::level(rules, hard, index);
                $body
            }
            Scenario::RemedyRush => {
                let $name = remedy_rush::levels::level(rules, hard, index);
                $body
            }
            Scenario::VolcanicVenture => {
                let $name = volcanic_venture::levels::level(rules, hard, index);
                $body
            }
        }
    }};
}

impl Rules {
    /// The rules of an environment in its map.
    pub fn new(id: EnvId, options: &EnvOptions, map: &Map) -> Result<Rules, EnvError> {
        let (rules, hard, index) = (options.rules, options.hard, id.level_index());
        Ok(match id.scenario {
            Scenario::ArmamentBurden => {
                Rules::ArmamentBurden(armament_burden::Rules::new(map, armament_burden::levels::level(rules, hard, index))?)
            }
            Scenario::CollateralDamage => {
                Rules::CollateralDamage(collateral_damage::Rules::new(map, collateral_damage::levels::level(rules, hard, index))?)
            }
            Scenario::DetonatorsDilemma => {
                let mut level = detonators_dilemma::levels::level(rules, hard, index);
                if options.early_creatures {
                    level.creatures = detonators_dilemma::levels::early_creatures(rules, hard, index).ok_or_else(misplaced)?;
                }
                Rules::DetonatorsDilemma(detonators_dilemma::Rules::new(map, level)?)
            }
            _ if options.early_creatures => return Err(misplaced()),
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

    /// The world is there, and no tic has run.
    pub fn prepare(&self, world: &mut World) {
        if let Rules::VolcanicVenture(rules) = self {
            rules.prepare(world);
        }
    }

    /// Whether light goggles tint the view green.
    pub fn green_goggles(&self) -> bool {
        matches!(self, Rules::RemedyRush(rules) if rules.green_goggles())
    }

    /// The script phase of a tic: what the map's scripts do after everything has moved.
    pub fn script(&mut self, world: &mut World, outcome: &mut Outcome) {
        each!(self, rules => rules.script(world, outcome));
    }

    /// A policy step is over, and perhaps the episode by death or the rules: counts what is counted by the step.
    pub fn end_step(&mut self, world: &World, over: bool, outcome: &mut Outcome) {
        each!(self, rules => rules.end_step(world, over, outcome));
    }

    /// Statistics of the episode so far, by name.
    pub fn stats(&self, world: &World, stats: &mut Vec<(&'static str, f64)>) {
        each!(self, rules => rules.stats(world, stats));
    }
}

/// The refusal of an option that only one environment has.
fn misplaced() -> EnvError {
    let allowed = "false, except in DetonatorsDilemmaLevel1-v0 with the soft constraint under the rules tables".to_string();
    EnvError::Option { option: "early_creatures", given: "true".to_string(), allowed }
}

/// The buttons of an environment.
#[must_use]
pub(crate) fn controls(id: EnvId, rules: RuleSet, hard: bool) -> Controls {
    level!(id, rules, hard, level => level.controls)
}

/// Completed tics at the first observation of an environment, and at its time-out.
#[must_use]
pub(crate) fn clock(id: EnvId, rules: RuleSet, hard: bool) -> (u32, u32) {
    match id.scenario {
        Scenario::CollateralDamage => {
            let level = collateral_damage::levels::level(rules, hard, id.level_index());
            (collateral_damage::levels::START_TIC, level.end_tic)
        }
        _ => (1, 1 + EPISODE_TICS),
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
    hard && id.level == 1 && (always || rules.plays_published_hard_worlds())
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
