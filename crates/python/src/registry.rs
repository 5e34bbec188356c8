//! The 18 environments, told to Python.

use crate::errors::raise;
use hasard_envs::{ActionSpace, EnvId, RuleSet, scenarios};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// ids() -> list[str]
///
/// Returns every id, without `hasard/`, by scenario and level.
#[pyfunction]
pub fn ids() -> Vec<String> {
    EnvId::all().map(|id| id.to_string()).collect()
}

/// describe(env_id) -> dict
///
/// Returns what is known of the environment `env_id` without making it; `hasard_rs.spec` is what to use. Raises UnknownEnvironment.
#[pyfunction]
pub fn describe<'py>(py: Python<'py>, env_id: &str) -> PyResult<Bound<'py, PyDict>> {
    let id: EnvId = env_id.strip_prefix("hasard/").unwrap_or(env_id).parse().map_err(|error| raise(py, &error))?;
    let space = ActionSpace::of(id, RuleSet::Paper, false, false);
    let names = |space: &ActionSpace| -> Vec<Vec<&str>> {
        space.groups.iter().map(|group| group.buttons.iter().map(|(name, _)| *name).collect()).collect()
    };
    let terms: Vec<(&str, bool)> = id.scenario.cost_terms.iter().map(|term| (term.name, term.counted)).collect();
    let told = PyDict::new(py);
    told.set_item("scenario", id.scenario.name())?;
    told.set_item("level", id.level)?;
    told.set_item("cost_terms", terms)?;
    told.set_item("safety_budget", id.scenario.safety_budget(RuleSet::Paper))?;
    told.set_item("published_safety_budget", id.scenario.safety_budget(RuleSet::Released))?;
    told.set_item("max_episode_steps", scenarios::episode_steps(id, RuleSet::Paper, false, 4))?;
    told.set_item("nvec", space.sizes())?;
    told.set_item("buttons", names(&space))?;
    Ok(told)
}
