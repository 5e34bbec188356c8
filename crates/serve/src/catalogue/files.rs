//! Files of runs: when they are others, and reading them bounded.

use std::path::Path;
use std::time::SystemTime;

/// What distinguishes a file from another that was put in its place.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Stamp {
    pub bytes: u64,
    pub modified: SystemTime,
}

impl Stamp {
    pub(super) const NONE: Stamp = Stamp { bytes: 0, modified: SystemTime::UNIX_EPOCH };

    /// Of a file that is no link.
    pub(super) fn of(path: &Path) -> Option<Stamp> {
        let data = std::fs::symlink_metadata(path).ok().filter(std::fs::Metadata::is_file)?;
        Some(Stamp {
            bytes: data.len(),
            modified: data.modified().unwrap_or(SystemTime::UNIX_EPOCH),
        })
    }
}

/// Largest file of settings, heatmaps or pictures of a run that is read.
const LARGEST_FILE: u64 = 64 << 20;

/// The text of a file, if there is one and it is not too large.
pub(crate) fn read(path: &Path) -> Option<String> {
    let size = std::fs::metadata(path).ok().filter(std::fs::Metadata::is_file)?.len();
    (size <= LARGEST_FILE).then(|| std::fs::read_to_string(path).ok()).flatten()
}

/// Whether a training has this run's folder.
pub(crate) fn is_held(run: &Path) -> bool {
    hasard_media::files::is_locked(&run.join("lock"))
}

/// Threads that read files at a time: more than cores, since a disk takes its time.
const READERS: usize = 8;
/// Files for which a thread is worth its beginning.
const SHARE: usize = 32;

/// Works on each of some runs, many at a time; what comes of them, in their order.
pub(super) fn at_once<T: Send, R: Send>(all: Vec<T>, work: impl Fn(T) -> R + Sync) -> Vec<R> {
    let share = all.len().div_ceil(READERS).max(SHARE);
    let mut rest = all.into_iter();
    let shares: Vec<Vec<T>> = std::iter::from_fn(|| {
        let share: Vec<T> = rest.by_ref().take(share).collect();
        (!share.is_empty()).then_some(share)
    })
    .collect();
    if shares.len() < 2 {
        return shares.into_iter().flatten().map(work).collect();
    }
    let work = &work;
    std::thread::scope(|scope| {
        let begun: Vec<_> = shares
            .into_iter()
            .map(|share| scope.spawn(move || share.into_iter().map(work).collect::<Vec<R>>()))
            .collect();
        begun
            .into_iter()
            .flat_map(|thread| match thread.join() {
                Ok(done) => done,
                Err(panic) => std::panic::resume_unwind(panic),
            })
            .collect()
    })
}

#[cfg(test)]
mod tests {
    use super::at_once;

    #[test]
    fn what_is_done_at_once_comes_in_order() {
        for many in [0, 1, 31, 33, 1000] {
            let squares: Vec<usize> = (0..many).map(|k| k * k).collect();
            assert_eq!(at_once((0..many).collect(), |k: usize| k * k), squares);
        }
    }
}
