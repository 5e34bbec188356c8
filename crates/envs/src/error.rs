//! What can go wrong, each with the input that caused it and the remedy.

use std::fmt;

/// An error of this crate. Its text is one line that names the input and the remedy.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum EnvError {
    /// No environment has this id.
    UnknownId {
        /// What was asked for.
        id: String,
        /// The nearest id that exists; empty if none is near.
        nearest: String,
    },
    /// An option has a value that it cannot take.
    Option {
        /// Name of the option.
        option: &'static str,
        /// What was given.
        given: String,
        /// What it may be.
        allowed: String,
    },
    /// A policy's text says nothing that can be followed.
    Policy {
        /// What was given.
        given: String,
        /// What is wrong with it, and what would be right.
        why: String,
    },
    /// A button has no such name.
    UnknownButton {
        /// What was given.
        given: String,
    },
    /// An action is outside of the action space.
    Action {
        /// Lane of the batch (0 for a single environment).
        lane: usize,
        /// What is wrong with it.
        why: String,
    },
    /// A batch's buffer has another size than its group of lanes needs.
    BatchSize {
        /// Name of the field.
        field: &'static str,
        /// Its length.
        given: usize,
        /// The length needed.
        needed: usize,
    },
    /// An environment does not fit into a batch with the others.
    Unlike {
        /// Its lane.
        lane: usize,
        /// In what it differs.
        what: &'static str,
    },
    /// What was saved is spoiled, or was saved from another environment.
    Saved {
        /// What is wrong with it.
        why: String,
    },
    /// A group of lanes was used out of turn.
    Turn {
        /// What was out of turn, and what must come first.
        why: String,
    },
    /// An environment panicked; the batch of worlds cannot go on.
    Panicked {
        /// The panic's message.
        message: String,
    },
    /// A scenario's file cannot be read, or says what no scenario can be.
    Scenario {
        /// Which file, where in it, and what would be right.
        why: String,
    },
    /// A map could not be built, or lacks something that its scenario needs.
    Map {
        /// Which map, and what is wrong.
        why: String,
    },
}

impl fmt::Display for EnvError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            EnvError::UnknownId { id, .. } if id.contains(".toml") => {
                write!(
                    f,
                    "{id}: a task's file is no id; give a path that ends in .toml, or the id that own::open gives"
                )
            }
            EnvError::UnknownId { id, nearest } if nearest.is_empty() => {
                write!(
                    f,
                    "no environment is called '{id}'; `hasard envs` lists them all, and a task of your own is named by its file"
                )
            }
            EnvError::UnknownId { id, nearest } => {
                write!(
                    f,
                    "no environment is called '{id}'; the nearest is '{nearest}', and `hasard envs` lists them all"
                )
            }
            EnvError::Option { option, given, allowed } => {
                write!(f, "{option} cannot be {given}; it must be {allowed}")
            }
            EnvError::Policy { given, why } => write!(f, "policy '{given}': {why}"),
            EnvError::UnknownButton { given } => write!(
                f,
                "no button is called '{given}'; join names like MOVE_FORWARD, TURN_LEFT, ATTACK by '+', delta buttons as NAME=DEGREES; noop presses none"
            ),
            EnvError::Action { lane, why } => write!(f, "action of lane {lane}: {why}"),
            EnvError::BatchSize { field, given, needed } => {
                write!(
                    f,
                    "batch field {field} has length {given}, but its lanes need {needed}; make batches with VecEnv::batch"
                )
            }
            EnvError::Unlike { lane, what } => {
                write!(
                    f,
                    "the environment of lane {lane} has another {what} than the first; all lanes of a batch must be alike"
                )
            }
            EnvError::Saved { why } => f.write_str(why),
            EnvError::Turn { why } => f.write_str(why),
            EnvError::Panicked { message } => {
                write!(
                    f,
                    "an environment panicked ({message}); this is a fault of hasard, please report it"
                )
            }
            EnvError::Map { why } | EnvError::Scenario { why } => f.write_str(why),
        }
    }
}

impl std::error::Error for EnvError {}

/// The beginning of what a user gave, for a message: one line, and nothing that commands a
/// terminal.
pub(crate) fn excerpt(given: &str) -> String {
    given.chars().take(80).flat_map(char::escape_debug).collect()
}
