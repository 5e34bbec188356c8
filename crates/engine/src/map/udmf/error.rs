//! What can be wrong with UDMF text.

use std::fmt;

/// A fault in UDMF text and where it is.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct UdmfError {
    /// Line, counted from 1.
    pub line: usize,
    /// Column in bytes, counted from 1.
    pub column: usize,
    /// What is wrong.
    pub fault: UdmfFault,
}

/// What is wrong with UDMF text.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum UdmfFault {
    /// Something else than the grammar asks for.
    Expected {
        /// What should stand there.
        what: &'static str,
        /// What does.
        found: String,
    },
    /// A comment or string that never ends.
    Unterminated {
        /// `comment` or `string`.
        what: &'static str,
    },
    /// A number that cannot be read or represented.
    Number {
        /// As written.
        text: String,
    },
    /// A known field with a value of another kind or range.
    Value {
        /// The field.
        field: String,
        /// What it takes.
        wants: &'static str,
    },
    /// A block without a field that it must have.
    MissingField {
        /// The kind of block.
        block: &'static str,
        /// The field.
        field: &'static str,
    },
    /// Blocks before, or without, a `namespace`.
    NoNamespace,
}

impl UdmfError {
    /// The fault at a byte offset of `text`.
    pub(super) fn at(text: &[u8], offset: usize, fault: UdmfFault) -> UdmfError {
        let before = &text[..offset.min(text.len())];
        let line = 1 + before.iter().filter(|&&byte| byte == b'\n').count();
        let column = 1 + before.iter().rev().take_while(|&&byte| byte != b'\n').count();
        UdmfError { line, column, fault }
    }
}

impl fmt::Display for UdmfError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {} column {}: ", self.line, self.column)?;
        match &self.fault {
            UdmfFault::Expected { what, found } => write!(f, "expected {what}, found {found}"),
            UdmfFault::Unterminated { what } => write!(f, "this {what} never ends; close it"),
            UdmfFault::Number { text } => write!(f, "`{text}` is not a number that a map can hold"),
            UdmfFault::Value { field, wants } => write!(f, "`{field}` takes {wants}"),
            UdmfFault::MissingField { block, field } => {
                write!(f, "this {block} has no `{field}`; add it")
            }
            UdmfFault::NoNamespace => {
                f.write_str("the map must begin with `namespace = \"zdoom\";`")
            }
        }
    }
}

impl std::error::Error for UdmfError {}
