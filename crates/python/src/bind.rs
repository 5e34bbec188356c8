//! Memory of the caller's for the results of all lanes, and of each group's.

use crate::batch::Arrays;
use crate::errors::Fault;
use crate::facts::Facts;
use crate::inner::Inner;
use crate::memory::{External, apart, bound};
use hasard_envs::{Buffer, EnvError};
use pyo3::prelude::*;
use pyo3::types::PySlice;
use std::ops::Range;

/// The caller's arrays.
pub struct Given<'a, 'py> {
    pub observations: &'a Bound<'py, PyAny>,
    pub rewards: &'a Bound<'py, PyAny>,
    pub costs: &'a Bound<'py, PyAny>,
    pub terminated: &'a Bound<'py, PyAny>,
    pub truncated: &'a Bound<'py, PyAny>,
    pub cost_terms: Option<&'a Bound<'py, PyAny>>,
}

/// Some lanes' part of an array.
fn part<'py>(array: &Bound<'py, PyAny>, lanes: &Range<usize>) -> PyResult<Bound<'py, PyAny>> {
    array.get_item(PySlice::new(array.py(), lanes.start as isize, lanes.end as isize, 1))
}

/// The arrays as memory to write to and as arrays to show: of each group, then whole.
pub fn cut(facts: &Facts, given: &Given<'_, '_>) -> PyResult<(Vec<Memories>, Vec<Arrays>)> {
    let [height, width, channels] = facts.shape;
    // All are looked at before any is taken.
    let (lanes, terms) = (facts.lanes, facts.terms.len());
    let shape = [lanes, height, width, channels];
    let mut places = vec![
        ("observations", bound::<u8>("observations", given.observations, &shape)?.place()),
        ("rewards", bound::<f32>("rewards", given.rewards, &[lanes])?.place()),
        ("costs", bound::<f32>("costs", given.costs, &[lanes])?.place()),
        ("terminated", bound::<bool>("terminated", given.terminated, &[lanes])?.place()),
        ("truncated", bound::<bool>("truncated", given.truncated, &[lanes])?.place()),
    ];
    if let Some(array) = given.cost_terms {
        let place = bound::<f32>("cost_terms", array, &[lanes, terms])?.place();
        places.push(("cost_terms", place));
    }
    apart(&places)?;
    let (mut arrays, mut memories) = (Vec::new(), Vec::new());
    for slot in 0..=facts.groups {
        let own = facts.lanes_of(slot);
        let count = own.len();
        let cut = |array| part(array, &own);
        let (observations, rewards, costs) =
            (cut(given.observations)?, cut(given.rewards)?, cut(given.costs)?);
        let (terminated, truncated) = (cut(given.terminated)?, cut(given.truncated)?);
        let cost_terms = given.cost_terms.map(cut).transpose()?;
        memories.push(Memories {
            observations: bound("observations", &observations, &[count, height, width, channels])?,
            rewards: bound("rewards", &rewards, &[count])?,
            costs: bound("costs", &costs, &[count])?,
            terminated: bound("terminated", &terminated, &[count])?,
            truncated: bound("truncated", &truncated, &[count])?,
            cost_terms: cost_terms
                .as_ref()
                .map(|array| bound("cost_terms", array, &[count, terms]))
                .transpose()?,
        });
        arrays.push(Arrays {
            observations: Some(observations.unbind()),
            rewards: Some(rewards.unbind()),
            costs: Some(costs.unbind()),
            cost_terms: cost_terms.map(Bound::unbind),
            terminated: Some(terminated.unbind()),
            truncated: Some(truncated.unbind()),
        });
    }
    Ok((memories, arrays))
}

/// Lets batches write to the memory from now on. Returns those that did before.
pub fn attach(
    facts: &Facts,
    inner: &mut Inner,
    memories: Vec<Memories>,
) -> Result<Vec<Option<hasard_envs::Batch>>, Fault> {
    idle(inner)?;
    let slots = memories.into_iter().enumerate();
    let batches = slots.map(|(slot, memory)| {
        Some(memory.batch(inner.worlds().batch_of(facts.lanes_of(slot).len())))
    });
    let batches: Vec<_> = batches.collect();
    Ok(std::mem::replace(&mut inner.bound, batches))
}

/// One slot's memory.
pub struct Memories {
    observations: External<u8>,
    rewards: External<f32>,
    costs: External<f32>,
    terminated: External<bool>,
    truncated: External<bool>,
    cost_terms: Option<External<f32>>,
}

impl Memories {
    /// A batch that writes to it.
    fn batch(self, own: hasard_envs::Batch) -> hasard_envs::Batch {
        let cost_terms = self.cost_terms.map_or_else(|| own.cost_terms.clone(), Buffer::external);
        hasard_envs::Batch {
            observations: Buffer::external(self.observations),
            rewards: Buffer::external(self.rewards),
            costs: Buffer::external(self.costs),
            terminated: Buffer::external(self.terminated),
            truncated: Buffer::external(self.truncated),
            cost_terms,
            ..own
        }
    }
}

/// Whether no batch is under way.
pub fn idle(inner: &mut Inner) -> Result<(), Fault> {
    if inner.worlds().is_idle() {
        return Ok(());
    }
    let why = "a group of lanes is under way; receive it first".to_string();
    Err(Fault::Env(EnvError::Turn { why }))
}
