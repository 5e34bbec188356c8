//! The registry: scenarios, levels and the ids that name them.

use crate::error::{EnvError, excerpt};
use crate::scenarios::common::outcome::MOST_TERMS;
use crate::scenarios::common::rule_set::RuleSet;
use crate::scenarios::common::scenario::Scenario;
use crate::scenarios::common::spec::{ScenarioSpec, Setting};
use crate::spaces::action::BUTTONS;
use std::fmt;
use std::sync::{PoisonError, RwLock};

/// Scenarios beyond the benchmark's, the one registered last at the end.
static REGISTERED: RwLock<Vec<Scenario>> = RwLock::new(Vec::new());

impl Scenario {
    /// The benchmark's scenarios, in the order of the paper's tables.
    #[must_use]
    pub fn in_paper_order() -> [Scenario; 6] {
        let mut all = Scenario::ALL;
        all.sort_by_key(|scenario| scenario.paper_place);
        all
    }

    /// Every scenario there is: the benchmark's, then those registered, each name once.
    #[must_use]
    pub fn every() -> Vec<Scenario> {
        let registered = REGISTERED.read().unwrap_or_else(PoisonError::into_inner);
        let newest = |at: &usize| {
            registered[at + 1..].iter().all(|later| later.name != registered[*at].name)
        };
        Scenario::ALL
            .into_iter()
            .chain((0..registered.len()).filter(newest).map(|at| registered[at]))
            .collect()
    }

    /// Adds a scenario: from now on its ids are known everywhere. One of a name that was registered
    /// before takes its place; worlds that were made stay what they are. Registering the same value
    /// again changes nothing.
    ///
    /// # Errors
    /// If the name is one of the benchmark's, or no name, or if the cost terms are more than
    /// [`MOST_TERMS`] or two have one name, or if a button is unknown; one line.
    pub fn register(spec: &'static ScenarioSpec) -> Result<Scenario, EnvError> {
        let refuse = |allowed: &str| EnvError::Option {
            option: "a scenario's name",
            given: excerpt(spec.name),
            allowed: allowed.to_string(),
        };
        if !is_name(spec.name) {
            return Err(refuse(
                "1 to 40 letters and digits, a letter first, without `Level` and a digit at the end",
            ));
        }
        if Scenario::ALL.iter().any(|own| own.name.eq_ignore_ascii_case(spec.name)) {
            return Err(refuse("another than those of the benchmark"));
        }
        let terms = spec.cost_terms;
        let twice = |at: usize| terms[..at].iter().any(|before| before.name == terms[at].name);
        let found = if terms.len() > MOST_TERMS {
            Some(format!("{} terms", terms.len()))
        } else {
            (0..terms.len()).find(|&at| twice(at)).map(|at| format!("{} twice", terms[at].name))
        };
        if let Some(given) = found {
            let allowed = format!("up to {MOST_TERMS}, each with a name of its own");
            return Err(EnvError::Option { option: "a scenario's cost terms", given, allowed });
        }
        let scenario = Scenario::of(spec);
        if let Some(given) = wrong_buttons(spec) {
            let names: Vec<&str> = BUTTONS.iter().map(|(name, _)| *name).collect();
            let allowed = format!("groups of these: {}", names.join(", "));
            return Err(EnvError::Option { option: "a scenario's buttons", given, allowed });
        }
        let mut registered = REGISTERED.write().unwrap_or_else(PoisonError::into_inner);
        registered.retain(|known| *known != scenario);
        registered.push(scenario);
        Ok(scenario)
    }

    /// The registered scenario that was read from a file of this text, if there is one; as `last`,
    /// it takes the place of others of its name from now on.
    pub(crate) fn of_text(text: &str, last: bool) -> Option<Scenario> {
        let mut registered = REGISTERED.write().unwrap_or_else(PoisonError::into_inner);
        let at =
            registered.iter().position(|known| known.file.is_some_and(|file| file.text == text))?;
        if last {
            registered[at..].rotate_left(1);
        }
        Some(registered[if last { registered.len() - 1 } else { at }])
    }

    /// Adds a scenario beneath those of its name that are known already.
    pub(crate) fn register_beneath(spec: &'static ScenarioSpec) -> Result<Scenario, EnvError> {
        let scenario = Scenario::register(spec)?;
        let mut registered = REGISTERED.write().unwrap_or_else(PoisonError::into_inner);
        if let Some(at) = registered.iter().position(|known| *known == scenario) {
            registered[..=at].rotate_right(1);
        }
        Ok(scenario)
    }

    /// Its environments, by level.
    pub fn environments(self) -> impl Iterator<Item = EnvId> {
        (1..=self.spec().levels.max(1)).map(move |level| EnvId { scenario: self, level })
    }
}

/// The first of a scenario's buttons that is none, or a group without any.
fn wrong_buttons(spec: &ScenarioSpec) -> Option<String> {
    let levels = 1..=spec.levels.max(1);
    let constraints = levels.flat_map(|level| [false, true].map(|hard| (level, hard)));
    let settings = constraints
        .flat_map(|(level, hard)| RuleSet::ALL.map(|rules| Setting::new(rules, hard, level)));
    settings.flat_map(|setting| spec.task.controls(setting).simplified).find_map(|group| {
        let unknown = |name: &&&str| BUTTONS.iter().all(|(known, _)| known != *name);
        let empty = group.is_empty().then(|| "an empty group".to_string());
        empty.or_else(|| group.iter().find(unknown).map(|name| excerpt(name)))
    })
}

