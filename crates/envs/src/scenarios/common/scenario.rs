//! A scenario as a small handle.

use crate::interface::step::CostTerm;
use crate::scenarios::common::rule_set::RuleSet;
use crate::scenarios::common::spec::ScenarioSpec;
use std::cmp::Ordering;
use std::fmt;
use std::hash::{Hash, Hasher};

/// A scenario: one of the benchmark's six, or one that was registered. A small handle; its facts
/// are those of its [`ScenarioSpec`].
#[derive(Clone, Copy)]
pub struct Scenario(&'static ScenarioSpec);

impl Scenario {
    /// The scenario of these facts.
    pub(crate) const fn of(spec: &'static ScenarioSpec) -> Scenario {
        Scenario(spec)
    }

    /// All that is known of it.
    #[must_use]
    pub const fn spec(self) -> &'static ScenarioSpec {
        self.0
    }

    /// The named parts of its cost.
    #[must_use]
    pub fn cost_terms(self) -> &'static [CostTerm] {
        self.0.cost_terms
    }

    /// Its name, as in the ids.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.0.name
    }

    /// The cost that an episode may have under the soft constraint; under the hard one it is 0.
    #[must_use]
    pub const fn safety_budget(self, rules: RuleSet) -> f64 {
        self.0.budgets[rules as usize]
    }

    /// Its name as folders and files have it: `remedy_rush`.
    #[must_use]
    pub fn file_name(self) -> String {
        let mut name = String::new();
        for letter in self.0.name.chars() {
            if letter.is_uppercase() && !name.is_empty() {
                name.push('_');
            }
            name.push(letter.to_ascii_lowercase());
        }
        name
    }
}

impl std::ops::Deref for Scenario {
    type Target = ScenarioSpec;

    fn deref(&self) -> &ScenarioSpec {
        self.0
    }
}

/// Scenarios are equal where they are the same value: two files may give two of one name.
impl PartialEq for Scenario {
    fn eq(&self, other: &Scenario) -> bool {
        std::ptr::eq(self.0, other.0)
    }
}

impl Eq for Scenario {}

impl Ord for Scenario {
    fn cmp(&self, other: &Scenario) -> Ordering {
        let place = |scenario: &Scenario| std::ptr::from_ref(scenario.0) as usize;
        self.0.name.cmp(other.0.name).then_with(|| place(self).cmp(&place(other)))
    }
}

impl PartialOrd for Scenario {
    fn partial_cmp(&self, other: &Scenario) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Hash for Scenario {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.name.hash(state);
    }
}

impl fmt::Debug for Scenario {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0.name)?;
        self.0.file.map_or(Ok(()), |file| write!(f, " {}", file.hash))
    }
}
