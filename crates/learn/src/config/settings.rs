//! Single settings by their names in `config.json`: replaced when a run begins, and when it goes
//! on.

use serde_json::Value;

use crate::config::change::Change;
use crate::config::explained;
use crate::config::set_value;
pub use crate::config::set_value::setting_pointer;
use crate::config::train_config::TrainConfig;
use crate::error::LearnError;

/// Settings that others hang on, and what to use instead: it brings those along.
const OTHERS_HANG_ON: [(&str, &str); 12] = [
    ("version", "the program of that version"),
    ("algorithm", "--algo"),
    ("preset", "--preset"),
    ("env.id", "the environment's id"),
    ("env.scenario_file", "the scenario's file in place of an id"),
    ("env.scenario_files", "the scenarios' files in place of ids"),
    ("env.rules", "--rules"),
    ("env.hard", "--hard"),
    ("env.frame_skip", "--frame-skip"),
    ("init_from.sha256", "--init-from"),
    ("curriculum", "--curriculum"),
    ("changes", "--resume, which writes them down"),
];

/// What a setting decides beside itself.
type Decide = fn(&mut TrainConfig);

/// Settings that decide others too, and how.
const DECIDE_OTHERS: [(&str, Decide); 4] = [
    ("learning.rate", |config| config.learning.final_rate = None),
    ("learning.gamma", |config| config.learning.final_gamma = None),
    ("learning.gae_lambda", |config| config.learning.final_gae_lambda = None),
    ("sampling.lanes", |config| config.set_lanes(config.sampling.lanes)),
];

/// Settings, or groups of them, that a run may be resumed with another value of: what was learned
/// so far stays of use.
const MAY_CHANGE: [&str; 17] = [
    "frames",
    "seed",
    "device",
    // The same files at another place.
    "env.maps",
    "env.iwad",
    "init_from.place",
    "learning.rate",
    "learning.final_rate",
    "learning.schedule_frames",
    "learning.max_gradient_norm",
    "learning.exploration_coefficient",
    "learning.threads",
    "sampling.samplers",
    "sampling.world_threads",
    "sampling.groups",
    "evaluation",
    "reporting",
];

/// Those of them that change nothing that is learned.
const CHANGE_NOTHING: [&str; 9] = [
    "learning.threads",
    "sampling.samplers",
    "sampling.world_threads",
    "sampling.groups",
    "evaluation",
    "init_from.place",
    // Not its window: how costs scatter over it is what a margin takes off a budget.
    "reporting.report_seconds",
    "reporting.checkpoint_seconds",
    "reporting.keep",
];

