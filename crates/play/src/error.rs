//! What can go wrong.

use hasard_envs::EnvError;
use hasard_media::MediaError;

/// An error of this crate. Its text is one line that names the input and the remedy.
#[derive(Debug)]
pub enum PlayError {
    /// The environment could not be made.
    Env(EnvError),
    /// A file could not be read, written or understood.
    Media(MediaError),
    /// No window could be opened.
    Window(String),
}

impl std::fmt::Display for PlayError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            PlayError::Env(error) => error.fmt(f),
            PlayError::Media(error) => error.fmt(f),
            PlayError::Window(problem) => f.write_str(problem),
        }
    }
}

impl std::error::Error for PlayError {}

impl From<EnvError> for PlayError {
    fn from(error: EnvError) -> PlayError {
        PlayError::Env(error)
    }
}

impl From<MediaError> for PlayError {
    fn from(error: MediaError) -> PlayError {
        PlayError::Media(error)
    }
}
