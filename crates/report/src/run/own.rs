//! What budget is usual for a task: a scenario of the program has its own, a task of the user's has
//! it in its file's text.

use hasard_envs::{RuleSet, Scenario, own};
use serde_json::Value;
use std::collections::BTreeMap;

/// A task of one's own that a run was trained on.
#[derive(Clone, PartialEq, Debug)]
struct OwnTask {
    file: String,
    /// By rule set.
    budgets: [f64; RuleSet::ALL.len()],
}

/// The tasks of one's own that a run was trained on, by the names of their scenarios.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct OwnTasks(BTreeMap<String, OwnTask>);

impl OwnTasks {
    /// The tasks of a run's `env`. A text that this version does not understand is left out: its
    /// runs are reported all the same.
    pub(super) fn read(env: &Value) -> OwnTasks {
        let several = env["scenario_files"].as_array().map_or(&[][..], Vec::as_slice);
        let files = std::iter::once(&env["scenario_file"]).chain(several);
        let read = files.filter_map(|file| {
            let (path, text) = (file["path"].as_str()?, file["text"].as_str()?);
            let scenario = own::recall(path, text).ok()?;
            let budgets = RuleSet::ALL.map(|rules| scenario.safety_budget(rules));
            Some((scenario.name.to_owned(), OwnTask { file: path.to_owned(), budgets }))
        });
        OwnTasks(read.collect())
    }

    /// Where the file of such a scenario was.
    #[must_use]
    pub fn file(&self, scenario: &str) -> Option<&str> {
        self.0.get(scenario).map(|task| task.file.as_str())
    }

    /// The budget of a scenario, one of these or one of the program's.
    #[must_use]
    pub fn budget(&self, scenario: &str, rules: RuleSet) -> f64 {
        let own = self.0.get(scenario).map(|task| task.budgets[rules as usize]);
        own.unwrap_or_else(|| default_budget(scenario, rules))
    }
}

/// The scenario's own budget under the rules; 50 for a scenario that nobody registered.
#[must_use]
pub fn default_budget(scenario: &str, rules: RuleSet) -> f64 {
    let known = Scenario::every().into_iter().find(|known| known.name == scenario);
    known.map_or(50.0, |known| known.safety_budget(rules))
}
