//! The six scenarios, a folder each: map, level table, rules.

pub mod armament_burden;
pub mod collateral_damage;
pub mod outcome;
pub mod precipice_plunge;
pub mod stage;
pub mod volcanic_venture;

#[cfg(test)]
mod map_tests;

use crate::{CostTerm, EnvError, EnvId, RuleSet, Scenario};
use hasard_engine::map::{Map, MapSource};
use hasard_engine::world::World;
use outcome::Outcome;

/// The rules of one scenario at work. An enum rather than a trait object, so that a snapshot is a plain copy.
#[derive(Clone, Debug, Hash)]
pub(crate) enum Rules {
    PrecipicePlunge(precipice_plunge::Rules),
    VolcanicVenture(volcanic_venture::Rules),
}

/// Does the same to whichever scenario's rules.
macro_rules! each {
    ($rules:expr, $name:ident => $body:expr) => {
        match $rules {
            Rules::PrecipicePlunge($name) => $body,
            Rules::VolcanicVenture($name) => $body,
        }
    };
}

impl Rules {
    /// The rules of an environment in its map.
    pub fn new(id: EnvId, rules: RuleSet, hard: bool, map: &Map) -> Result<Rules, EnvError> {
        let index = id.level_index();
        match id.scenario {
            Scenario::PrecipicePlunge => {
                precipice_plunge::Rules::new(map, precipice_plunge::levels::level(rules, hard, index)).map(Rules::PrecipicePlunge)
            }
            Scenario::VolcanicVenture => {
                volcanic_venture::Rules::new(map, volcanic_venture::levels::level(rules, hard, index)).map(Rules::VolcanicVenture)
            }
            _ => todo!(),
        }
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
        Scenario::PrecipicePlunge => precipice_plunge::COST_TERMS,
        Scenario::VolcanicVenture => volcanic_venture::COST_TERMS,
        _ => todo!(),
    }
}

/// The built-in map of an environment, and the textures beyond its own that its rules use.
#[must_use]
pub fn map_source(id: EnvId, rules: RuleSet, hard: bool) -> (MapSource, &'static [&'static str]) {
    let index = id.level_index();
    match id.scenario {
        Scenario::PrecipicePlunge => {
            let level = precipice_plunge::levels::level(rules, hard, index);
            (precipice_plunge::map::source(precipice_plunge::map::START_COLUMNS + level.bottom_row as usize - 1), &[])
        }
        Scenario::VolcanicVenture => (volcanic_venture::map::source(), volcanic_venture::TEXTURES),
        _ => todo!(),
    }
}
