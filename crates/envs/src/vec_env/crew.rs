//! Who steps the lanes: worker threads and the caller that waits for them, or the caller alone.

use super::handover::{Lanes, Slot};
use super::job::{Task, visited};
use super::lane::{Lane, LaneSlices, Manner, Outbox};
use super::options::VecOptions;
use super::worker::{self, Shared};
use crate::{Batch, EnvError};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;

/// Who steps the lanes. A group's batch lies in the slot of its number; the slot after the last is
/// for all lanes together.
pub(super) enum Crew {
    /// The caller's thread; a batch is stepped when it is given.
    Caller { lanes: Vec<Lane>, ready: Vec<Option<(Batch, Outbox)>>, manner: Manner },
    /// Worker threads, and the caller's while it waits.
    Workers { shared: Arc<Shared>, threads: Vec<JoinHandle<()>>, busy: Vec<bool> },
}

impl Crew {
    /// Hires as many threads as the options say.
    pub fn new(lanes: Vec<Lane>, options: VecOptions, tasks: usize) -> Result<Crew, EnvError> {
        let slots = || 0..=options.groups;
        let manner = Manner {
            autoreset: options.autoreset,
            final_observations: options.final_observations,
            tasks,
        };
        if options.threads == 0 {
            return Ok(Crew::Caller { lanes, ready: slots().map(|_| None).collect(), manner });
        }
        let shared = Arc::new(Shared {
            lanes: Lanes::new(lanes),
            slots: slots().map(|_| Slot::new()).collect(),
            outboxes: (0..=options.threads)
                .map(|_| slots().map(|_| Mutex::default()).collect())
                .collect(),
            given: AtomicU64::new(0),
            stop: AtomicBool::new(false),
            manner,
        });
        let mut crew = Crew::Workers {
            shared: Arc::clone(&shared),
            threads: Vec::new(),
            busy: slots().map(|_| false).collect(),
        };
        for worker in 0..options.threads {
            let shared = Arc::clone(&shared);
            let thread = std::thread::Builder::new()
                .name(format!("worlds {worker}"))
                .spawn(move || worker::work(worker, shared));
            let thread = thread.map_err(|error| EnvError::Option {
                option: "the number of threads",
                given: options.threads.to_string(),
                allowed: format!(
                    "what the system grants; it refused number {} ({error})",
                    worker + 1
                ),
            })?;
            if let Crew::Workers { threads, .. } = &mut crew {
                threads.push(thread);
            }
        }
        Ok(crew)
    }

    /// Whether a batch lies in a slot.
    pub fn under_way(&self, slot: usize) -> bool {
        match self {
            Crew::Caller { ready, .. } => ready[slot].is_some(),
            Crew::Workers { busy, .. } => busy[slot],
        }
    }

    /// Hands a batch over, to be stepped as the task says.
    pub fn give(&mut self, slot: usize, mut batch: Batch, task: Task) {
        match self {
            Crew::Caller { lanes, ready, manner } => {
                let mut outbox = Outbox::default();
                let result = catch_unwind(AssertUnwindSafe(|| {
                    step(lanes, &mut batch, &task, *manner, &mut outbox)
                }));
                outbox.panic =
                    result.err().map(|panic| worker::panic_text(&*panic)).or(outbox.panic.take());
                ready[slot] = Some((batch, outbox));
            }
            Crew::Workers { shared, threads, busy } => {
                shared.slots[slot].give(batch, task);
                busy[slot] = true;
                shared.given.fetch_add(1, Ordering::Release);
                threads.iter().for_each(|thread| thread.thread().unpark());
            }
        }
    }

    /// Waits for a batch, helping with it, and takes it back with its reports; `None` if none was
    /// given.
    pub fn take(&mut self, slot: usize) -> Option<(Batch, Outbox)> {
        match self {
            Crew::Caller { ready, .. } => ready[slot].take(),
            Crew::Workers { shared, threads, busy } => {
                if !std::mem::take(&mut busy[slot]) {
                    return None;
                }
                shared.help(threads.len(), slot);
                let batch = shared.slots[slot].take();
                let mut reports = Outbox::default();
                for outboxes in &shared.outboxes {
                    reports.append(
                        &mut outboxes[slot].lock().unwrap_or_else(|poisoned| poisoned.into_inner()),
                    );
                }
                Some((batch, reports))
            }
        }
    }
}

/// Steps a batch in the caller's thread.
fn step(lanes: &mut [Lane], batch: &mut Batch, task: &Task, manner: Manner, outbox: &mut Outbox) {
    let count = task.lanes.count();
    let mut slices = LaneSlices::of(batch);
    if manner.tasks == 1 {
        for index in 0..count {
            let own = slices.cut(count - index);
            task.job.run(&mut lanes[task.lanes.lane(index)], index, manner, own, outbox);
        }
        return;
    }
    let mut all: Vec<_> = (0..count).map(|index| Some(slices.cut(count - index))).collect();
    for number in 0..count {
        let index = visited(number, count, manner.tasks);
        let own = all[index].take().expect("each place is visited once");
        task.job.run(&mut lanes[task.lanes.lane(index)], index, manner, own, outbox);
    }
}

impl Drop for Crew {
    fn drop(&mut self) {
        if let Crew::Workers { shared, threads, .. } = self {
            shared.stop.store(true, Ordering::Release);
            for thread in threads.drain(..) {
                thread.thread().unpark();
                // A worker catches panics of environments; there is nothing left to report.
                let _ = thread.join();
            }
        }
    }
}
