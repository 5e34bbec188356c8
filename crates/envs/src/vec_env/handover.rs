//! The hand-over of a batch to the threads that step its lanes, and back: the only unsafe code of
//! this crate.
//!
//! Why unsafe: several threads step disjoint lanes and write disjoint parts of the same contiguous
//! buffers, which the borrow checker cannot see. The invariants that make it sound:
//! 1. A slot is `IDLE` (its contents belong to the owner) or `BUSY` (they belong to those who claim
//!    lanes); only [`Slot::give`] and [`Slot::take`] change that, and `take` succeeds only after
//!    every lane has been claimed and done.
//! 2. The slot's counter assigns each lane of a batch once. It holds the number of lanes beside
//!    the next one, so that a claim is judged by the batch that it falls into, not by the one
//!    before. A thread touches a lane, and that lane's parts of the batch, only between its claim
//!    and its being done; so a claim always belongs to the batch that is in the slot.
//! 3. Slots that share lanes are never busy at the same time, and no lane is chosen twice for a
//!    batch: the owner sees to that (`VecEnv::check_turn`, `VecEnv::check_lanes`).
//!
//! The safe twin is the batch of worlds without threads, which slices the same buffers by the
//! borrow checker's rules; tests compare both.

use super::chosen::Chosen;
use super::job::{Job, Task, visited};
use super::lane::{Lane, LaneSlices};
use crate::Batch;
use std::cell::UnsafeCell;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU8, AtomicU64, AtomicUsize, Ordering};
use std::thread::Thread;

const IDLE: u8 = 0;
const CHANGING: u8 = 1;
const BUSY: u8 = 2;

/// Looks this often whether the last lanes are done before sleeping: as long as a lane or two take.
const SPINS: u32 = 2000;

/// The lanes of a batch of worlds, for the threads that claim them.
pub(super) struct Lanes(Box<[UnsafeCell<Lane>]>);

// SAFETY: a lane is reached by the thread that has claimed it alone, as the invariants above say;
// lanes are `Send`.
unsafe impl Sync for Lanes {}

const fn may_move_to_other_threads<T: Send>() {}
const _: () = may_move_to_other_threads::<Lane>();

impl Lanes {
    pub fn new(lanes: Vec<Lane>) -> Lanes {
        Lanes(lanes.into_iter().map(UnsafeCell::new).collect())
    }
}

/// A place where one group's batch lies while its lanes are stepped.
pub(super) struct Slot {
    state: AtomicU8,
    /// Number of the batch's lanes, and of those claimed so far: see [`open`].
    next: AtomicU64,
    /// Lanes that are not done yet.
    pending: AtomicUsize,
    contents: UnsafeCell<Contents>,
    waiter: Mutex<Option<Thread>>,
}

struct Contents {
    batch: Batch,
    task: Task,
    actions: Raw<u8>,
    deltas: Raw<f32>,
    observations: Raw<u8>,
    rewards: Raw<f32>,
    costs: Raw<f32>,
    cost_terms: Raw<f32>,
    statistics: Raw<f64>,
    positions: Raw<[i32; 2]>,
    insight: Raw<u8>,
    terminated: Raw<bool>,
    truncated: Raw<bool>,
}

/// A buffer's address and length.
struct Raw<T> {
    start: *mut T,
    length: usize,
}

impl<T> Raw<T> {
    fn none() -> Raw<T> {
        Raw { start: std::ptr::NonNull::dangling().as_ptr(), length: 0 }
    }

    fn of(buffer: &mut [T]) -> Raw<T> {
        Raw { start: buffer.as_mut_ptr(), length: buffer.len() }
    }

    /// The part of a lane, of `lane_count` equal parts.
    ///
    /// # Safety
    /// The buffer is alive, and nobody else uses this part for the time of `'a`.
    unsafe fn part<'a>(&self, lane: usize, lane_count: usize) -> &'a mut [T] {
        assert!(lane < lane_count);
        let each = self.length / lane_count;
        // SAFETY: inside of the buffer by the assertion; alive and exclusive by the caller's
        // promise.
        unsafe { std::slice::from_raw_parts_mut(self.start.add(lane * each), each) }
    }
}

// SAFETY: the contents are reached by one side at a time, as the invariants above say; they hold
// nothing bound to a thread (the task is required to be `Send + Sync` below).
unsafe impl Sync for Slot {}
// SAFETY: as above; the raw pointers point into `batch`, whose buffers do not move with the slot.
unsafe impl Send for Slot {}

const fn task_may_cross_threads<T: Send + Sync>() {}
const _: () = task_may_cross_threads::<Task>();

/// The counter of a batch of so many lanes, none of them claimed.
const fn open(count: usize) -> u64 {
    (count as u64) << 32
}

/// The lane that a counter's value stands for, and the number of lanes; `None` if all are claimed.
const fn claimed(next: u64) -> Option<(usize, usize)> {
    let (index, count) = ((next & u32::MAX as u64) as usize, (next >> 32) as usize);
    if index < count { Some((index, count)) } else { None }
}

/// Ends the program when it is dropped: only by a panic that was not caught.
struct AbortOnPanic;

impl Drop for AbortOnPanic {
    fn drop(&mut self) {
        std::process::abort();
    }
}

