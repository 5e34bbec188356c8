//! What a step of worlds brought, as arrays.

use crate::pool::{Pool, array, pooled};
use hasard_envs::Episode;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::sync::Arc;

/// What a reset or a step brought, one row a lane. Attributes only.
///
/// Attributes:
///     observations: uint8 [m, *observation_shape].
///     rewards, costs: float32 [m], of the step.
///     cost_terms: float32 [m, k], in the order of `Worlds.cost_terms`.
///     statistics: float64 [m, s], in the order of `Worlds.statistics`, where they were asked for.
///     positions: int32 [m, 2], map units, at the end of the step and before any reset.
///     terminated, truncated: bool [m].
///     lanes: int32 [m], the lane of each row.
///     final_lanes: int32 [f], the lanes whose episode ended and whose last observations are in
///         final_observations.
///     final_observations: uint8 [f, *observation_shape].
///     events: what happened in the step, lane after lane, where it was asked for: a structured
///         array [e] of tic, kind, what, by, player, cause, x, y, amount; see `hasard_rs.Event`.
///     event_offsets: int64 [m + 1], where the events of each row begin, and the last one's end.
///     episodes: for each episode that ended a dict: lane, seed, return, cost, length (steps),
///         terminated, truncated, costs (by term), statistics (by name).
#[pyclass(frozen, get_all, module = "hasard_rs._core")]
pub struct Batch {
    observations: Py<PyAny>,
    rewards: Py<PyAny>,
    costs: Py<PyAny>,
    cost_terms: Py<PyAny>,
    statistics: Py<PyAny>,
    positions: Py<PyAny>,
    terminated: Py<PyAny>,
    truncated: Py<PyAny>,
    lanes: Py<PyAny>,
    final_lanes: Py<PyAny>,
    final_observations: Py<PyAny>,
    events: Py<PyAny>,
    event_offsets: Py<PyAny>,
    episodes: Py<PyAny>,
}

/// Arrays of the caller's that a batch was written to: they are what it shows.
#[derive(Default)]
pub struct Arrays {
    pub observations: Option<Py<PyAny>>,
    pub rewards: Option<Py<PyAny>>,
    pub costs: Option<Py<PyAny>>,
    pub cost_terms: Option<Py<PyAny>>,
    pub terminated: Option<Py<PyAny>>,
    pub truncated: Option<Py<PyAny>>,
}

impl Arrays {
    pub fn clone_ref(&self, py: Python<'_>) -> Arrays {
        let copy = |array: &Option<Py<PyAny>>| array.as_ref().map(|array| array.clone_ref(py));
        Arrays {
            observations: copy(&self.observations),
            rewards: copy(&self.rewards),
            costs: copy(&self.costs),
            cost_terms: copy(&self.cost_terms),
            terminated: copy(&self.terminated),
            truncated: copy(&self.truncated),
        }
    }
}

impl Batch {
    /// Arrays of a batch that has come back. Its observations go to Python in the memory that they
    /// are in; the small rest is copied.
    pub fn new(
        py: Python<'_>,
        batch: &mut hasard_envs::Batch,
        lanes: Vec<i32>,
        shape: [usize; 3],
        pool: &Arc<Pool>,
        bound: Arrays,
    ) -> PyResult<Batch> {
        let count = lanes.len();
        let frames = |count: usize| [count, shape[0], shape[1], shape[2]];
        let terms = [count, batch.cost_terms.len().checked_div(count).unwrap_or(0)];
        let statistics = [count, batch.statistics.len().checked_div(count).unwrap_or(0)];
        let observations = match bound.observations {
            Some(array) => array,
            None => pooled(
                py,
                std::mem::take(&mut batch.observations).into_vec(),
                &frames(count),
                pool,
            )?
            .into_any()
            .unbind(),
        };
        let final_lanes: Vec<i32> = batch.final_lanes.iter().map(|&lane| lane as i32).collect();
        let final_shape = frames(final_lanes.len());
        let positions: Vec<i32> = batch.positions.iter().flatten().copied().collect();
        fn given<T: numpy::Element + Clone>(
            py: Python<'_>,
            bound: Option<Py<PyAny>>,
            own: &[T],
            shape: &[usize],
        ) -> PyResult<Py<PyAny>> {
            match bound {
                Some(array) => Ok(array),
                None => Ok(array(py, own.to_vec(), shape)?.unbind()),
            }
        }
        let [events, event_offsets] = crate::events::arrays(py, batch)?;
        Ok(Batch {
            observations,
            rewards: given(py, bound.rewards, &batch.rewards, &[count])?,
            costs: given(py, bound.costs, &batch.costs, &[count])?,
            cost_terms: given(py, bound.cost_terms, &batch.cost_terms, &terms)?,
            statistics: given(py, None, &batch.statistics, &statistics)?,
            positions: array(py, positions, &[count, 2])?.unbind(),
            terminated: given(py, bound.terminated, &batch.terminated, &[count])?,
            truncated: given(py, bound.truncated, &batch.truncated, &[count])?,
            lanes: array(py, lanes, &[count])?.unbind(),
            final_lanes: array(py, final_lanes, &[final_shape[0]])?.unbind(),
            final_observations: array(
                py,
                std::mem::take(&mut batch.final_observations),
                &final_shape,
            )?
            .unbind(),
            events,
            event_offsets,
            episodes: episodes(py, &batch.episodes)?,
        })
    }
}

/// Episodes that ended, a dict each: `lane, seed, return, cost, length, terminated, truncated,
/// costs, uncounted, statistics`.
fn episodes(py: Python<'_>, episodes: &[Episode]) -> PyResult<Py<PyAny>> {
    let list = PyList::empty(py);
    for episode in episodes {
        let dict = PyDict::new(py);
        dict.set_item("lane", episode.lane)?;
        dict.set_item("seed", episode.seed)?;
        dict.set_item("return", episode.episode_return)?;
        dict.set_item("cost", episode.cost)?;
        dict.set_item("length", episode.length)?;
        dict.set_item("terminated", episode.terminated)?;
        dict.set_item("truncated", episode.truncated)?;
        let costs: Vec<(&'static str, f64)> =
            episode.costs.iter().map(|one| (one.name, one.cost)).collect();
        dict.set_item("costs", named(py, &costs)?)?;
        let uncounted = episode.costs.iter().filter(|one| !one.counted).map(|one| one.name);
        dict.set_item("uncounted", PyList::new(py, uncounted.collect::<Vec<_>>())?)?;
        dict.set_item("statistics", named(py, &episode.stats)?)?;
        list.append(dict)?;
    }
    Ok(list.into_any().unbind())
}

fn named<'py>(py: Python<'py>, values: &[(&'static str, f64)]) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    values.iter().try_for_each(|(name, value)| dict.set_item(name, value))?;
    Ok(dict)
}
