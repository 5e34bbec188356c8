//! Errors as Python's exceptions: classes of `hasard_rs.errors`, each with the one line of its
//! cause.

use hasard_envs::EnvError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;

/// An exception class of `hasard_rs.errors`, looked up once.
pub struct Class {
    name: &'static str,
    class: PyOnceLock<Py<PyType>>,
}

impl Class {
    const fn new(name: &'static str) -> Class {
        Class { name, class: PyOnceLock::new() }
    }

    /// The exception with a text.
    pub fn error(&self, py: Python<'_>, text: impl Into<String>) -> PyErr {
        match self.class.import(py, "hasard_rs.errors", self.name) {
            Ok(class) => PyErr::from_type(class.clone(), text.into()),
            Err(missing) => missing,
        }
    }
}

pub static UNKNOWN_ENVIRONMENT: Class = Class::new("UnknownEnvironment");
pub static INVALID_OPTION: Class = Class::new("InvalidOption");
pub static INVALID_ACTION: Class = Class::new("InvalidAction");
pub static INVALID_MAP: Class = Class::new("InvalidMap");
pub static OUT_OF_TURN: Class = Class::new("OutOfTurn");
pub static RESET_NEEDED: Class = Class::new("ResetNeeded");
pub static WORLD_PANICKED: Class = Class::new("WorldPanicked");
pub static CLOSED: Class = Class::new("Closed");

/// The exception for an error of the worlds.
pub fn raise(py: Python<'_>, error: &EnvError) -> PyErr {
    let class = match error {
        EnvError::UnknownId { .. } => &UNKNOWN_ENVIRONMENT,
        EnvError::Action { .. } => &INVALID_ACTION,
        EnvError::Map { .. } => &INVALID_MAP,
        EnvError::Turn { .. } => &OUT_OF_TURN,
        EnvError::Panicked { .. } => &WORLD_PANICKED,
        _ => &INVALID_OPTION,
    };
    class.error(py, error.to_string())
}

/// What keeps a call from being done.
pub enum Fault {
    Env(EnvError),
    Closed,
    NotReset,
    /// The first reset was of some lanes only.
    FirstReset,
    /// These lanes rest.
    Resting(Vec<usize>),
}

impl From<EnvError> for Fault {
    fn from(error: EnvError) -> Fault {
        Fault::Env(error)
    }
}
