//! The thread that writes to the disk, so that sampling and learning never wait for it.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::JoinHandle;

use serde_json::Value;

use crate::error::LearnError;
use crate::runs::checkpoint::{Checkpoint, Progress, Store};
use crate::runs::metrics_log::MetricsLog;

enum Job {
    Row(u64, Value),
    Heatmap(Value),
    Checkpoint(Box<Checkpoint>),
    Best(Box<Checkpoint>),
    Amend(Box<Progress>),
}

/// Writes rows and checkpoints in the order in which they were given.
pub struct Writer {
    jobs: Option<Sender<Job>>,
    /// Checkpoints that were handed over and are not on the disk yet.
    waiting: Arc<AtomicUsize>,
    errors: Receiver<LearnError>,
    thread: Option<JoinHandle<()>>,
}

/// Checkpoints that may wait for the disk. Rows are small: any number of them may.
const MOST_WAITING: usize = 8;

impl Writer {
    /// A writer for a run's directory, from these frames on.
    pub fn new(run: &Path, store: Store, frames: u64) -> Result<Writer, LearnError> {
        let mut log = MetricsLog::open(run, frames)?;
        let (jobs, queue) = channel();
        let (failing, errors) = channel();
        let waiting = Arc::new(AtomicUsize::new(0));
        let written = Arc::clone(&waiting);
        let thread = std::thread::Builder::new().spawn(move || {
            for job in queue {
                let result = match job {
                    Job::Row(frames, row) => log.write(frames, &row),
                    Job::Heatmap(line) => log.write_heatmap(&line),
                    Job::Checkpoint(checkpoint) => {
                        let result = store.write(&checkpoint);
                        written.fetch_sub(1, Ordering::Relaxed);
                        result
                    }
                    Job::Best(checkpoint) => store.write_best(&checkpoint),
                    Job::Amend(progress) => store.amend(&progress),
                };
                if let Err(error) = result {
                    let _ = failing.send(error);
                    return;
                }
            }
        });
        let thread = thread.map_err(LearnError::Thread)?;
        Ok(Writer { jobs: Some(jobs), waiting, errors, thread: Some(thread) })
    }

    /// The first error of the disk, if there was one.
    pub fn check(&self) -> Result<(), LearnError> {
        self.errors.try_recv().map_or(Ok(()), Err)
    }

    /// Hands a row over.
    pub fn row(&self, frames: u64, row: Value) {
        if let Some(jobs) = &self.jobs {
            // A writer that has ended leaves its error for `check`.
            let _ = jobs.send(Job::Row(frames, row));
        }
    }

    /// Hands a line of heatmaps over.
    pub fn heatmap(&self, line: Value) {
        if let Some(jobs) = &self.jobs {
            let _ = jobs.send(Job::Heatmap(line));
        }
    }

    /// Whether the disk is near enough to take another checkpoint. Otherwise one had better be left
    /// out than wait in memory.
    #[must_use]
    pub fn keeps_up(&self) -> bool {
        self.waiting.load(Ordering::Relaxed) < MOST_WAITING
    }

    /// Hands a checkpoint over.
    pub fn checkpoint(&self, checkpoint: Checkpoint) {
        if let Some(jobs) = &self.jobs {
            self.waiting.fetch_add(1, Ordering::Relaxed);
            let _ = jobs.send(Job::Checkpoint(Box::new(checkpoint)));
        }
    }

    /// Hands over the checkpoint that is the best so far.
    pub fn best(&self, checkpoint: Checkpoint) {
        if let Some(jobs) = &self.jobs {
            let _ = jobs.send(Job::Best(Box::new(checkpoint)));
        }
    }

    /// Hands over what a checkpoint that is on the disk is to say of itself from now on.
    pub fn amend(&self, progress: Progress) {
        if let Some(jobs) = &self.jobs {
            let _ = jobs.send(Job::Amend(Box::new(progress)));
        }
    }

    /// Waits until everything is written.
    pub fn finish(mut self) -> Result<(), LearnError> {
        self.end();
        self.check()
    }

    fn end(&mut self) {
        self.jobs = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        self.end();
    }
}
