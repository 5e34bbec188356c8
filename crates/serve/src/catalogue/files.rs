//! Files of runs: when they are others, and reading them bounded.

use std::path::Path;
use std::time::SystemTime;

/// What tells a file from another that was put in its place.
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
