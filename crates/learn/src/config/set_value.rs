//! A setting's new value, as it was typed: how it is read, and why it is refused.

use serde_json::Value;

use crate::config::TrainConfig;
use crate::error::LearnError;

/// Settings that are written only where they are on.
const WRITTEN_WHEN_ON: [&str; 3] =
    ["env.early_creatures", "env.published_depth", "env.published_colours"];

/// Places that options name: they make them whole before a run keeps them.
const PLACES: [(&str, &str); 2] = [("env.maps", "--maps"), ("env.iwad", "--iwad")];

/// Whole numbers up to here are the same in double precision.
const WHOLE: f64 = (1u64 << 53) as f64;

/// Letters of a value that a message repeats.
const REPEATED: usize = 60;

/// Where a setting such as `learning.rate` stands in `config.json`, as a JSON pointer.
#[must_use]
pub fn setting_pointer(name: &str) -> String {
    format!("/{}", name.replace('.', "/"))
}

fn wrong(problem: String) -> LearnError {
    LearnError::Config(problem)
}

/// All settings as JSON, with a place for the one of this name if it may be left out.
pub(super) fn with_place(config: &TrainConfig, name: &str) -> Result<Value, LearnError> {
    let mut all = serde_json::to_value(config).map_err(|error| wrong(error.to_string()))?;
    let is_written = all.pointer(&setting_pointer(name)).is_some();
    if let Some((_, option)) = PLACES.iter().find(|(place, _)| *place == name)
        && !is_written
    {
        return Err(wrong(format!("'{name}' has an option of its own; use {option}")));
    }
    if WRITTEN_WHEN_ON.contains(&name)
        && !is_written
        && let Some((group, last)) = name.split_once('.')
    {
        all[group][last] = Value::Bool(false);
    }
    Ok(all)
}

/// A value as users type it: JSON, or a text without quotes.
pub(super) fn value(given: &str) -> Value {
    let mut value = serde_json::from_str(given).unwrap_or_else(|_| given.into());
    make_whole(&mut value);
    value
}

/// Writes 1e6 as 1000000, which whole numbers are read from.
fn make_whole(value: &mut Value) {
    match value {
        Value::Number(number) if number.is_f64() => {
            if let Some(float) = number.as_f64().filter(|float| float.fract() == 0.0)
                && float.abs() <= WHOLE
            {
                *value = Value::from(float as i64);
            }
        }
        Value::Array(all) => all.iter_mut().for_each(make_whole),
        Value::Object(all) => all.values_mut().for_each(make_whole),
        _ => {}
    }
}

/// Refuses keys that were given and that no setting has: serde passes over them.
pub(super) fn check_keys(name: &str, given: &Value, kept: &Value) -> Result<(), LearnError> {
    match (given, kept) {
        (Value::Array(given), Value::Array(kept)) => {
            given.iter().zip(kept).try_for_each(|(given, kept)| check_keys(name, given, kept))
        }
        (Value::Object(given), Value::Object(kept)) => {
            given.iter().try_for_each(|(key, inner)| match kept.get(key) {
                Some(kept) => check_keys(name, inner, kept),
                None => {
                    let known: Vec<&str> = kept.keys().map(String::as_str).collect();
                    let known = known.join(", ");
                    Err(wrong(format!("{name} has no '{key}'; it has {known}")))
                }
            })
        }
        _ => Ok(()),
    }
}

/// Why a value cannot be read as a setting, in the words of the other refusals; `was` is the value
/// before it.
pub(super) fn refused(
    name: &str,
    given: &str,
    was: &Value,
    error: &serde_json::Error,
) -> LearnError {
    let error = error.to_string();
    let mut shown: String = given.chars().take(REPEATED).collect();
    if shown.len() < given.len() {
        shown.push_str("...");
    }
    if let Some(field) = error.strip_prefix("missing field ") {
        let field = field.replace('`', "'");
        let remedy = match was {
            Value::Object(_) => "set its parts one by one, or give all",
            _ => "add it",
        };
        return wrong(format!("{name} cannot be '{shown}'; {field} is missing in it: {remedy}"));
    }
    let Some((found, expected)) = error.split_once(", expected ") else {
        return wrong(format!("{name} cannot be '{shown}'; {error}"));
    };
    let allowed = match was {
        Value::Object(parts) if expected.starts_with("struct ") => {
            let part = parts.keys().next().map_or("", String::as_str);
            format!("set by its parts, such as {name}.{part}=VALUE")
        }
        Value::Array(entries) if expected == "a sequence" => match entries.first() {
            Some(entry) => format!("a list such as [{entry}]"),
            None => "a list in brackets; `hasard settings` says of what".into(),
        },
        _ => in_words(expected),
    };
    // What is wrong within a list, and not the list.
    let inner = ["invalid type: ", "invalid value: ", "unknown variant "]
        .iter()
        .find_map(|start| found.strip_prefix(start))
        .filter(|found| given.starts_with('[') && !found.starts_with("sequence"));
    let it = inner.map_or("it".to_string(), |found| format!("in it, {}", found.replace('`', "")));
    wrong(format!("{name} cannot be '{shown}'; {it} must be {allowed}"))
}

