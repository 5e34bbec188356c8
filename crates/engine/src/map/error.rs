//! What can be wrong with a map.

use std::fmt;

/// Why a [`MapSource`](super::MapSource) cannot be built. Each variant names the element and what
/// to mend.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum MapError {
    /// More elements than a map may have.
    TooMany {
        /// What there is too much of (`lines`, `sectors`, ...).
        what: &'static str,
        /// How many the map has.
        count: usize,
        /// How many it may have.
        limit: usize,
    },
    /// The map has none of something that it needs.
    Missing {
        /// What is missing.
        what: &'static str,
    },
    /// An element refers to another that does not exist.
    Index {
        /// The kind of the element (`linedef`, ...).
        element: &'static str,
        /// Its index.
        index: usize,
        /// The field that refers.
        field: &'static str,
        /// The index that it names.
        refers_to: usize,
        /// How many there are to name.
        count: usize,
    },
    /// A number is outside what the engine can represent.
    Range {
        /// The kind of the element.
        element: &'static str,
        /// Its index.
        index: usize,
        /// The field.
        field: &'static str,
        /// Its value, as text.
        value: String,
        /// The largest magnitude allowed.
        limit: i32,
    },
    /// The lines of a sector do not close.
    Unclosed {
        /// Index of the sector.
        sector: usize,
        /// Index of the vertex where an outline begins without ending or ends without beginning.
        vertex: usize,
    },
    /// Building would take more time or memory than any sensible map needs.
    TooComplex {
        /// Which bound was met.
        what: &'static str,
    },
}

impl fmt::Display for MapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MapError::TooMany { what, count, limit } => {
                write!(
                    f,
                    "the map has {count} {what}, more than the {limit} allowed; split or simplify it"
                )
            }
            MapError::Missing { what } => {
                write!(f, "the map has no {what}; a map needs at least one")
            }
            MapError::Index { element, index, field, refers_to, count } => {
                write!(
                    f,
                    "{element} {index}: {field} names number {refers_to}, but there are only {count}; mend the index"
                )
            }
            MapError::Range { element, index, field, value, limit } => {
                write!(
                    f,
                    "{element} {index}: {field} is {value}, outside -{limit}..={limit}; move it into that range"
                )
            }
            MapError::Unclosed { sector, vertex } => {
                write!(f, "sector {sector}: its outline is open at vertex {vertex}; close it")
            }
            MapError::TooComplex { what } => {
                write!(f, "the map is too complex to build: {what}; simplify it")
            }
        }
    }
}

impl std::error::Error for MapError {}
