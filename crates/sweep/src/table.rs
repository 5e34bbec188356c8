//! What a table of TOML says of a grid.

use crate::grid::Grid;
use crate::option::OptionValue;
use toml::{Table, Value};

/// The keys of a grid.
pub(crate) const GRID_KEYS: [&str; 7] =
    ["frames", "seeds", "scenarios", "levels", "algorithms", "options", "settings"];

/// Options that are the path of a file or a folder: a number is none, though it is a text elsewhere.
const PLACES: [&str; 2] = ["iwad", "maps"];

/// Puts what a table says into a grid.
pub(crate) fn change(grid: &mut Grid, table: &Table) -> Result<(), String> {
    if let Some(frames) = table.get("frames") {
        grid.frames = frames
            .as_integer()
            .and_then(|n| u64::try_from(n).ok())
            .ok_or("`frames` must be a whole number such as 2_000_000")?;
    }
    if let Some(value) = table.get("seeds") {
        grid.seeds = list(value, "seeds", "whole numbers from 0", |v| {
            v.as_integer().and_then(|n| u64::try_from(n).ok())
        })?;
    }
    if let Some(value) = table.get("levels") {
        grid.levels = levels(value)?;
    }
    if let Some(value) = table.get("scenarios") {
        grid.scenarios = scenarios(value)?;
    }
    if let Some(value) = table.get("algorithms") {
        grid.algorithms = algorithms(value)?;
    }
    if let Some(options) = table.get("options") {
        for (name, value) in options.as_table().ok_or("`options` must be a table")? {
            let values = if PLACES.contains(&name.as_str()) {
                list(value, name, "a path in quotes, or a list of them", place)?
            } else {
                let kind = "a text, number, true or false, or a list of them";
                list(value, name, kind, option_value)?
            };
            match grid.options.iter_mut().find(|(known, _)| known == name) {
                Some((_, known)) => *known = values,
                None => grid.options.push((name.clone(), values)),
            }
        }
    }
    if let Some(settings) = table.get("settings") {
        let settings = settings.as_table().ok_or("`settings` must be a table")?;
        named_settings("", settings, &mut grid.settings)?;
    }
    Ok(())
}

/// Settings by their names in config.json, as `--set` takes them.
fn named_settings(
    within: &str,
    table: &Table,
    found: &mut Vec<(String, String)>,
) -> Result<(), String> {
    for (key, value) in table {
        let name = if within.is_empty() { key.clone() } else { format!("{within}.{key}") };
        if let Value::Table(table) = value {
            named_settings(&name, table, found)?;
        } else {
            // The sweep sets these itself, a run each.
            let own = [
                ("seed", "seeds"),
                ("frames", "frames"),
                ("algorithm", "algorithms"),
                ("preset", "preset under [options]"),
            ];
            if let Some((_, key)) = own.iter().find(|(setting, _)| *setting == name) {
                return Err(format!("`settings.{name}` would be the same for all runs; use {key}"));
            }
            let option = name.strip_prefix("env.").unwrap_or(&name);
            if PLACES.contains(&option) {
                return Err(format!(
                    "`settings.{name}` is an option; use {option} under [options]"
                ));
            }
            let text = setting_value(value).ok_or_else(|| {
                format!("`settings.{name}` must be a text, a number, true, false or a list of them")
            })?;
            found.push((name, text));
        }
    }
    Ok(())
}

fn setting_value(value: &Value) -> Option<String> {
    match value {
        Value::Array(items) => {
            let items: Option<Vec<String>> = items
                .iter()
                .map(|item| match item {
                    Value::String(text) => Some(format!("{text:?}")),
                    other => setting_value(other),
                })
                .collect();
            Some(format!("[{}]", items?.join(",")))
        }
        one => Some(match option_value(one)? {
            OptionValue::Text(text) => text,
            OptionValue::Switch(on) => on.to_string(),
        }),
    }
}

pub(crate) fn scenarios(value: &Value) -> Result<Vec<String>, String> {
    list(value, "scenarios", "names in quotes", |v| v.as_str().map(String::from))
}

pub(crate) fn algorithms(value: &Value) -> Result<Vec<String>, String> {
    list(value, "algorithms", "names in quotes", |v| v.as_str().map(String::from))
}

pub(crate) fn levels(value: &Value) -> Result<Vec<u32>, String> {
    list(value, "levels", "1, 2 or 3", |v| v.as_integer().and_then(|n| u32::try_from(n).ok()))
}

fn place(value: &Value) -> Option<OptionValue> {
    let path = value.as_str().filter(|path| !path.is_empty())?;
    Some(OptionValue::Text(path.to_owned()))
}

pub(crate) fn option_value(value: &Value) -> Option<OptionValue> {
    match value {
        Value::String(text) => Some(OptionValue::Text(text.clone())),
        Value::Integer(number) => Some(OptionValue::Text(number.to_string())),
        Value::Float(number) => Some(OptionValue::Text(number.to_string())),
        Value::Boolean(on) => Some(OptionValue::Switch(*on)),
        _ => None,
    }
}

/// A list, or one value that stands for a list of one.
fn list<T>(
    value: &Value,
    key: &str,
    kind: &str,
    item: impl Fn(&Value) -> Option<T>,
) -> Result<Vec<T>, String> {
    let items = match value {
        Value::Array(items) => items.iter().map(&item).collect::<Option<Vec<T>>>(),
        single => item(single).map(|item| vec![item]),
    };
    items.ok_or_else(|| format!("`{key}` must be {kind}"))
}
