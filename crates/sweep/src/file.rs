//! The file that describes a sweep, in TOML:
//!
//! ```toml
//! experiment = "main"              # optional: begin with an experiment of the paper and choose from it below
//! out = "runs/main"                # default "runs"
//! parallel = 2                     # runs at a time, default 1; they share the cores out
//! evaluate = 100                   # episodes of each finished run's agent, kept as eval.jsonl; default none
//! frames = 2_000_000               # of each run
//! seeds = [1, 2, 3]                # default [1]
//! scenarios = ["RemedyRush"]       # or whole ids such as "RemedyRushLevel1-v0"
//! levels = [1, 2]                  # default [1]
//! algorithms = ["PPO", "PPOLag"]
//!
//! [options]                        # options of `hasard train`; a list is one more axis of the grid
//! rules = "released"
//! safety-budget = [2.5, 5, 7.5]
//! full-actions = [false, true]
//!
//! [[grid]]                         # optional: several grids, each on top of what stands above
//! algorithms = ["PPOCost"]
//! options.cost-scale = [0.5, 2]
//! ```

use crate::grid::{Grid, Sweep};
use crate::one_line;
use crate::option::OptionValue;
use crate::paper;
use std::path::PathBuf;
use toml::{Table, Value};

const TOP_KEYS: [&str; 5] = ["experiment", "out", "parallel", "evaluate", "grid"];
const GRID_KEYS: [&str; 6] = ["frames", "seeds", "scenarios", "levels", "algorithms", "options"];

impl Sweep {
    /// Understands the text of a sweep file.
    ///
    /// # Errors
    /// One line that names the key, or line and column where it is no TOML.
    pub fn parse(text: &str) -> Result<Sweep, String> {
        understand(text).map_err(|problem| one_line(&problem))
    }

    /// Whether the text of a sweep file says how long runs are; false for what is no sweep file.
    #[must_use]
    pub fn chooses_frames(text: &str) -> bool {
        let Ok(table) = text.parse::<Table>() else { return false };
        let grids = table.get("grid").and_then(Value::as_array);
        table.contains_key("frames")
            || grids.is_some_and(|grids| grids.iter().all(|grid| grid.get("frames").is_some()))
    }
}

fn understand(text: &str) -> Result<Sweep, String> {
    let table: Table = text.parse().map_err(|error: toml::de::Error| {
        let (line, column) = error.span().map_or((1, 1), |span| line_and_column(text, span.start));
        format!("line {line}, column {column}: {}", error.message().replace('\n', " "))
    })?;
    if let Some(key) = table
        .keys()
        .find(|key| !TOP_KEYS.contains(&key.as_str()) && !GRID_KEYS.contains(&key.as_str()))
    {
        return Err(format!(
            "unknown key `{key}`; known are {}, {}",
            TOP_KEYS.join(", "),
            GRID_KEYS.join(", ")
        ));
    }
    let mut sweep = match table.get("experiment") {
        None => {
            let grid = Grid { levels: vec![1], seeds: vec![1], ..Grid::default() };
            Sweep { out: PathBuf::from("runs"), parallel: 1, evaluate: 0, grids: vec![grid] }
        }
        Some(name) => {
            paper::experiment(name.as_str().ok_or("`experiment` must be a name in quotes")?)?
        }
    };
    if let Some(out) = table.get("out") {
        sweep.out = PathBuf::from(
            out.as_str().filter(|out| !out.is_empty()).ok_or("`out` must be a path in quotes")?,
        );
    }
    if let Some(parallel) = table.get("parallel") {
        let count = parallel
            .as_integer()
            .and_then(|count| usize::try_from(count).ok())
            .filter(|count| (1..=4096).contains(count));
        sweep.parallel = count.ok_or("`parallel` must be a whole number from 1 to 4096")?;
    }
    if let Some(evaluate) = table.get("evaluate") {
        let count = evaluate.as_integer().and_then(|count| u32::try_from(count).ok());
        sweep.evaluate = count.ok_or("`evaluate` must be a whole number of episodes from 0")?;
    }
    let mut rest = table.clone();
    if table.contains_key("experiment") {
        // Of an experiment, lists choose what is run.
        if let Some(value) = rest.remove("scenarios") {
            sweep.restrict_scenarios(&scenarios(&value)?);
        }
        if let Some(value) = rest.remove("levels") {
            sweep.restrict_levels(&levels(&value)?);
        }
        if let Some(value) = rest.remove("algorithms") {
            sweep.restrict_algorithms(&algorithms(&value)?);
        }
    }
    for grid in &mut sweep.grids {
        change(grid, &rest)?;
    }
    if let Some(grids) = table.get("grid") {
        let grids = grids.as_array().ok_or("`grid` must be written as [[grid]]")?;
        let bases = std::mem::take(&mut sweep.grids);
        for (index, table) in grids.iter().enumerate() {
            let named = |problem: String| format!("grid {}: {problem}", index + 1);
            let table = table.as_table().ok_or("`grid` must be written as [[grid]]")?;
            if let Some(key) = table.keys().find(|key| !GRID_KEYS.contains(&key.as_str())) {
                return Err(named(format!(
                    "unknown key `{key}`; known are {}",
                    GRID_KEYS.join(", ")
                )));
            }
            for base in &bases {
                let mut grid = base.clone();
                change(&mut grid, table).map_err(named)?;
                sweep.grids.push(grid);
            }
        }
    }
    Ok(sweep)
}

/// Puts what a table says into a grid.
fn change(grid: &mut Grid, table: &Table) -> Result<(), String> {
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
            let values = list(
                value,
                name,
                "a text, number, true or false, or a list of them",
                option_value,
            )?;
            match grid.options.iter_mut().find(|(known, _)| known == name) {
                Some((_, known)) => *known = values,
                None => grid.options.push((name.clone(), values)),
            }
        }
    }
    Ok(())
}

fn scenarios(value: &Value) -> Result<Vec<String>, String> {
    list(value, "scenarios", "names in quotes", |v| v.as_str().map(String::from))
}

fn algorithms(value: &Value) -> Result<Vec<String>, String> {
    list(value, "algorithms", "names in quotes", |v| v.as_str().map(String::from))
}

fn levels(value: &Value) -> Result<Vec<u32>, String> {
    list(value, "levels", "1, 2 or 3", |v| v.as_integer().and_then(|n| u32::try_from(n).ok()))
}

fn option_value(value: &Value) -> Option<OptionValue> {
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

fn line_and_column(text: &str, at: usize) -> (usize, usize) {
    let before = text.get(..at).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}
