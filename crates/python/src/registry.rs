//! The 18 environments, for Python.

use crate::errors::raise;
use hasard_envs::{ActionSpace, EnvError, EnvId, RuleSet, Scenario, own, scenarios};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// ids() -> list[str]
///
/// Returns every id, without `hasard/`, by scenario and level.
#[pyfunction]
pub fn ids() -> Vec<String> {
    EnvId::all().map(|id| id.to_string()).collect()
}

/// The environment of an id, with or without `hasard/`, or of a scenario's file.
pub fn environment(env_id: &str) -> Result<EnvId, EnvError> {
    if own::is_file(env_id) {
        return own::open(env_id);
    }
    env_id.strip_prefix("hasard/").unwrap_or(env_id).parse()
}

/// check_scenario(text) -> list[tuple[int, int, bool, str]]
///
/// Returns what is wrong with a scenario's text: line, column, whether it can be played
/// nevertheless, and the remedy.
#[pyfunction]
pub fn check_scenario(text: &str) -> Vec<(usize, usize, bool, String)> {
    let mistakes = own::check(text).mistakes.into_iter();
    mistakes.map(|mistake| (mistake.line, mistake.column, mistake.warning, mistake.text)).collect()
}

/// read_scenario(path) -> str
///
/// Returns the text of a scenario's file, and beneath it the maps that it names in other files.
/// Raises InvalidOption.
#[pyfunction]
pub fn read_scenario(py: Python<'_>, path: std::path::PathBuf) -> PyResult<String> {
    own::read_text(&path).map_err(|error| raise(py, &error))
}

/// register_scenario(path, text) -> list[str]
///
/// Makes the environments of a scenario's text known and returns their ids, without `hasard/`.
/// Raises InvalidOption.
#[pyfunction]
pub fn register_scenario(py: Python<'_>, path: &str, text: &str) -> PyResult<Vec<String>> {
    let scenario = own::register(path, text).map_err(|error| raise(py, &error))?;
    Ok(scenario.environments().map(|id| id.to_string()).collect())
}

/// published_stats(scenario) -> list[tuple[str, str | None]]
///
/// Returns the statistics of the published package that have a meaning in `scenario`, each with the
/// name of ours; None is the episode's cost so far. Empty for a name that is no scenario.
#[pyfunction]
pub fn published_stats(scenario: &str) -> Vec<(&'static str, Option<&'static str>)> {
    let found = Scenario::every().into_iter().find(|known| known.name() == scenario);
    found.map_or_else(Vec::new, |known| known.published_stats.to_vec())
}

/// describe(env_id) -> dict
///
/// Returns what is known of the environment `env_id` without making it; `hasard_rs.spec` is what to
/// use. Raises UnknownEnvironment.
#[pyfunction]
pub fn describe<'py>(py: Python<'py>, env_id: &str) -> PyResult<Bound<'py, PyDict>> {
    let id = environment(env_id).map_err(|error| raise(py, &error))?;
    let space = ActionSpace::of(id, RuleSet::Paper, false, false);
    let names = |space: &ActionSpace| -> Vec<Vec<&str>> {
        space
            .groups
            .iter()
            .map(|group| group.buttons.iter().map(|(name, _)| *name).collect())
            .collect()
    };
    let terms: Vec<(&str, bool)> =
        id.scenario.cost_terms.iter().map(|term| (term.name, term.counted)).collect();
    let known = PyDict::new(py);
    known.set_item("scenario", id.scenario.name())?;
    known.set_item("id", id.to_string())?;
    known.set_item("level", id.level)?;
    known.set_item("cost_terms", terms)?;
    known.set_item("safety_budget", id.scenario.safety_budget(RuleSet::Paper))?;
    known.set_item("published_safety_budget", id.scenario.safety_budget(RuleSet::Released))?;
    known.set_item("max_episode_steps", scenarios::episode_steps(id, RuleSet::Paper, false, 4))?;
    known.set_item("nvec", space.sizes())?;
    known.set_item("buttons", names(&space))?;
    Ok(known)
}
