//! The file that describes a sweep, in TOML:
//!
//! ```toml
//! experiment = "main"              # optional: begin with an experiment of the paper and choose from it below
//! out = "runs/main"                # default "runs"
//! parallel = 2                     # runs at a time, default 1; they share the cores
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
//! [settings]                       # settings of config.json, the same for every run: no part of a folder's name
//! learning.products = "bfloat16"
//! evaluation.confirming_episodes = 200
//!
//! [[grid]]                         # optional: several grids, each on top of what stands above
//! algorithms = ["PPOCost"]
//! options.cost-scale = [0.5, 2]
//! settings.learning.rate = 0.0003
//! ```

use crate::grid::{Grid, Sweep};
use crate::one_line;
use crate::paper;
use crate::table::{GRID_KEYS, algorithms, change, levels, scenarios};
use std::path::PathBuf;
use toml::{Table, Value};

const TOP_KEYS: [&str; 5] = ["experiment", "out", "parallel", "evaluate", "grid"];

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
            "unknown key `{key}`; known are {}, {}; options of `hasard train` go under [options]",
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

fn line_and_column(text: &str, at: usize) -> (usize, usize) {
    let before = text.get(..at).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}