/// What serde expects, as users call it.
fn in_words(expected: &str) -> String {
    let most = match expected {
        "f64" => return "a number".into(),
        "usize" | "u64" => return "a whole number of at least 0".into(),
        "a boolean" => return "true or false".into(),
        "a string" | "string or map" => return "a text".into(),
        "a sequence" => return "a list such as [32]".into(),
        "fewer elements in array" => return "a shorter list".into(),
        "u32" => u32::MAX,
        "u16" => u16::MAX.into(),
        "u8" => u8::MAX.into(),
        _ if expected.starts_with("struct ") => return "an object as in config.json".into(),
        _ => {
            return match expected.strip_prefix("a tuple of size ") {
                Some(size) => format!("a list of {size} numbers"),
                None => expected.replace('`', ""),
            };
        }
    };
    format!("a whole number from 0 to {most}")
}

#[cfg(test)]
mod tests {
    use crate::config::{AlgorithmKind, EnvConfig, Preset, TrainConfig};

    fn set(setting: &str) -> Result<TrainConfig, String> {
        let env = EnvConfig::new("VolcanicVentureLevel1-v0");
        let config = TrainConfig::new(AlgorithmKind::PpoLag, Preset::Quick, env).unwrap();
        config.with(setting).map_err(|error| error.to_string())
    }

    #[test]
    fn values_of_another_kind_are_refused_in_plain_words() {
        for (setting, message) in [
            ("learning.rate=nan", "learning.rate cannot be 'nan'; it must be a number"),
            ("frames=-5", "frames cannot be '-5'; it must be a whole number of at least 0"),
            ("frames=1.5", "frames cannot be '1.5'; it must be a whole number of at least 0"),
            (
                "learning.portable=maybe",
                "learning.portable cannot be 'maybe'; it must be true or false",
            ),
            ("network.dense=32", "network.dense cannot be '32'; it must be a list such as [256]"),
            (
                "network.convolutions=32@4/4",
                "network.convolutions cannot be '32@4/4'; it must be a list such as \
                 [{\"channels\":32,\"kernel\":8,\"stride\":6}]",
            ),
            (
                "learning.critic_inputs=in-view",
                "learning.critic_inputs cannot be 'in-view'; it must be a list in brackets; `hasard settings` says of what",
            ),
            (
                "network.dense=[32,\"a\"]",
                "network.dense cannot be '[32,\"a\"]'; in it, string \"a\" must be a whole number of at least 0",
            ),
            (
                "env.size=[70000,9]",
                "env.size cannot be '[70000,9]'; in it, integer 70000 must be a whole number from 0 to 65535",
            ),
            (
                "algorithm_settings.pid_gains=[1,2]",
                "algorithm_settings.pid_gains cannot be '[1,2]'; it must be a list of 3 numbers",
            ),
            ("network.cell=elman", "network.cell cannot be 'elman'; it must be gru or lstm"),
            (
                "constraints=[{\"term\":\"lava\"}]",
                "constraints cannot be '[{\"term\":\"lava\"}]'; 'budget' is missing in it: add it",
            ),
        ] {
            assert_eq!(set(setting).unwrap_err(), message, "{setting}");
        }
        let group = set("learning=fast").unwrap_err();
        assert!(group.contains("set by its parts, such as learning."), "{group}");
        let long = set(&format!("learning.rate={}", "x".repeat(900))).unwrap_err();
        assert!(long.len() < 130, "{long}");
    }

    #[test]
    fn whole_numbers_may_be_written_with_an_exponent() {
        assert_eq!(set("frames=1e6").unwrap().frames, 1_000_000);
        assert_eq!(set("network.dense=[3.2e1]").unwrap().network.dense, [32]);
        assert_eq!(set("learning.recurrence=8.0").unwrap().learning.recurrence, Some(8));
        assert_eq!(set("learning.clip_value=1e300").unwrap().learning.clip_value, 1e300);
    }

    /// They were dropped in silence.
    #[test]
    fn keys_that_no_setting_has_are_refused() {
        for (setting, key) in [
            (
                "network.convolutions=[{\"channels\":32,\"kernel\":3,\"stride\":2,\"pad\":1}]",
                "network.convolutions has no 'pad'; it has ",
            ),
            (
                "constraints=[{\"term\":\"lava\",\"budget\":1},{\"term\":\"jumps\",\"budget\":1,\"bugdet\":3}]",
                "constraints has no 'bugdet'; it has ",
            ),
        ] {
            let message = set(setting).unwrap_err();
            assert!(message.starts_with(key) && message.len() > key.len(), "{message}");
        }
        set("constraints=[{\"term\":\"lava\",\"budget\":1}]").unwrap();
        set("constraints=[{\"budget\":1}]").unwrap();
    }

    /// "There is no setting 'env.maps'; did you mean env.maps?"
    #[test]
    fn settings_that_files_leave_out_are_found() {
        assert!(set("env.early_creatures=true").unwrap().env.early_creatures);
        assert!(set("env/published_depth=true").unwrap().env.published_depth);
        assert!(set("env.published_colours=true").unwrap().env.published_colours);
        for (setting, option) in [("env.maps=/x", "--maps"), ("env.iwad=/x", "--iwad")] {
            let message = set(setting).unwrap_err();
            assert!(message.contains(&format!("use {option}")), "{message}");
        }
        for one in crate::config::explained::settings() {
            let message = set(&format!("{}=@", one.name)).err().unwrap_or_default();
            assert!(!message.contains("there is no setting"), "{message}");
        }
    }
}
