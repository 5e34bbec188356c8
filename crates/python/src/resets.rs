//! Which lanes are reset, and from which seeds.

use crate::arguments::{one_a_lane, seed};
use hasard_envs::Restart;
use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

/// Seeds of a reset.
#[derive(Clone, Debug)]
pub enum Seeds {
    /// Each lane goes on with its stream.
    GoOn,
    /// Lane `i` starts a stream from this and `i`.
    From(u64),
    /// One a lane.
    Each(Vec<Option<u64>>),
}

impl Seeds {
    /// Reads `None`, an integer, or one entry a lane.
    pub fn read(given: Option<&Bound<'_, PyAny>>, lanes: usize) -> PyResult<Seeds> {
        let Some(given) = given else { return Ok(Seeds::GoOn) };
        // An array without axes is an integer too, though it has the method of lengths.
        if given.hasattr("__index__")? && given.len().is_err() {
            return Ok(Seeds::From(seed(given)?));
        }
        let wrong = || {
            PyTypeError::new_err(
                "seeds must be None, an integer, or a sequence of them with one entry a lane",
            )
        };
        let entries: Vec<Bound<'_, PyAny>> =
            given.try_iter().map_err(|_| wrong())?.collect::<PyResult<_>>()?;
        if entries.len() != lanes {
            return Err(one_a_lane("seeds", lanes, entries.len()));
        }
        let read = |entry: &Bound<'_, PyAny>| {
            if entry.is_none() { Ok(None) } else { seed(entry).map(Some) }
        };
        Ok(Seeds::Each(entries.iter().map(read).collect::<PyResult<_>>()?))
    }

    /// The same, but that every lane has a seed.
    pub fn or(self, fresh: u64) -> Seeds {
        match self {
            Seeds::GoOn => Seeds::From(fresh),
            Seeds::Each(seeds) => {
                let each = seeds.into_iter().enumerate();
                Seeds::Each(
                    each.map(|(lane, seed)| seed.or(Some(fresh.wrapping_add(lane as u64))))
                        .collect(),
                )
            }
            Seeds::From(seed) => Seeds::From(seed),
        }
    }
}

/// What is done with each lane.
pub fn restarts(seeds: &Seeds, mask: Option<&[bool]>, lanes: usize) -> Vec<Restart> {
    let one = |lane: usize| {
        let seed = match seeds {
            Seeds::GoOn => None,
            Seeds::From(seed) => Some(seed.wrapping_add(lane as u64)),
            Seeds::Each(seeds) => seeds[lane],
        };
        let chosen = mask.is_none_or(|mask| mask[lane]);
        if chosen { seed.map_or(Restart::Next, Restart::Seed) } else { Restart::Stay }
    };
    (0..lanes).map(one).collect()
}

/// Reads a mask of lanes.
pub fn mask(given: &Bound<'_, PyAny>, lanes: usize) -> PyResult<Vec<bool>> {
    let array = given
        .cast::<PyArrayDyn<bool>>()
        .map_err(|_| PyTypeError::new_err("mask must be a bool array with one entry a lane"))?;
    if array.shape() != [lanes] {
        return Err(one_a_lane("mask", lanes, format!("{:?}", array.shape())));
    }
    let readable =
        array.try_readonly().map_err(|error| PyTypeError::new_err(format!("mask: {error}")))?;
    Ok(readable.as_array().iter().copied().collect())
}
