//! `hasard settings`: every setting of a run, its value in a preset, and what it means.

use super::train_settings::rules_of;
use crate::args::SettingsArgs;
use crate::failure::{Failure, Outcome};
use hasard_envs::RuleSet;
use hasard_learn::config::explained::settings;
use hasard_learn::config::settings::setting_pointer;
use hasard_learn::config::{EnvConfig, TrainConfig};
use serde_json::json;

/// Runs the command.
pub fn run(args: &SettingsArgs) -> Outcome {
    let (algorithm, preset) =
        (args.algo.parse().map_err(Failure::bad)?, args.preset.parse().map_err(Failure::bad)?);
    let mut env = EnvConfig::new(&args.env);
    if let Some(rules) = rules_of(preset) {
        env.rules = RuleSet::from(rules).name().into();
    }
    let config = TrainConfig::new(algorithm, preset, env).map_err(Failure::bad)?;
    let written = serde_json::to_value(config).map_err(Failure::bad)?;
    for one in settings() {
        // Groups are listed by their parts; what a run seldom has is not written.
        let value = written.pointer(&setting_pointer(&one.name));
        if value.is_some_and(serde_json::Value::is_object) {
            continue;
        }
        if args.json {
            say!("{}", json!({ "name": one.name, "value": value, "meaning": one.meaning }));
        } else {
            let value = value.map_or_else(|| "-".to_string(), ToString::to_string);
            say!("{} = {value}\n    {}", one.name, one.meaning);
        }
    }
    Ok(())
}
