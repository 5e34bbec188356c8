//! A file as a scenario: read for every level, constraint and rule set, and registered like any
//! other.

use super::intern::intern;
use super::mistakes::{Mistake, Mistakes};
use super::model::{MapPlan, Names, Plan};
use super::program::Program;
use super::rehearsal::rehearse;
use super::rules::OwnRules;
use super::tree::{Node, Value};
use super::{check as checks, layers, place, read, tiles, tree};
use crate::interface::fingerprint::of_text;
use crate::scenarios::{AnyRules, ScenarioFile, ScenarioSpec, Setting, Task};
use crate::single::blueprint::has_start;
use crate::spaces::action::Controls;
use crate::{CostTerm, EnvError, RuleSet, Scenario};
use hasard_engine::map::{Map, MapSource};
use hasard_engine::world::World;
use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// Most levels of a file.
const MOST_LEVELS: u8 = 9;

/// Where the settings of a rule set, a constraint and a level lie in a list of all.
fn index(setting: Setting) -> usize {
    (usize::from(setting.level) - 1) * 6 + setting.rules as usize * 2 + usize::from(setting.hard)
}

/// A file that was read.
#[derive(Debug)]
pub struct Checked {
    /// All that is wrong with it or can never happen, in the order of the text.
    pub mistakes: Vec<Mistake>,
    /// What it says, if it can be played.
    read: Option<Read>,
}

/// What a file says.
#[derive(Debug)]
struct Read {
    levels: u8,
    names: Names,
    plans: Vec<Plan>,
}

impl Checked {
    /// Whether it can be played.
    #[must_use]
    pub fn can_be_played(&self) -> bool {
        self.read.is_some()
    }

    /// The map of a level under the soft constraint, as the file draws it.
    #[must_use]
    pub fn map(&self, level: u8) -> Option<MapSource> {
        let read = self.read.as_ref().filter(|read| (1..=read.levels.max(1)).contains(&level))?;
        map_of(&read.plans[index(Setting::new(RuleSet::Paper, false, level))]).ok()
    }

    /// Plays some tics of a level with buttons at random, without registering anything.
    ///
    /// # Errors
    /// What keeps the map from being built.
    pub fn rehearse(&self, level: u8, seed: u64, tics: u32) -> Result<(), EnvError> {
        let Some(read) =
            self.read.as_ref().filter(|read| (1..=read.levels.max(1)).contains(&level))
        else {
            return Ok(());
        };
        let plan = &read.plans[index(Setting::new(RuleSet::Paper, false, level))];
        rehearse(plan, &map_of(plan)?, read.names.counters.len(), seed, tics).map(drop)
    }
}

/// Reads a scenario's text and says all that is wrong with it. Nothing is registered.
#[must_use]
pub fn check(text: &str) -> Checked {
    let mut mistakes = Mistakes::new(text);
    let root = tree::parse(text, &mut mistakes);
    let mut read = None;
    if !mistakes.any() {
        let levels = levels(&root, &mut mistakes);
        if !mistakes.any() {
            layers::check(&root, &root, levels, &[], &mut mistakes);
        }
        let mut names = Names::default();
        let mut plans = Vec::new();
        let settings = settings(levels);
        for (at, (_, setting)) in settings.iter().enumerate() {
            if !mistakes.full() {
                mistakes.reading(Some(at));
                let document = layers::document(&root, *setting, &mut mistakes);
                plans.extend(read::plan(&document, &mut names, &mut mistakes));
            }
        }
        mistakes.reading(None);
        mistakes.name_settings(&layers::places_outside(&root), |which| name_of(which, &settings));
        // What a level, the hard constraint or a rule set has otherwise is tried as well. Without
        // mistakes every setting has its plan.
        let same_map = |one: &Plan, other: &Plan| one.map == other.map && one.zones == other.zones;
        if !mistakes.any() {
            for (at, plan) in plans.iter().enumerate() {
                if !plans[..at].iter().any(|other| same_map(plan, other)) {
                    try_map(plan, &settings[at].0, &mut mistakes);
                }
            }
        }
        if !mistakes.any() {
            checks::warn(&plans, &names, &mut mistakes);
            for (at, plan) in plans.iter().enumerate() {
                let same = |other: &Plan| same_map(plan, other) && plan.spawns == other.spawns;
                if !plans[..at].iter().any(same) {
                    try_opening(plan, names.counters.len(), &mut mistakes);
                }
            }
            read = Some(Read { levels, names, plans });
        }
    }
    Checked { mistakes: mistakes.into_list(), read }
}

/// Every setting of a task with so many levels, in the order of [`index`], and how messages name it:
/// nothing where it is the usual one.
fn settings(levels: u8) -> Vec<(String, Setting)> {
    let mut all = Vec::new();
    for level in 1..=levels.max(1) {
        for rules in RuleSet::ALL {
            for hard in [false, true] {
                let mut name = String::new();
                if levels > 1 {
                    name += &format!("level {level}, ");
                }
                if rules != RuleSet::Paper {
                    name += &format!("--rules {}, ", rules.name());
                }
                if hard {
                    name += "--hard, ";
                }
                let name = name.strip_suffix(", ").map(|name| format!("{name}: "));
                all.push((name.unwrap_or_default(), Setting::new(rules, hard, level)));
            }
        }
    }
    all
}