/// Whether a scenario may be called so: its ids must differ from those of levels, and from paths.
pub(crate) fn is_name(name: &str) -> bool {
    let plain = name.bytes().all(|byte| byte.is_ascii_alphanumeric())
        && name.bytes().next().is_some_and(|b| b.is_ascii_alphabetic());
    let level = name
        .rsplit_once("Level")
        .is_some_and(|(_, rest)| rest.bytes().all(|byte| byte.is_ascii_digit()));
    plain && !level && name.len() <= 40
}

/// An environment: a scenario at a level. Its text is the id, `RemedyRushLevel1-v0`, or `MyTask-v0`
/// where there are no levels.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct EnvId {
    /// The scenario.
    pub scenario: Scenario,
    /// The level, from 1.
    pub level: u8,
}

impl EnvId {
    /// Every environment of the benchmark, by scenario and level.
    pub fn all() -> impl Iterator<Item = EnvId> {
        Scenario::ALL.into_iter().flat_map(Scenario::environments)
    }

    /// Every environment there is: the benchmark's, then those of registered scenarios.
    pub fn every() -> impl Iterator<Item = EnvId> {
        Scenario::every().into_iter().flat_map(Scenario::environments)
    }

    /// The environment of an id: one of `scenario`'s if that is given, whatever the registry has
    /// under its name.
    ///
    /// # Errors
    /// Names the nearest id.
    pub fn within(scenario: Option<Scenario>, id: &str) -> Result<EnvId, EnvError> {
        let own =
            scenario.and_then(|scenario| scenario.environments().find(|own| own.to_string() == id));
        own.map_or_else(|| id.parse(), Ok)
    }

    /// Index of the level, from 0.
    #[must_use]
    pub const fn level_index(self) -> usize {
        self.level as usize - 1
    }

    /// The cost that an episode may have under a rule set and a constraint: 0 under the hard one.
    #[must_use]
    pub const fn safety_budget(self, rules: RuleSet, hard: bool) -> f64 {
        if hard { 0.0 } else { self.scenario.safety_budget(rules) }
    }

    /// Its world under a rule set and a constraint.
    #[must_use]
    pub const fn setting(self, rules: RuleSet, hard: bool) -> Setting {
        Setting::new(rules, hard, self.level)
    }
}

impl fmt::Display for EnvId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.scenario.levels {
            0 => write!(f, "{}-v0", self.scenario.name()),
            _ => write!(f, "{}Level{}-v0", self.scenario.name(), self.level),
        }
    }
}

impl std::str::FromStr for EnvId {
    type Err = EnvError;

    fn from_str(text: &str) -> Result<EnvId, EnvError> {
        if text.contains(',') {
            return Err(EnvError::Option {
                option: "an environment",
                given: crate::error::excerpt(text),
                allowed:
                    "one id; several make a batch, of `hasard bench` and of make_vec in Python"
                        .to_string(),
            });
        }
        let all: Vec<EnvId> = EnvId::every().collect();
        all.iter().copied().find(|id| id.to_string() == text).ok_or_else(|| {
            // Ids are short and few: the plain edit distance over upper-cased text is quick enough
            // and forgives typos and case.
            let wanted = text.to_uppercase();
            let distance = |id: &str| edit_distance(&wanted, &id.to_uppercase());
            // A scenario without its level is near, any other word is not.
            let near = all.iter().map(EnvId::to_string).filter(|id| distance(id) <= id.len() / 2);
            let nearest = near.min_by_key(|id| distance(id)).unwrap_or_default();
            EnvError::UnknownId { id: excerpt(text), nearest }
        })
    }
}

/// Least number of characters inserted, removed or replaced that turn `a` into `b`: what the
/// nearest known name to a mistyped one is found by. Of `a` the first 200 characters count.
#[must_use]
pub fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.chars().take(200).enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, &to) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(from != to);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_id_names_itself() {
        let ids: Vec<EnvId> = EnvId::all().collect();
        assert_eq!(ids.len(), 18);
        for id in ids {
            assert_eq!(id.to_string().parse(), Ok(id));
        }
    }

    #[test]
    fn a_wrong_id_is_answered_with_the_nearest() {
        for (wrong, nearest) in [
            ("volcanicventurelevel1-v0", "VolcanicVentureLevel1-v0"),
            ("VolcanicVentureLevel2", "VolcanicVentureLevel2-v0"),
            ("RemedyRushLevel3-v1", "RemedyRushLevel3-v0"),
            ("RemedyRush", "RemedyRushLevel1-v0"),
        ] {
            let Err(EnvError::UnknownId { nearest: found, .. }) = wrong.parse::<EnvId>() else {
                panic!("{wrong} was accepted")
            };
            assert_eq!(found, nearest);
        }
        let far = "SafetyPointGoal1Gymnasium-v0".parse::<EnvId>().unwrap_err().to_string();
        assert!(!far.contains("nearest") && far.contains("by its file"), "{far}");
    }
}