impl Slot {
    pub fn new() -> Slot {
        let contents = Contents {
            batch: Batch::default(),
            task: Task { job: Job::Reset, lanes: Chosen::Range(0..0) },
            actions: Raw::none(),
            deltas: Raw::none(),
            observations: Raw::none(),
            rewards: Raw::none(),
            costs: Raw::none(),
            cost_terms: Raw::none(),
            statistics: Raw::none(),
            positions: Raw::none(),
            insight: Raw::none(),
            terminated: Raw::none(),
            truncated: Raw::none(),
        };
        Slot {
            state: AtomicU8::new(IDLE),
            next: AtomicU64::new(open(0)),
            pending: AtomicUsize::new(0),
            contents: UnsafeCell::new(contents),
            waiter: Mutex::new(None),
        }
    }

    /// Lays a batch open for claims. Panics unless the slot is idle.
    pub fn give(&self, batch: Batch, task: Task) {
        assert!(self.change(IDLE), "a batch was given to a busy slot");
        let count = task.lanes.count();
        self.pending.store(count, Ordering::Relaxed);
        // SAFETY: the slot was idle and is now `CHANGING`, so this thread alone reaches the
        // contents.
        let contents = unsafe { &mut *self.contents.get() };
        contents.batch = batch;
        contents.task = task;
        let batch = &mut contents.batch;
        contents.actions = Raw::of(&mut batch.actions);
        contents.deltas = Raw::of(&mut batch.deltas);
        contents.observations = Raw::of(&mut batch.observations);
        contents.rewards = Raw::of(&mut batch.rewards);
        contents.costs = Raw::of(&mut batch.costs);
        contents.cost_terms = Raw::of(&mut batch.cost_terms);
        contents.statistics = Raw::of(&mut batch.statistics);
        contents.positions = Raw::of(&mut batch.positions);
        contents.insight = Raw::of(&mut batch.insight);
        contents.terminated = Raw::of(&mut batch.terminated);
        contents.truncated = Raw::of(&mut batch.truncated);
        self.state.store(BUSY, Ordering::Release);
        // From here on lanes are claimed; a thread that sees this number sees all of the above.
        self.next.store(open(count), Ordering::Release);
    }

    fn change(&self, from: u8) -> bool {
        self.state.compare_exchange(from, CHANGING, Ordering::Acquire, Ordering::Relaxed).is_ok()
    }

    /// Claims one of the slot's lanes and runs `work` with its number in the batch, the lane, its
    /// parts of the batch and what is to be done. Returns whether there was a lane left.
    pub fn claim(
        &self,
        lanes: &Lanes,
        tasks: usize,
        work: impl FnOnce(usize, &mut Lane, LaneSlices, &Job),
    ) -> bool {
        // Looking first keeps the counter from rising for ever while there is nothing to do.
        if claimed(self.next.load(Ordering::Relaxed)).is_none() {
            return false;
        }
        let Some((index, count)) = claimed(self.next.fetch_add(1, Ordering::AcqRel)) else {
            return false;
        };
        // A permutation of the batch's places, so each is still claimed once.
        let index = visited(index, count, tasks);
        // SAFETY: the number was seen with `Acquire`, so the contents are written; until this lane
        // is done they stay in the slot and are only read.
        let contents = unsafe { &*self.contents.get() };
        // SAFETY: the counter gave this lane to this thread alone, until it is done, and no other
        // busy slot has it.
        let lane = unsafe { &mut *lanes.0[contents.task.lanes.lane(index)].get() };
        // SAFETY: as for the lane; the batch's buffers are alive as long as it stays in the slot.
        let slices = unsafe {
            LaneSlices {
                actions: contents.actions.part(index, count),
                deltas: contents.deltas.part(index, count),
                observations: contents.observations.part(index, count),
                rewards: contents.rewards.part(index, count),
                costs: contents.costs.part(index, count),
                cost_terms: contents.cost_terms.part(index, count),
                statistics: contents.statistics.part(index, count),
                positions: contents.positions.part(index, count),
                insight: contents.insight.part(index, count),
                terminated: contents.terminated.part(index, count),
                truncated: contents.truncated.part(index, count),
            }
        };
        // A panic would leave the lane undone and the owner waiting: it is caught by `work`, or
        // ends the program.
        let guard = AbortOnPanic;
        work(index, lane, slices, &contents.task.job);
        std::mem::forget(guard);
        if self.pending.fetch_sub(1, Ordering::SeqCst) == 1
            && let Some(thread) =
                self.waiter.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).take()
        {
            thread.unpark();
        }
        true
    }

    /// Waits until every lane is done and takes the batch back. Panics unless one was given.
    pub fn take(&self) -> Batch {
        let ready = || self.pending.load(Ordering::SeqCst) == 0;
        for _ in 0..SPINS {
            if ready() {
                break;
            }
            std::hint::spin_loop();
        }
        while !ready() {
            // Registered before the last look, so that the last worker either sees the waiter or is
            // seen to be done; and registered anew after every wake: it may come from a worker of
            // the batch before, late in its claim, which has then taken the waiter that this
            // batch's last worker needs.
            *self.waiter.lock().unwrap_or_else(|poisoned| poisoned.into_inner()) =
                Some(std::thread::current());
            if !ready() {
                std::thread::park();
            }
        }
        assert!(self.change(BUSY), "a batch was taken from an idle slot");
        // SAFETY: every lane is done (what was written is seen through `pending`), and the slot is
        // `CHANGING`.
        let batch = std::mem::take(unsafe { &mut (*self.contents.get()).batch });
        self.state.store(IDLE, Ordering::Release);
        batch
    }
}