/// How a message names several settings: by what sets them apart from the others, or else by the
/// first; nothing where they are all.
fn name_of(which: &[usize], settings: &[(String, Setting)]) -> String {
    let distinct = |of: &[Setting]| {
        let levels: BTreeSet<u8> = of.iter().map(|one| one.level).collect();
        let rules: BTreeSet<&str> = of.iter().map(|one| one.rules.name()).collect();
        let hard: BTreeSet<bool> = of.iter().map(|one| one.hard).collect();
        (levels, rules, hard)
    };
    let own: Vec<Setting> = which.iter().map(|&at| settings[at].1).collect();
    let all: Vec<Setting> = settings.iter().map(|(_, setting)| *setting).collect();
    let ((levels, rules, hard), (all_levels, all_rules, all_hard)) =
        (distinct(&own), distinct(&all));
    if own.len() != levels.len() * rules.len() * hard.len() {
        return which.first().map_or_else(String::new, |&at| settings[at].0.clone());
    }
    let mut parts = Vec::new();
    if levels.len() < all_levels.len() {
        let numbers: Vec<String> = levels.iter().map(u8::to_string).collect();
        let word = if numbers.len() == 1 { "level" } else { "levels" };
        parts.push(format!("{word} {}", numbers.join(", ")));
    }
    if rules.len() < all_rules.len() {
        let names: Vec<&str> = rules.iter().copied().collect();
        parts.push(format!("--rules {}", names.join(" or ")));
    }
    if hard.len() < all_hard.len() {
        parts.push(if hard.contains(&true) { "--hard" } else { "without --hard" }.into());
    }
    if parts.is_empty() { String::new() } else { format!("{}: ", parts.join(", ")) }
}

/// Number of levels: the highest that the file speaks of, 0 if it speaks of none.
fn levels(root: &Node, mistakes: &mut Mistakes) -> u8 {
    let mut most = 0;
    if let Some(entry) = root.get("rules") {
        known_keys(&entry.node, "rules", &RuleSet::ALL.map(RuleSet::name), mistakes);
    }
    let Some(entry) = root.get("levels") else { return 0 };
    let Value::Table(levels) = &entry.node.value else {
        mistakes.add(entry.at, "write [levels.2], [levels.3] for what is otherwise there");
        return 0;
    };
    for level in levels {
        match level.key.parse::<u8>() {
            Ok(number) if (1..=MOST_LEVELS).contains(&number) => most = most.max(number),
            _ => mistakes.add(level.at, format!("levels are numbered 1 to {MOST_LEVELS}")),
        }
    }
    let left_out = (2..most).find(|number| entry.node.get(&number.to_string()).is_none());
    if let Some(number) = left_out {
        mistakes.warn(entry.at, format!("there is no [levels.{number}]: it is as level 1"));
    }
    most
}

fn known_keys(node: &Node, what: &str, known: &[&str], mistakes: &mut Mistakes) {
    if let Value::Table(entries) = &node.value {
        for entry in entries.iter().filter(|entry| !known.contains(&&*entry.key)) {
            mistakes
                .add(entry.at, super::mistakes::unknown(what, &entry.key, known.iter().copied()));
        }
    }
}

/// Builds a map, so that what cannot be built is found before anybody plays.
fn try_map(plan: &Plan, setting: &str, mistakes: &mut Mistakes) {
    let built = map_of(plan).and_then(|source| {
        Map::build(&source, &plan.name, &[])
            .map_err(|error| EnvError::Map { why: format!("the map cannot be built: {error}") })
    });
    let ready = built.and_then(|map| {
        Program::new(plan.clone(), &map, &[])?;
        has_start(&World::new(Arc::new(map), 0))
    });
    if let Err(error) = ready {
        mistakes.add(0, format!("{setting}{error}"));
    }
}

/// Opens an episode, and warns of what finds no place in it.
fn try_opening(plan: &Plan, counters: usize, mistakes: &mut Mistakes) {
    let opened = map_of(plan).and_then(|source| rehearse(plan, &source, counters, 0, 1));
    for (index, spawn) in plan.spawns.iter().enumerate() {
        if opened
            .as_ref()
            .is_ok_and(|unplaced| unplaced.spawns.load(Ordering::Relaxed) >> index & 1 == 1)
        {
            mistakes
                .warn(spawn.at, "there is no room for all of this [[spawn]]: look at `in`, `z` and `height`, or put down fewer");
        }
    }
    if opened.is_ok_and(|unplaced| unplaced.agent.load(Ordering::Relaxed)) {
        mistakes.warn(
            plan.player.at,
            "there is no room for the agent where [player] has it appear: it stays at the map's start; look at `in`, `z` and `height`",
        );
    }
}

