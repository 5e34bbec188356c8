//! What is done with lanes.

use super::chosen::{Chosen, Restart};
use super::lane::{Lane, LaneSlices, Manner, Outbox};
use super::lane_state::LaneState;
use std::sync::{Arc, Mutex};

/// What is done with a batch's lanes.
#[derive(Clone)]
pub(super) enum Job {
    /// Starts the next episode.
    Reset,
    /// Resets each lane of the whole in its own way.
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

/// The place of the batch that is visited as number `index` of `count`, where neighbours have
/// different tasks: one task after the other, so that its map and pictures stay in the caches (a
/// batch of three tasks ran at 0.90 of its parts' speed in the order of lanes).
pub(super) const fn visited(index: usize, count: usize, tasks: usize) -> usize {
    if tasks == 1 {
        return index;
    }
    let (each, more) = (count / tasks, count % tasks);
    // The first `more` tasks have a lane more than the others.
    let (task, round) = if index < more * (each + 1) {
        (index / (each + 1), index % (each + 1))
    } else {
        let rest = index - more * (each + 1);
        (more + rest / each, rest % each)
    };
    round * tasks + task
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

#[cfg(test)]
mod tests {
    use super::visited;

    #[test]
    fn every_place_is_visited_once_and_tasks_one_after_the_other() {
        for count in 1..40 {
            for tasks in 1..7 {
                let order: Vec<usize> = (0..count).map(|i| visited(i, count, tasks)).collect();
                let mut sorted = order.clone();
                sorted.sort_unstable();
                assert!(sorted.into_iter().eq(0..count), "{count} {tasks}: {order:?}");
                let kinds: Vec<usize> = order.iter().map(|place| place % tasks).collect();
                assert!(kinds.is_sorted(), "{count} {tasks}: {order:?}");
            }
        }
    }
}
