//! The hand-over of a batch to the worker threads and back: the only unsafe code of this crate.
//!
//! Why unsafe: several threads write disjoint parts of the same contiguous buffers, which the borrow checker cannot see.
//! The invariants that make it sound:
//! 1. A slot is `IDLE` (its contents belong to the owner) or `BUSY` (they belong to the workers); only [`Slot::give`] and
//!    [`Slot::take`] change that, and `take` succeeds only after every worker of the crew has called [`Slot::done`].
//! 2. While `BUSY` nobody touches the batch but through the pointers taken in `give`, and each worker asks
//!    [`Slot::lanes`] only for its own lanes, which no other worker has.
//!
//! The safe twin is the batch of worlds without threads, which slices the same buffers by the borrow checker's rules; tests
//! compare both.

use super::Job;
use super::lane::LaneSlices;
use crate::Batch;
use std::cell::UnsafeCell;
use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU8, AtomicU64, AtomicUsize, Ordering};
use std::thread::Thread;

const IDLE: u8 = 0;
const CHANGING: u8 = 1;
const BUSY: u8 = 2;

/// A place where one group's batch lies while its lanes are stepped.
pub(super) struct Slot {
    state: AtomicU8,
    /// Rises by one with every batch given; workers compare it with what they have done.
    sequence: AtomicU64,
    /// Workers that are not done yet.
    pending: AtomicUsize,
    contents: UnsafeCell<Contents>,
    waiter: Mutex<Option<Thread>>,
    lane_count: usize,
}

struct Contents {
    batch: Batch,
    job: Job,
    actions: Raw<u8>,
    deltas: Raw<f32>,
    observations: Raw<u8>,
    rewards: Raw<f32>,
    costs: Raw<f32>,
    cost_terms: Raw<f32>,
    positions: Raw<[i32; 2]>,
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

    /// The part of `lanes`, of `lane_count` equal parts.
    ///
    /// # Safety
    /// The buffer is alive, and nobody else uses this part for the time of `'a`.
    unsafe fn part<'a>(&self, lanes: &Range<usize>, lane_count: usize) -> &'a mut [T] {
        assert!(lanes.start <= lanes.end && lanes.end <= lane_count && lane_count > 0);
        let each = self.length / lane_count;
        // SAFETY: inside of the buffer by the assertion; alive and exclusive by the caller's promise.
        unsafe { std::slice::from_raw_parts_mut(self.start.add(lanes.start * each), lanes.len() * each) }
    }
}

// SAFETY: the contents are reached by one side at a time, as the invariants above say; they hold nothing bound to a thread
// (the job is required to be `Send + Sync` below).
unsafe impl Sync for Slot {}
// SAFETY: as above; the raw pointers point into `batch`, whose buffers do not move with the slot.
unsafe impl Send for Slot {}

const fn job_may_cross_threads<T: Send + Sync>() {}
const _: () = job_may_cross_threads::<Job>();

impl Slot {
    pub fn new(lane_count: usize) -> Slot {
        let contents = Contents {
            batch: Batch::default(),
            job: Job::Reset,
            actions: Raw::none(),
            deltas: Raw::none(),
            observations: Raw::none(),
            rewards: Raw::none(),
            costs: Raw::none(),
            cost_terms: Raw::none(),
            positions: Raw::none(),
            terminated: Raw::none(),
            truncated: Raw::none(),
        };
        Slot {
            state: AtomicU8::new(IDLE),
            sequence: AtomicU64::new(0),
            pending: AtomicUsize::new(0),
            contents: UnsafeCell::new(contents),
            waiter: Mutex::new(None),
            lane_count,
        }
    }

    /// Gives a batch to a crew of workers. Panics unless the slot is idle.
    pub fn give(&self, batch: Batch, job: Job, crew: usize) {
        assert!(self.change(IDLE), "a batch was given to a busy slot");
        self.pending.store(crew, Ordering::Relaxed);
        // SAFETY: the slot was idle and is now `CHANGING`, so this thread alone reaches the contents.
        let contents = unsafe { &mut *self.contents.get() };
        contents.batch = batch;
        contents.job = job;
        let batch = &mut contents.batch;
        contents.actions = Raw::of(&mut batch.actions);
        contents.deltas = Raw::of(&mut batch.deltas);
        contents.observations = Raw::of(&mut batch.observations);
        contents.rewards = Raw::of(&mut batch.rewards);
        contents.costs = Raw::of(&mut batch.costs);
        contents.cost_terms = Raw::of(&mut batch.cost_terms);
        contents.positions = Raw::of(&mut batch.positions);
        contents.terminated = Raw::of(&mut batch.terminated);
        contents.truncated = Raw::of(&mut batch.truncated);
        self.state.store(BUSY, Ordering::Release);
        self.sequence.fetch_add(1, Ordering::Release);
    }

    fn change(&self, from: u8) -> bool {
        self.state.compare_exchange(from, CHANGING, Ordering::Acquire, Ordering::Relaxed).is_ok()
    }

    /// Number of batches given so far. A worker that sees a new number may use [`Slot::lanes`].
    pub fn sequence(&self) -> u64 {
        self.sequence.load(Ordering::Acquire)
    }

    /// A worker's part of the batch, and what to do with it.
    ///
    /// # Safety
    /// The caller belongs to the crew that the batch was given to, has seen its [`Slot::sequence`], has not called
    /// [`Slot::done`] for it, lets go of the slices before it does, and asks only for lanes that no other worker asks for.
    pub unsafe fn lanes<'a>(&self, lanes: &Range<usize>) -> (LaneSlices<'a>, Job) {
        // SAFETY: the sequence was seen with `Acquire`, so the contents are written; while the slot is busy they are only read.
        let contents = unsafe { &*self.contents.get() };
        let count = self.lane_count;
        // SAFETY: the batch stays in the slot until all of the crew are done, and the lanes are the caller's own.
        let slices = unsafe {
            LaneSlices {
                actions: contents.actions.part(lanes, count),
                deltas: contents.deltas.part(lanes, count),
                observations: contents.observations.part(lanes, count),
                rewards: contents.rewards.part(lanes, count),
                costs: contents.costs.part(lanes, count),
                cost_terms: contents.cost_terms.part(lanes, count),
                positions: contents.positions.part(lanes, count),
                terminated: contents.terminated.part(lanes, count),
                truncated: contents.truncated.part(lanes, count),
            }
        };
        (slices, contents.job.clone())
    }

    /// A worker has finished its part.
    pub fn done(&self) {
        if self.pending.fetch_sub(1, Ordering::SeqCst) == 1
            && let Some(thread) = self.waiter.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).take()
        {
            thread.unpark();
        }
    }

    /// Waits for the crew and takes the batch back. Panics unless one was given.
    pub fn take(&self) -> Batch {
        let ready = || self.pending.load(Ordering::SeqCst) == 0;
        while !ready() {
            // Registered before the last look, so that the last worker either sees the waiter or is seen to be done; and
            // registered anew after every wake: it may come from a worker of the batch before, late in `done`, which has
            // then taken the waiter that this batch's last worker needs.
            *self.waiter.lock().unwrap_or_else(|poisoned| poisoned.into_inner()) = Some(std::thread::current());
            if !ready() {
                std::thread::park();
            }
        }
        assert!(self.change(BUSY), "a batch was taken from an idle slot");
        // SAFETY: every worker is done (their writes are seen through `pending`), and the slot is `CHANGING`.
        let batch = std::mem::take(unsafe { &mut (*self.contents.get()).batch });
        self.state.store(IDLE, Ordering::Release);
        batch
    }
}
