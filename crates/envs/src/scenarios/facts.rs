//! The facts of an environment, asked by id.

use super::{AnyRules, Setting};
use crate::action::Controls;
use crate::{CostTerm, EnvError, EnvId, EnvOptions, RuleSet, Scenario};
use hasard_engine::map::{Map, MapSource};

/// The rules of an environment in its map.
pub(crate) fn rules(id: EnvId, options: &EnvOptions, map: &Map) -> Result<AnyRules, EnvError> {
    if options.early_creatures && !id.scenario.early_creatures {
        return Err(misplaced());
    }
    let (early_creatures, test_seeds) = (options.early_creatures, options.test_seeds);
    let setting =
        Setting { early_creatures, test_seeds, ..id.setting(options.rules, options.hard) };
    id.scenario.task.rules(setting, map)
}

/// The refusal of an option that only one environment has.
pub(crate) fn misplaced() -> EnvError {
    let allowed = "false, except in DetonatorsDilemmaLevel1-v0 with the soft constraint under the rules tables".to_string();
    EnvError::Option { option: "early_creatures", given: "true".to_string(), allowed }
}

/// The buttons of an environment.
pub(crate) fn controls(id: EnvId, rules: RuleSet, hard: bool) -> Controls {
    id.scenario.task.controls(id.setting(rules, hard))
}

/// Completed tics at the first observation of an environment, and at its time-out.
pub(crate) fn clock(id: EnvId, rules: RuleSet, hard: bool) -> (u32, u32) {
    id.scenario.task.clock(id.setting(rules, hard))
}

/// Policy steps of an episode that only time ends.
#[must_use]
pub fn episode_steps(id: EnvId, rules: RuleSet, hard: bool, frame_skip: u32) -> u32 {
    let (start, end) = clock(id, rules, hard);
    (end - start).div_ceil(frame_skip.max(1))
}

/// The named parts of a scenario's cost.
#[must_use]
pub fn cost_terms(scenario: Scenario) -> &'static [CostTerm] {
    scenario.cost_terms
}

/// Whether the published package has a map of its own for an environment with the hard constraint,
/// whose world these rules follow.
#[must_use]
pub fn has_hard_map(id: EnvId, rules: RuleSet, hard: bool) -> bool {
    hard && id.level == 1 && (id.scenario.hard_map || rules.plays_published_hard_worlds())
}

/// The built-in map of an environment, and the textures beyond its own that its rules use.
#[must_use]
pub fn map_source(id: EnvId, rules: RuleSet, hard: bool) -> (MapSource, &'static [&'static str]) {
    (id.scenario.task.map(id.setting(rules, hard)), id.scenario.textures)
}
