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

impl TrainConfig {
    /// Replaces one setting, named as in `config.json`: `learning.rate=0.0003`. A new learning rate
    /// is a constant one, unless `learning.final_rate` is set after it; for lanes see
    /// [`TrainConfig::set_lanes`].
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
        match name.as_str() {
            "learning.rate" => config.learning.final_rate = None,
            "sampling.lanes" => config.set_lanes(config.sampling.lanes),
            _ => {}
        }
        Ok(config)
    }

    /// Replaces several settings, in whatever order they are given.
    ///
    /// # Errors
    /// As [`TrainConfig::with`]; the message names the setting.
    pub fn with_all(&self, settings: &[String]) -> Result<TrainConfig, LearnError> {
        // First those that decide others too: these may be among the rest.
        let (first, then): (Vec<&String>, Vec<&String>) = settings.iter().partition(|setting| {
            let name = setting.split('=').next().unwrap_or_default().replace('/', ".");
            ["learning.rate", "sampling.lanes"].contains(&name.as_str())
        });
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
        for (setting, from, to) in changes {
            if !may_change(&setting) {
                return Err(LearnError::Config(format!(
                    "'{setting}' is {from} in this run and cannot become {to} within it; begin another with --init-from"
                )));
            }
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
    /// of each; those of the machine, of reports and evaluations, and the length do not count. Of a
    /// run that was changed on its way nothing is said.
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
        let mut found = Vec::new();
        if let (true, Ok(own), Ok(others)) = (
            self.changes.is_empty() && other.changes.is_empty(),
            serde_json::to_value(self),
            serde_json::to_value(other),
        ) {
            differences("", &own, &others, &mut found);
        }
        found.retain(|(name, ..)| name != "version" && !machine(name));
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
mod tests {
    use super::*;
    use crate::config::{AlgorithmKind, EnvConfig, Preset, RecurrentCell};

    fn config(preset: Preset) -> TrainConfig {
        TrainConfig::new(AlgorithmKind::PpoLag, preset, EnvConfig::new("RemedyRushLevel1-v0"))
            .unwrap()
    }

    fn all(settings: &[&str]) -> Vec<String> {
        settings.iter().map(|setting| (*setting).to_string()).collect()
    }

    #[test]
    fn runs_are_unlike_by_what_they_learn_with() {
        let one = config(Preset::Quick);
        let with = |settings: &[&str]| one.with_all(&all(settings)).unwrap();
        assert_eq!(one.unlike(&one), None);
        assert_eq!(
            one.unlike(&with(&["frames=99", "learning.threads=7", "evaluation.episodes=3"])),
            None
        );
        let (name, ..) = one.unlike(&with(&["reporting.window=7", "reporting.keep=7"])).unwrap();
        assert_eq!(name, "reporting.window");
        let other = with(&["learning.gamma=0.5"]);
        let (name, own, others) = one.unlike(&other).unwrap();
        assert_eq!((name.as_str(), own, others), ("learning.gamma", 0.97.into(), 0.5.into()));
    }

    #[test]
    fn a_learning_rate_without_an_end_is_constant() {
        for preset in [Preset::Paper, Preset::Quick] {
            let rates = |settings: &[&str]| {
                let learning = config(preset).with_all(&all(settings)).unwrap().learning;
                [learning.rate_after(0.0), learning.rate_after(0.5), learning.rate_after(1.0)]
            };
            assert_eq!(rates(&["learning.rate=1e-5"]), [1e-5; 3], "{preset}");
            for order in [
                ["learning.rate=4e-4", "learning.final_rate=2e-4"],
                ["learning.final_rate=2e-4", "learning.rate=4e-4"],
            ] {
                let [first, middle, last] = rates(&order);
                assert_eq!((first, last), (4e-4, 2e-4), "{preset}");
                assert!((middle - 3e-4).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn what_others_hang_on_is_not_set_alone() {
        for (setting, instead) in [
            ("env.frame_skip=2", "--frame-skip"),
            ("env.rules=released", "--rules"),
            ("preset=quick", "--preset"),
            ("algorithm=PPO", "--algo"),
            ("env/hard=true", "--hard"),
            ("env={}", "set the parts"),
        ] {
            let message = config(Preset::Paper).with(setting).unwrap_err().to_string();
            assert!(
                message.contains(instead) && message.contains("hang on"),
                "{setting}: {message}"
            );
        }
        assert_eq!(config(Preset::Paper).with("env.frame_stack=2").unwrap().env.frame_stack, 2);
    }

    #[test]
    fn settings_that_few_change_have_names_too() {
        let base = config(Preset::Paper);
        assert!(base.with("learning.reuse_forward=true").unwrap().learning.reuse_forward);
        assert!(base.with("learning.portable=true").unwrap().learning.portable);
        assert_eq!(base.with("network.cell=lstm").unwrap().network.cell, RecurrentCell::Lstm);
        let message = base.with("network.cell=elman").unwrap_err().to_string();
        assert!(message.contains("elman") && message.contains("lstm"), "{message}");
    }

    #[test]
    fn changes_of_a_resumed_run_are_written_down() {
        let config = config(Preset::Quick);
        let changed = config
            .resumed_with(&all(&["seed=9", "learning.rate=1e-4", "frames=5000000"]), 4096)
            .unwrap();
        let changes: Vec<String> = changed
            .changes
            .iter()
            .map(|one| format!("{} {} {}", one.setting, one.from, one.to))
            .collect();
        assert_eq!(
            changes,
            [
                "frames 10000000 5000000",
                "learning.final_rate 0.0001 null",
                "learning.rate 0.0005 0.0001",
                "seed 1 9"
            ]
        );
        assert!(changed.reseeded_at(4096) && !changed.reseeded_at(8192));
        // Asked for once more, nothing is new; and a run that falls back to an older checkpoint
        // changes there.
        let again = changed.resumed_with(&all(&["seed=9"]), 2048).unwrap();
        assert_eq!(again.changes.len(), 4);
        assert!(again.changes.iter().all(|one| one.frames == 2048));
        assert!(
            changed
                .resumed_with(&all(&["learning.threads=3", "reporting.keep=5"]), 9000)
                .unwrap()
                .changes
                .len()
                == 4
        );
        let message = changed.resumed_with(&all(&["frames=4096"]), 8192).unwrap_err().to_string();
        assert!(message.contains("4096") && message.contains("8192"), "{message}");
        assert!(
            changed.resumed_with(&all(&["frames=5000000"]), 5_001_216).is_ok(),
            "it ended with its last rollout"
        );
        let message =
            config.resumed_with(&all(&["learning.gamma=0.9"]), 0).unwrap_err().to_string();
        assert!(message.contains("learning.gamma") && message.contains("--init-from"), "{message}");
    }
    /// A13: rates and the multiplier's speed hang on frames. Gone on with for twice as long, a run
    /// neither jumps back in its schedule nor stretches it, and says that it was extended.
    #[test]
    fn an_extended_run_keeps_its_schedule() {
        let config = config(Preset::Quick);
        let rate =
            |config: &TrainConfig, frames: u64| config.learning.rate_after(config.progress(frames));
        let begun = config.clone().begun();
        assert_eq!(begun.learning.schedule_frames, Some(10_000_000));
        // From 5e-4 to 1e-4 within 10 million frames.
        assert!((rate(&begun, 5_000_000) - 3e-4).abs() < 1e-15);
        for run in [&begun, &config] {
            let longer = run.resumed_with(&all(&["frames=20000000"]), 5_000_000).unwrap();
            for frames in [5_000_000, 7_500_000, 10_000_000] {
                assert_eq!(rate(&longer, frames), rate(&begun, frames));
            }
            assert!(
                (rate(&longer, 20_000_000) - 1e-4).abs() < 1e-15
                    && longer.progress(20_000_000) == 1.0
            );
            assert_eq!((longer.extended_from(), run.extended_from()), (Some(10_000_000), None));
            let changes: Vec<&str> =
                longer.changes.iter().map(|change| change.setting.as_str()).collect();
            assert_eq!(changes, ["frames"]);
        }
        let shorter = begun.resumed_with(&all(&["frames=7000000"]), 5_000_000).unwrap();
        assert_eq!(
            (shorter.extended_from(), rate(&shorter, 5_000_000)),
            (None, rate(&begun, 5_000_000))
        );
        // Who wants another schedule says so, and that is written down too.
        let stretched = begun
            .resumed_with(
                &all(&["frames=20000000", "learning.schedule_frames=20000000"]),
                5_000_000,
            )
            .unwrap();
        assert_eq!((stretched.progress(5_000_000), stretched.changes.len()), (0.25, 2));
        assert_eq!(
            config.with("learning.schedule_frames=400").unwrap().begun().learning.schedule_frames,
            Some(400)
        );
    }
}
