//! What can be wrong with an IWAD's pictures.

use crate::map::TextureName;
use crate::wad::WadError;
use std::fmt;

/// Why a picture set cannot be read from an IWAD.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum IwadError {
    /// The file itself cannot be read.
    Wad(WadError),
    /// A lump that every IWAD has is not there.
    Missing {
        /// Name of the missing lump.
        lump: &'static str,
    },
    /// A lump ends before what it must hold.
    TooShort {
        /// Name of the short lump.
        lump: TextureName,
        /// How long it must be at least.
        least: usize,
        /// How long it is.
        length: usize,
    },
    /// A picture's data lead outside of its lump, or its size is absurd.
    Picture {
        /// The lump's name.
        lump: TextureName,
        /// What is wrong.
        what: &'static str,
    },
    /// The pictures would take more memory or time than any real set needs.
    TooLarge,
}

impl fmt::Display for IwadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            IwadError::Wad(error) => fmt::Display::fmt(error, f),
            IwadError::Missing { lump } => {
                write!(
                    f,
                    "the WAD has no {lump}: it is not a complete game file; give an IWAD such as freedoom2.wad"
                )
            }
            IwadError::TooShort { lump, least, length } => {
                write!(
                    f,
                    "broken WAD: {lump:?} has {length} bytes and needs {least}; fetch the file again"
                )
            }
            IwadError::Picture { lump, what } => {
                write!(f, "broken WAD: picture {lump:?}: {what}; fetch the file again")
            }
            IwadError::TooLarge => f.write_str(
                "the WAD's pictures are too large to load; give an IWAD such as freedoom2.wad",
            ),
        }
    }
}

impl std::error::Error for IwadError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            IwadError::Wad(error) => Some(error),
            _ => None,
        }
    }
}

impl From<WadError> for IwadError {
    fn from(error: WadError) -> IwadError {
        IwadError::Wad(error)
    }
}
