//! The sets of constants that a scenario can follow.

use crate::error::{EnvError, excerpt};

/// Which set of constants a scenario follows; the tables of its page hold all of them.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
pub enum RuleSet {
    /// The paper's text made self-consistent.
    #[default]
    Paper,
    /// What the published package does.
    Released,
    /// What the code did when the paper's tables were made.
    Tables,
}

impl RuleSet {
    /// Every rule set, in the order of the columns of the level tables.
    pub const ALL: [RuleSet; 3] = [RuleSet::Paper, RuleSet::Released, RuleSet::Tables];

    /// Its name, as on the command line and in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        ["paper", "released", "tables"][self as usize]
    }

    /// The names of all, for messages.
    #[must_use]
    pub fn names() -> String {
        RuleSet::ALL.map(RuleSet::name).join(", ")
    }

    /// Whether the hard constraint is played in the worlds that were published for it.
    #[must_use]
    pub const fn plays_published_hard_worlds(self) -> bool {
        [false, true, true][self as usize]
    }
}

impl std::fmt::Display for RuleSet {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}

impl std::str::FromStr for RuleSet {
    type Err = EnvError;

    fn from_str(text: &str) -> Result<RuleSet, EnvError> {
        let wrong = || EnvError::Option {
            option: "rules",
            given: excerpt(text),
            allowed: format!("one of {}", RuleSet::names()),
        };
        RuleSet::ALL.into_iter().find(|rules| rules.name() == text).ok_or_else(wrong)
    }
}
