//! What a scenario is to everything else: its facts as plain data, and what makes its worlds.

use crate::error::EnvError;
use crate::interface::step::CostTerm;
use crate::scenarios::common::rule_set::RuleSet;
use crate::scenarios::common::rules::AnyRules;
use crate::spaces::action::Controls;
use hasard_engine::map::{Map, MapSource};
use std::fmt;

/// Length of an episode, in tics after its first observation; in Collateral Damage mostly a little
/// less.
pub const EPISODE_TICS: u32 = 2100;

/// Which of a scenario's worlds is asked for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Setting {
    /// Whose constants.
    pub rules: RuleSet,
    /// The hard constraint.
    pub hard: bool,
    /// The level, from 1.
    pub level: u8,
    /// See [`crate::EnvOptions::early_creatures`].
    pub early_creatures: bool,
    /// See [`crate::EnvOptions::test_seeds`].
    pub test_seeds: bool,
}

impl Setting {
    /// A level with its later creatures.
    #[must_use]
    pub const fn new(rules: RuleSet, hard: bool, level: u8) -> Setting {
        Setting { rules, hard, level, early_creatures: false, test_seeds: false }
    }

    /// Index of the level, from 0.
    #[must_use]
    pub const fn index(self) -> usize {
        self.level as usize - 1
    }
}

/// Makes a scenario's worlds: what differs between its levels, rule sets and constraints.
pub trait Task: fmt::Debug + Send + Sync {
    /// The buttons.
    fn controls(&self, setting: Setting) -> Controls;

    /// Completed tics at the first observation, and at the time-out.
    fn clock(&self, _setting: Setting) -> (u32, u32) {
        (1, 1 + EPISODE_TICS)
    }

    /// The built-in map.
    fn map(&self, setting: Setting) -> MapSource;

    /// What the file of that map holds that is not played as it says; empty if all is.
    fn left_out(&self, _setting: Setting) -> Vec<String> {
        Vec::new()
    }

    /// Whether there are levels that no training sees ([`crate::EnvOptions::test_seeds`]).
    fn has_test_seeds(&self, _setting: Setting) -> bool {
        false
    }

    /// The rules in a map: the built-in one or a user's, so what they need of it is looked for.
    ///
    /// # Errors
    /// One line that names the map and what it lacks.
    fn rules(&self, setting: Setting, map: &Map) -> Result<AnyRules, EnvError>;
}

/// A moment of an episode under the paper's rules, as contact sheets show it.
#[derive(Clone, Copy, Debug)]
pub struct Moment {
    /// The level.
    pub level: u8,
    /// Seed of the episode and of its policies.
    pub seed: u64,
    /// Policies that act before the moment, one after the other, each for so many steps.
    pub way: &'static [(u32, &'static str)],
}

/// What a person needs to know before playing.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Guide {
    /// What brings reward, as a sentence.
    pub collect: &'static str,
    /// What brings cost.
    pub avoid: &'static str,
    /// The seed of an episode to begin with, in which something can be seen from the start.
    pub seed: u64,
}

/// The file that a scenario was read from.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ScenarioFile {
    /// Where it was, as given; a name for people once the scenario has left that place.
    pub path: &'static str,
    /// All of it.
    pub text: &'static str,
    /// A fingerprint of its text, 16 hexadecimal digits.
    pub hash: &'static str,
    /// What was warned of as it was read: `line:column: warning: ...` each.
    pub warnings: &'static [&'static str],
}

/// A scenario: what is known of it without a world.
#[derive(Debug)]
pub struct ScenarioSpec {
    /// Its name, as in the ids.
    pub name: &'static str,
    /// Its name for people.
    pub title: &'static str,
    /// What it asks of an agent, in a sentence.
    pub summary: &'static str,
    /// Number of levels; 0 where its one world has no level in its id.
    pub levels: u8,
    /// The cost that an episode may have under the soft constraint, by rule set.
    pub budgets: [f64; 3],
    /// The named parts of its cost, at most [`crate::scenarios::outcome::MOST_TERMS`].
    pub cost_terms: &'static [CostTerm],
    /// Textures beyond its map's own that its rules use.
    pub textures: &'static [&'static str],
    /// Levels whose published package has a map of its own for the hard constraint that is played
    /// under every rule set, rather than under those alone that follow the published worlds.
    pub hard_map: bool,
    /// It has other creatures on request: see [`crate::EnvOptions::early_creatures`].
    pub early_creatures: bool,
    /// Its published worlds draw the smoke of rockets.
    pub rockets_shed: bool,
    /// Reward of a step beyond the budget, to PPOSaute.
    pub saute_unsafe_reward: f64,
    /// PPOCost's price of a unit of cost, by preset (paper, released, tables) and constraint (soft,
    /// hard).
    pub penalty_scales: [[f64; 2]; 3],
    /// What an action earns or costs follows within a second or two, so that learning need not look
    /// far ahead.
    pub prompt: bool,
    /// Who has learned what follows soon returns more by looking further ahead.
    pub rewards_foresight: bool,
    /// What an action earns or costs follows some ten steps later, and a policy that keeps a budget
    /// takes long to learn.
    pub hits_late: bool,
    /// Place in the paper's tables, from 0.
    pub paper_place: usize,
    /// What stands for it in the fingerprint of a state.
    pub number: isize,
    /// The moments that contact sheets show, and which of them is drawn at full size too.
    pub moments: (&'static [Moment], usize),
    /// What a player is asked to do.
    pub guide: Option<Guide>,
    /// Statistics of the published package that have a meaning here, and ours of the same meaning;
    /// without one it is the episode's cost so far.
    pub published_stats: &'static [(&'static str, Option<&'static str>)],
    /// The file that it was read from, if any.
    pub file: Option<ScenarioFile>,
    /// What makes its worlds.
    pub task: &'static dyn Task,
}

impl ScenarioSpec {
    /// What a scenario has unless it says otherwise; a base for struct updates.
    #[must_use]
    pub const fn of(
        name: &'static str,
        title: &'static str,
        summary: &'static str,
        task: &'static dyn Task,
    ) -> ScenarioSpec {
        ScenarioSpec {
            name,
            title,
            summary,
            levels: 3,
            budgets: [50.0; 3],
            cost_terms: &[],
            textures: &[],
            hard_map: false,
            early_creatures: false,
            rockets_shed: false,
            saute_unsafe_reward: -0.01,
            penalty_scales: [[1.0; 2]; 3],
            prompt: false,
            rewards_foresight: false,
            hits_late: false,
            paper_place: usize::MAX,
            number: -1,
            moments: (&[], 0),
            guide: None,
            published_stats: &[],
            file: None,
            task,
        }
    }
}

/// A moment in a table.
pub(crate) const fn at(level: u8, seed: u64, way: &'static [(u32, &'static str)]) -> Moment {
    Moment { level, seed, way }
}

/// The refusal of an option that only one environment has.
pub(crate) fn misplaced() -> EnvError {
    let allowed = "false, except in DetonatorsDilemmaLevel1-v0 with the soft constraint under the rules tables".to_string();
    EnvError::Option { option: "early_creatures", given: "true".to_string(), allowed }
}
