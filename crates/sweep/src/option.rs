//! A value of an option of `hasard train`.

/// A value of an option of `hasard train`.
#[derive(Clone, PartialEq, Debug)]
pub enum OptionValue {
    /// A switch: given or not.
    Switch(bool),
    /// A text or number, as written on the command line.
    Text(String),
}
