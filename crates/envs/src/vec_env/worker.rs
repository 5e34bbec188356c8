//! A worker thread: owns its lanes for as long as the batch of worlds lives.

use super::handover::Slot;
use super::lane::{Lane, Outbox};
use super::{Manner, run_job};
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

/// Looks for work this often before sleeping: some microseconds, longer than a caller that steps in a loop takes to come back,
/// and too short to be felt by whatever else wants the core.
const SPINS: u32 = 300;

/// What the workers and the owner share.
pub(super) struct Shared {
    pub slots: Vec<Slot>,
    /// Reports of each worker for each slot: `outboxes[worker][slot]`.
    pub outboxes: Vec<Vec<Mutex<Outbox>>>,
    pub stop: AtomicBool,
}

/// A run of neighbouring lanes that a worker owns within one slot.
pub(super) struct Share {
    /// Where they are in the worker's own list.
    pub own: Range<usize>,
    /// Where they are in the slot's batch.
    pub in_batch: Range<usize>,
}

/// Works until told to stop.
pub(super) fn work(worker: usize, mut lanes: Vec<Lane>, shares: Vec<Vec<Share>>, manner: Manner, shared: Arc<Shared>) {
    let mut done: Vec<u64> = shared.slots.iter().map(|_| 0).collect();
    let mut idle_looks = 0;
    let mut next = 0;
    while !shared.stop.load(Ordering::Acquire) {
        // Slots in turn, so that a group that is always ready cannot starve another.
        let count = shared.slots.len();
        let found = (0..count)
            .map(|i| (next + i) % count)
            .find(|&slot| !shares[slot].is_empty() && shared.slots[slot].sequence() != done[slot]);
        let Some(slot) = found else {
            idle_looks += 1;
            if idle_looks > SPINS {
                std::thread::park();
                idle_looks = 0;
            } else {
                std::hint::spin_loop();
            }
            continue;
        };
        idle_looks = 0;
        next = slot + 1;
        done[slot] += 1;
        let mut outbox = shared.outboxes[worker][slot].lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        for share in &shares[slot] {
            // SAFETY: this worker is of the slot's crew (it has a share), has seen the sequence and is not done; shares of
            // different workers never overlap (`VecEnv` cuts them from one range), and the slices end with this iteration.
            let (slices, job) = unsafe { shared.slots[slot].lanes(&share.in_batch) };
            let own = &mut lanes[share.own.clone()];
            let result = catch_unwind(AssertUnwindSafe(|| run_job(&job, own, share.in_batch.start, manner, slices, &mut outbox)));
            if let Err(panic) = result {
                outbox.panic = Some(panic_text(&*panic));
            }
        }
        drop(outbox);
        shared.slots[slot].done();
    }
}

/// The message of a panic.
pub(super) fn panic_text(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied().or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    text.unwrap_or("no message").to_string()
}
