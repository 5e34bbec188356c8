//! The environment that a scenario's file names: `my_task.toml`, or `my_task.toml#2` for its second
//! level.

use super::place::{path_and_level, read_text};
use super::task::register;
use crate::{EnvError, EnvId};
use std::path::Path;

/// Reads and registers the scenario of a file, and gives the environment that `text` names:
/// `my_task.toml` its first level, `my_task.toml#2` its second.
///
/// # Errors
/// One line: the file's first mistake with its line and column, and how many there are.
pub fn open(text: &str) -> Result<EnvId, EnvError> {
    let (path, level) = path_and_level(text);
    let scenario = register(path, &read_text(Path::new(path))?)?;
    let levels = scenario.levels.max(1);
    let level = match level.map(|level| (level, level.parse::<u8>())) {
        None => 1,
        Some((_, Ok(level))) if (1..=levels).contains(&level) => level,
        Some((level, _)) => {
            let shown = crate::error::excerpt(path);
            let level = crate::error::excerpt(level);
            return Err(EnvError::Scenario {
                why: format!("{shown}#{level}: its levels are 1 to {levels}"),
            });
        }
    };
    Ok(EnvId { scenario, level })
}
