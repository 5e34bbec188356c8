//! The facts of an environment, asked by id.

use crate::interface::step::CostTerm;
use crate::registry::scenario::EnvId;
use crate::scenarios::common::rule_set::RuleSet;
use crate::scenarios::common::scenario::Scenario;
use crate::spaces::action::ActionSpace;
use hasard_engine::map::MapSource;

impl ActionSpace {
    /// The space of an environment under its rules and constraint: the few buttons that its task
    /// needs, or all of them.
    #[must_use]
    pub fn of(id: EnvId, rules: RuleSet, hard: bool, full: bool) -> ActionSpace {
        let controls = id.scenario.task.controls(id.setting(rules, hard));
        if full { ActionSpace::full(controls) } else { ActionSpace::new(controls.simplified, &[]) }
    }

    /// The space that several environments have together under their rules and constraint.
    #[must_use]
    pub fn together(ids: &[EnvId], rules: RuleSet, hard: bool, full: bool) -> ActionSpace {
        ActionSpace::joined(ids.iter().map(|id| ActionSpace::of(*id, rules, hard, full)))
    }
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