/// Whether a setting is of a group, or is it.
fn within(name: &str, group: &str) -> bool {
    name.strip_prefix(group).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

fn wrong(error: impl std::fmt::Display) -> LearnError {
    LearnError::Config(error.to_string())
}

/// The name in `NAME=VALUE`, with dots between its parts.
fn name_in(setting: &str) -> String {
    setting.split('=').next().unwrap_or_default().replace('/', ".")
}

impl TrainConfig {
    /// Replaces one setting, named as in `config.json`: `learning.rate=0.0003`. A new learning rate
    /// is a constant one, unless `learning.final_rate` is set after it, and so for `learning.gamma`
    /// and `learning.gae_lambda`; for lanes see [`TrainConfig::set_lanes`].
    ///
    /// # Errors
    /// When the text is no `NAME=VALUE`, or there is no such setting, or others hang on it, or it
    /// cannot have that value.
    pub fn with(&self, setting: &str) -> Result<TrainConfig, LearnError> {
        let (name, given) = setting.split_once('=').ok_or_else(|| {
            LearnError::Config("write NAME=VALUE, such as learning.rate=0.0003".into())
        })?;
        let name = name.replace('/', ".");
        if let Some((_, instead)) =
            OTHERS_HANG_ON.iter().find(|(known, _)| within(&name, known) || within(known, &name))
        {
            let problem = format!(
                "other settings hang on '{name}'; use {instead}, or set the parts that nothing hangs on"
            );
            return Err(LearnError::Config(problem));
        }
        let mut all = set_value::with_place(self, &name)?;
        let pointer = setting_pointer(&name);
        let place = all.pointer_mut(&pointer).ok_or_else(|| {
            let near = explained::nearest(&name)
                .map_or_else(String::new, |near| format!("; did you mean {near}?"));
            LearnError::Config(format!(
                "there is no setting '{name}'{near} (`hasard settings` lists them)"
            ))
        })?;
        let value = set_value::value(given);
        let was = std::mem::replace(place, value.clone());
        let mut config: TrainConfig = serde_json::from_value(all)
            .map_err(|error| set_value::refused(&name, given, &was, &error))?;
        let all = serde_json::to_value(&config).map_err(wrong)?;
        if let Some(kept) = all.pointer(&pointer) {
            set_value::check_keys(&name, &value, kept)?;
        }
        for (_, decide) in DECIDE_OTHERS.iter().filter(|(known, _)| *known == name) {
            decide(&mut config);
        }
        Ok(config)
    }

    /// Replaces several settings, in whatever order they are given.
    ///
    /// # Errors
    /// As [`TrainConfig::with`]; the message names the setting.
    pub fn with_all(&self, settings: &[String]) -> Result<TrainConfig, LearnError> {
        // First those that decide others too: these may be among the rest.
        let (first, then): (Vec<&String>, Vec<&String>) = settings
            .iter()
            .partition(|setting| DECIDE_OTHERS.iter().any(|(known, _)| *known == name_in(setting)));
        first.into_iter().chain(then).try_fold(self.clone(), |config, setting| {
            config
                .with(setting)
                .map_err(|error| LearnError::Config(format!("'{setting}': {error}")))
        })
    }

    /// The settings with which a run goes on after `frames` frames. What changes is written down in
    /// them.
    ///
    /// # Errors
    /// As [`TrainConfig::with_all`], and when a setting cannot change within a run.
    pub fn resumed_with(
        &self,
        settings: &[String],
        frames: u64,
    ) -> Result<TrainConfig, LearnError> {
        // An older version's run knows no length of its schedules. It keeps to its own products.
        let before = self.clone().scheduled();
        let mut config = before.with_all(settings)?;
        if config.frames != self.frames && config.frames < frames {
            return Err(LearnError::Config(format!(
                "frames = {} is less than the {frames} that the run has made; give more to go on, or leave it out",
                config.frames
            )));
        }
        let (before, after) = (
            serde_json::to_value(&before).map_err(wrong)?,
            serde_json::to_value(&config).map_err(wrong)?,
        );
        let mut changes = Vec::new();
        differences("", &before, &after, &mut changes);
        // What was asked for is refused by its name, before what hangs on it.
        let asked = |setting: &str| settings.iter().any(|one| name_in(one) == setting);
        let fixed = changes.iter().filter(|(setting, ..)| !may_change(setting));
        if let Some((setting, from, to)) = fixed.min_by_key(|(setting, ..)| !asked(setting)) {
            return Err(LearnError::Config(format!(
                "'{setting}' is {from} in this run and cannot become {to} within it; begin another with --init-from"
            )));
        }
        for (setting, from, to) in changes {
            if !CHANGE_NOTHING.iter().any(|group| within(&setting, group)) {
                config.changes.push(Change { frames, setting, from, to });
            }
        }
        // A run that went back to an older checkpoint goes on from there with what was changed
        // later.
        config.changes.iter_mut().for_each(|change| change.frames = change.frames.min(frames));
        config.check()?;
        Ok(config)
    }

    /// The first setting that two runs of the same seed have learned by differently, with the value
    /// of each; those of the machine, of reports and evaluations, the length, and what was changed on
    /// the way of either do not count.
    #[must_use]
    pub fn unlike(&self, other: &TrainConfig) -> Option<(String, Value, Value)> {
        self.all_unlike(other).into_iter().next()
    }

    /// All such settings.
    #[must_use]
    pub fn all_unlike(&self, other: &TrainConfig) -> Vec<(String, Value, Value)> {
        let elsewhere = ["frames", "device", "env.maps", "env.iwad", "learning.schedule_frames"];
        let machine =
            |name: &str| CHANGE_NOTHING.iter().chain(&elsewhere).any(|group| within(name, group));
        let changed = |name: &str| {
            let mut changes = self.changes.iter().chain(&other.changes);
            changes.any(|change| within(name, &change.setting) || within(&change.setting, name))
        };
        let mut found = Vec::new();
        if let (Ok(own), Ok(others)) = (serde_json::to_value(self), serde_json::to_value(other)) {
            differences("", &own, &others, &mut found);
        }
        found.retain(|(name, ..)| {
            !["version", "changes"].contains(&name.as_str()) && !machine(name) && !changed(name)
        });
        found
    }

    /// Whether the run has had another seed since exactly `frames` frames.
    #[must_use]
    pub fn reseeded_at(&self, frames: u64) -> bool {
        self.changes.iter().any(|change| change.setting == "seed" && change.frames == frames)
    }
}

/// Whether a run may be resumed with another value of a setting.
#[must_use]
pub fn may_change(setting: &str) -> bool {
    MAY_CHANGE.iter().any(|group| within(setting, group))
}

/// Names of the leaves that differ, with both values.
fn differences(name: &str, before: &Value, after: &Value, out: &mut Vec<(String, Value, Value)>) {
    match (before, after) {
        (Value::Object(old), Value::Object(new)) => {
            for key in old.keys().chain(new.keys().filter(|key| !old.contains_key(*key))) {
                let inner = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
                differences(
                    &inner,
                    old.get(key).unwrap_or(&Value::Null),
                    new.get(key).unwrap_or(&Value::Null),
                    out,
                );
            }
        }
        _ if before == after => {}
        _ => out.push((name.to_string(), before.clone(), after.clone())),
    }
}

#[cfg(test)]
mod tests;
