//! What can go wrong with media files.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// A file that could not be written, read or understood. The message is one line that names the
/// file and the remedy.
#[derive(Debug)]
pub enum MediaError {
    /// The operating system refused.
    Io {
        /// The file.
        path: PathBuf,
        /// What was tried, as in "cannot {action}".
        action: &'static str,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file's content is not what its kind promises.
    Format {
        /// The file, or a name for bytes that have none.
        path: PathBuf,
        /// What is wrong, and what to do.
        problem: String,
    },
    /// The caller's pixels do not fit: a size of zero, too large, or different from the frames
    /// before.
    Size(String),
}

impl MediaError {
    pub(crate) fn io(path: &Path, action: &'static str, source: std::io::Error) -> MediaError {
        MediaError::Io { path: path.to_owned(), action, source }
    }

    pub(crate) fn format(path: &Path, problem: impl Into<String>) -> MediaError {
        MediaError::Format { path: path.to_owned(), problem: problem.into() }
    }
}

impl std::fmt::Display for MediaError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            MediaError::Io { path, action, source } => {
                write!(f, "{}: cannot {action}: {source}", path.display())?;
                match (source.kind(), *action) {
                    (ErrorKind::StorageFull | ErrorKind::QuotaExceeded, _) => {
                        f.write_str("; make room, or choose another place")
                    }
                    (ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem, "read") => {
                        f.write_str("; choose one that you may read")
                    }
                    (ErrorKind::NotFound, "read") => f.write_str("; name a file that is there"),
                    (_, "read") => Ok(()),
                    _ => f.write_str("; choose a place that you can write to"),
                }
            }
            MediaError::Format { path, problem } => write!(f, "{}: {problem}", path.display()),
            MediaError::Size(problem) => f.write_str(problem),
        }
    }
}

impl std::error::Error for MediaError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            MediaError::Io { source, .. } => Some(source),
            _ => None,
        }
    }
}
