//! The thread that writes to the disk, so that sampling and learning never wait for it.

use std::path::Path;
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, channel, sync_channel};
use std::thread::JoinHandle;

use serde_json::Value;

use crate::checkpoint::{Checkpoint, Store};
use crate::error::LearnError;
use crate::run_directory::MetricsLog;

enum Job {
    Row(u64, Value),
    Heatmap(Value),
    Checkpoint(Box<Checkpoint>, bool),
}

/// Writes rows and checkpoints in the order in which they were given.
pub struct Writer {
    jobs: Option<SyncSender<Job>>,
    errors: Receiver<LearnError>,
    thread: Option<JoinHandle<()>>,
}

/// Jobs that may wait; when the disk is that far behind, a checkpoint is left out and a row waits.
const QUEUE: usize = 8;

impl Writer {
    /// A writer for a run's directory.
    pub fn new(run: &Path, store: Store) -> Result<Writer, LearnError> {
        let mut log = MetricsLog::open(run)?;
        let (jobs, queue) = sync_channel(QUEUE);
        let (failing, errors) = channel();
        let thread = std::thread::spawn(move || {
            for job in queue {
                let result = match job {
                    Job::Row(frames, row) => log.write(frames, &row),
                    Job::Heatmap(line) => log.write_heatmap(&line),
                    Job::Checkpoint(checkpoint, best) => store.write(&checkpoint, best),
                };
                if let Err(error) = result {
                    let _ = failing.send(error);
                    return;
                }
            }
        });
        Ok(Writer { jobs: Some(jobs), errors, thread: Some(thread) })
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

    /// Hands a checkpoint over. Returns false if the disk is too far behind to take it.
    #[must_use]
    pub fn checkpoint(&self, checkpoint: Checkpoint, best: bool, wait: bool) -> bool {
        let Some(jobs) = &self.jobs else { return false };
        let job = Job::Checkpoint(Box::new(checkpoint), best);
        if wait {
            return jobs.send(job).is_ok();
        }
        !matches!(jobs.try_send(job), Err(TrySendError::Full(_)))
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