fn map_of(plan: &Plan) -> Result<MapSource, EnvError> {
    match &plan.map {
        MapPlan::Tiles(tiles) => tiles::source(plan, tiles),
        MapPlan::BuiltIn(scenario, level) => {
            Ok(scenario.task.map(Setting::new(RuleSet::Paper, false, *level)))
        }
        MapPlan::Drawn(drawn) => Ok(drawn.source.clone()),
    }
}

/// Registers the scenario of a text; `path` is where it was read from. The same text again gives
/// the same scenario.
///
/// # Errors
/// One line: the first mistake with its line and column, and how many there are.
pub fn register(path: &str, text: &str) -> Result<Scenario, EnvError> {
    Scenario::of_text(text, true).map_or_else(|| Scenario::register(spec(path, text)?), Ok)
}

/// As [`register`], but beneath scenarios of the same name: what a run kept does not take the place
/// of what the user names.
///
/// # Errors
/// As [`register`].
pub fn recall(path: &str, text: &str) -> Result<Scenario, EnvError> {
    Scenario::of_text(text, false).map_or_else(|| Scenario::register_beneath(spec(path, text)?), Ok)
}

/// The facts of a text's scenario, for ever.
fn spec(path: &str, text: &str) -> Result<&'static ScenarioSpec, EnvError> {
    let checked = check(text);
    let shown = crate::error::excerpt(path);
    let Some(read) = checked.read else {
        let mut wrong = checked.mistakes.iter().filter(|mistake| !mistake.warning);
        let first = wrong.next().map_or("it cannot be read".to_string(), ToString::to_string);
        let more = match wrong.count() {
            0 => String::new(),
            more => format!(" (and {more} more; `hasard check {shown}` lists them)"),
        };
        return Err(EnvError::Scenario { why: format!("{shown}:{first}{more}") });
    };
    // Without mistakes all that is left are warnings.
    let warnings = checked.mistakes.iter().map(|warning| intern(&warning.to_string())).collect();
    let first = &read.plans[0];
    let terms: Vec<CostTerm> = read
        .names
        .terms
        .iter()
        .map(|term| CostTerm { name: intern(&term.name), counted: term.counted })
        .collect();
    let (name, title, summary) =
        (intern(&first.name), intern(&first.title), intern(&first.summary));
    let budget = |rules| read.plans[index(Setting::new(rules, false, 1))].budget;
    let budgets = RuleSet::ALL.map(budget);
    let task = OwnTask {
        names: read.names.counters.iter().map(|name| intern(name)).collect(),
        controls: read.plans.iter().map(controls).collect(),
        plans: read.plans,
    };
    // Once for each distinct text: handles to scenarios live as long as the program.
    let spec = ScenarioSpec {
        levels: read.levels,
        budgets,
        cost_terms: Box::leak(terms.into_boxed_slice()),
        number: of_text(text) as isize,
        file: Some(ScenarioFile {
            path: intern(path),
            text: intern(text),
            hash: intern(&place::fingerprint(text)),
            warnings: Box::leak(warnings),
        }),
        ..ScenarioSpec::of(name, title, summary, Box::leak(Box::new(task)))
    };
    Ok(Box::leak(Box::new(spec)))
}

fn controls(plan: &Plan) -> Controls {
    let groups: Vec<&'static [&'static str]> =
        plan.actions.iter().map(|group| &*Box::leak(group.clone().into_boxed_slice())).collect();
    Controls {
        simplified: Box::leak(groups.into_boxed_slice()),
        full_moves: true,
        full_speed: true,
    }
}

/// Makes the worlds of a file.
#[derive(Debug)]
struct OwnTask {
    names: Vec<&'static str>,
    controls: Vec<Controls>,
    plans: Vec<Plan>,
}

impl OwnTask {
    fn plan(&self, setting: Setting) -> &Plan {
        &self.plans[index(setting)]
    }
}

impl Task for OwnTask {
    fn controls(&self, setting: Setting) -> Controls {
        self.controls[index(setting)]
    }

    fn clock(&self, setting: Setting) -> (u32, u32) {
        (1, 1 + self.plan(setting).tics)
    }

    fn map(&self, setting: Setting) -> MapSource {
        map_of(self.plan(setting)).expect("a map that was built when the file was read")
    }

    fn left_out(&self, setting: Setting) -> Vec<String> {
        match &self.plan(setting).map {
            MapPlan::Drawn(drawn) => drawn.left_out.clone(),
            MapPlan::Tiles(_) | MapPlan::BuiltIn(..) => Vec::new(),
        }
    }

    fn has_test_seeds(&self, setting: Setting) -> bool {
        match &self.plan(setting).map {
            MapPlan::Tiles(tiles) => {
                tiles.generate.as_ref().is_some_and(|generate| generate.train_seeds > 0)
            }
            MapPlan::BuiltIn(..) | MapPlan::Drawn(_) => false,
        }
    }

    fn rules(&self, setting: Setting, map: &Map) -> Result<AnyRules, EnvError> {
        let mut program = Program::new(self.plan(setting).clone(), map, &self.names)?;
        program.test_seeds = setting.test_seeds;
        Ok(AnyRules::new(OwnRules::new(Arc::new(program), self.names.len())))
    }
}
