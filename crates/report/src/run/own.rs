//! Tasks of one's own in a run's settings: their files' text says what budget is usual for them.

use hasard_envs::{RuleSet, Scenario, own};
use serde_json::Value;

/// A task of one's own that a run was trained on.
pub(super) struct OwnTask {
    path: String,
    scenario: Scenario,
}

impl OwnTask {
    /// The tasks of a run's `env`. A text that this version does not understand is left out: its
    /// runs are reported all the same.
    pub fn all(env: &Value) -> Vec<OwnTask> {
        let several = env["scenario_files"].as_array().map_or(&[][..], Vec::as_slice);
        let files = std::iter::once(&env["scenario_file"]).chain(several);
        let read = files.filter_map(|file| {
            let (path, text) = (file["path"].as_str()?, file["text"].as_str()?);
            let scenario = own::recall(path, text).ok()?;
            Some(OwnTask { path: path.to_owned(), scenario })
        });
        read.collect()
    }

    /// Whether it is the scenario of that name.
    pub fn is(&self, scenario: &str) -> bool {
        self.scenario.name == scenario
    }

    /// Its file's budget.
    pub fn budget(&self, rules: RuleSet) -> f64 {
        self.scenario.safety_budget(rules)
    }

    /// Its scenario's name, and where its file was.
    pub fn named(self) -> (String, String) {
        (self.scenario.name.to_owned(), self.path)
    }
}
