//! Everything that can go wrong in training, each with where and what to do.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// An error of the learner; its text names the input at fault and the remedy.
#[derive(Debug)]
pub enum LearnError {
    /// A setting that cannot be.
    Config(String),
    /// A file or directory that could not be read or written.
    File {
        /// Which one.
        path: PathBuf,
        /// What was being done.
        doing: &'static str,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file whose content is not what it should be.
    Content {
        /// Which one.
        path: PathBuf,
        /// What is wrong and what to do.
        problem: String,
    },
    /// The worlds failed.
    Worlds(String),
    /// A thread of the run ended in a panic.
    Panic(String),
    /// The system gives no further thread.
    Thread(std::io::Error),
    /// The loss or a gradient is no longer a number.
    Diverged(String),
    /// The workers of the run cannot go on together.
    Team(String),
}

impl LearnError {
    /// A file error with its path.
    pub fn file(path: &Path, doing: &'static str) -> impl FnOnce(std::io::Error) -> LearnError {
        let path = path.to_path_buf();
        move |source| LearnError::File { path, doing, source }
    }

    /// Weights that a run cannot begin with; `whose` names what has them, a run or an agent.
    pub(crate) fn no_beginning(whose: &str) -> LearnError {
        LearnError::Config(format!(
            "the {whose} to begin with does not fit: it has other layers, critics, actions or pictures than this run; train with \
             its settings, or name another with --init-from"
        ))
    }

    /// A content error with its path.
    pub fn content(path: &Path, problem: impl std::fmt::Display) -> LearnError {
        LearnError::Content { path: path.to_path_buf(), problem: problem.to_string() }
    }
}

/// Longest text of a message, in letters.
const LONGEST: usize = 1000;

/// A text that may quote a file by anyone: one line of bounded length, and nothing in it commands a
/// terminal.
struct OneLine<'a>(&'a str);

impl std::fmt::Display for OneLine<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        use std::fmt::Write;
        for letter in self.0.chars().take(LONGEST) {
            if letter.is_control() {
                write!(f, "{}", letter.escape_default())?
            } else {
                f.write_char(letter)?
            }
        }
        if self.0.chars().nth(LONGEST).is_some() { f.write_str(" ...") } else { Ok(()) }
    }
}

impl std::fmt::Display for LearnError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            LearnError::Config(text)
            | LearnError::Worlds(text)
            | LearnError::Panic(text)
            | LearnError::Diverged(text)
            | LearnError::Team(text) => {
                write!(f, "{}", OneLine(text))
            }
            LearnError::File { path, doing, source } => {
                write!(f, "cannot {doing} {}: {source}", path.display())?;
                match source.kind() {
                    ErrorKind::StorageFull | ErrorKind::QuotaExceeded => {
                        f.write_str("; make room and go on with --resume")
                    }
                    ErrorKind::PermissionDenied if *doing == "read" => {
                        f.write_str("; ask for the right to read it, or name another")
                    }
                    ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
                        f.write_str("; choose a place that you may write to")
                    }
                    ErrorKind::AlreadyExists | ErrorKind::NotADirectory => {
                        f.write_str("; a file is in the way, name a folder of its own for the run")
                    }
                    _ => Ok(()),
                }
            }
            LearnError::Thread(source) => write!(
                f,
                "the system gives no further thread ({source}); give fewer with --threads, or raise its limit (`ulimit -u`)"
            ),
            LearnError::Content { path, problem } => {
                write!(f, "{}: {}", path.display(), OneLine(problem))
            }
        }
    }
}

impl std::error::Error for LearnError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            LearnError::File { source, .. } | LearnError::Thread(source) => Some(source),
            _ => None,
        }
    }
}
