//! How exact a film's pictures are.

use crate::MediaError;
use std::str::FromStr;

/// From 0, the smallest files, to 100, pictures as good as exact. Every frame of a film is as exact
/// as every other, whatever happens in it: the size follows.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Quality(u8);

impl Default for Quality {
    fn default() -> Quality {
        Quality(55)
    }
}

impl Quality {
    /// The quality as a number, 0 to 100.
    #[must_use]
    pub fn value(self) -> u8 {
        self.0
    }

    /// The quantiser of H.264: 50 at quality 0, 0 at quality 100.
    #[must_use]
    pub(crate) fn quantiser(self) -> u8 {
        50 - self.0 / 2
    }
}

impl FromStr for Quality {
    type Err = MediaError;

    fn from_str(text: &str) -> Result<Quality, MediaError> {
        let given = text.parse::<u8>().ok().filter(|value| *value <= 100);
        given.map(Quality).ok_or_else(|| {
            MediaError::Size(format!("a film cannot have the quality {text}; give 0 to 100"))
        })
    }
}
