//! A worker thread: steps lanes as long as there are any to claim.

use super::handover::{Lanes, Slot};
use super::job::Job;
use super::lane::{Lane, LaneSlices, Manner, Outbox};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};

/// Looks for work this often before sleeping: tens of microseconds, longer than a caller that steps
/// in a loop takes to come back, and too short to be felt by whatever else wants the core. Waking a
/// sleeper costs as much.
const SPINS: u32 = 2000;

/// What the workers and the owner share.
pub(super) struct Shared {
    pub lanes: Lanes,
    pub slots: Vec<Slot>,
    /// Reports of each worker, and of the owner after them, for each slot:
    /// `outboxes[worker][slot]`.
    pub outboxes: Vec<Vec<Mutex<Outbox>>>,
    /// Rises with every batch given.
    pub given: AtomicU64,
    pub stop: AtomicBool,
    pub manner: Manner,
}

impl Shared {
    /// Steps lanes of a slot until none is left to claim. Lanes differ in how long they take, and
    /// threads in how much of a core they get: claiming one by one keeps all of them busy to the
    /// end.
    pub fn help(&self, worker: usize, slot: usize) {
        let work = |index: usize, lane: &mut Lane, slices: LaneSlices, job: &Job| {
            let mut outbox = Outbox::default();
            let result = catch_unwind(AssertUnwindSafe(|| {
                job.run(lane, index, self.manner, slices, &mut outbox)
            }));
            outbox.panic = result.err().map(|panic| panic_text(&*panic)).or(outbox.panic.take());
            if !outbox.is_empty() {
                self.outboxes[worker][slot]
                    .lock()
                    .unwrap_or_else(|poisoned| poisoned.into_inner())
                    .append(&mut outbox);
            }
        };
        while self.slots[slot].claim(&self.lanes, self.manner.tasks, work) {}
    }
}

/// Works until it has to stop.
pub(super) fn work(worker: usize, shared: Arc<Shared>) {
    let mut seen = 0;
    let mut idle_looks = 0;
    while !shared.stop.load(Ordering::Acquire) {
        let given = shared.given.load(Ordering::Acquire);
        if given == seen {
            idle_looks += 1;
            if idle_looks > SPINS {
                std::thread::park();
                idle_looks = 0;
            } else {
                std::hint::spin_loop();
            }
            continue;
        }
        seen = given;
        idle_looks = 0;
        (0..shared.slots.len()).for_each(|slot| shared.help(worker, slot));
    }
}

/// The message of a panic.
pub(super) fn panic_text(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("no message").to_string()
}
