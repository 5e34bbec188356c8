//! What is done with lanes.

use super::LaneState;
use super::lane::{Lane, LaneSlices, Manner, Outbox};
use std::ops::Range;
use std::sync::{Arc, Mutex};

/// How a lane is reset.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Restart {
    /// Not at all: its episode goes on, and its present is shown.
    Stay,
    /// Its next episode starts.
    #[default]
    Next,
    /// Its stream of episode seeds starts anew from this seed, and its first episode starts. The
    /// stream is that of lane 0 of a batch made with this seed, wherever the lane stands.
    Seed(u64),
}

/// What is done with a batch's lanes.
#[derive(Clone)]
pub(super) enum Job {
    /// Starts the next episode.
    Reset,
    /// Resets each lane of the whole as it is told.
    Restart(Arc<[Restart]>),
    Step,
    /// Starts the seeds of episodes anew from a seed, nothing more.
    Seed(u64),
    /// Writes each lane's state to its place.
    Save(Arc<Mutex<Vec<LaneState>>>),
    /// Brings each lane to the state at its place, and observes it.
    Restore(Arc<Vec<LaneState>>),
}

/// A job and the lanes that it is done with.
#[derive(Clone)]
pub(super) struct Task {
    pub job: Job,
    pub lanes: Chosen,
}

/// Lanes of the whole, in the order of a batch.
#[derive(Clone)]
pub(super) enum Chosen {
    /// Neighbours, as the lanes of a group are.
    Range(Range<usize>),
    /// Any, each once.
    List(Arc<[usize]>),
}

impl Chosen {
    pub fn count(&self) -> usize {
        match self {
            Chosen::Range(range) => range.len(),
            Chosen::List(list) => list.len(),
        }
    }

    /// The lane at a place of the batch.
    pub fn lane(&self, index: usize) -> usize {
        match self {
            Chosen::Range(range) => range.start + index,
            Chosen::List(list) => list[index],
        }
    }
}

impl Job {
    /// Does the job with one lane, which is number `index` of its batch.
    pub fn run(
        &self,
        lane: &mut Lane,
        index: usize,
        manner: Manner,
        slices: LaneSlices,
        outbox: &mut Outbox,
    ) {
        match self {
            Job::Reset => lane.reset(Restart::Next, slices),
            Job::Restart(how) => lane.reset(how[lane.index], slices),
            Job::Step => lane.step(index, manner, slices, outbox),
            Job::Seed(seed) => lane.reseed(*seed),
            Job::Save(states) => {
                states.lock().unwrap_or_else(|poisoned| poisoned.into_inner())[lane.index] =
                    lane.state();
            }
            Job::Restore(states) => lane.restore(&states[lane.index], slices),
        }
    }
}
