//! Numbers in messages, and what is said of one that cannot be.

use std::fmt;

use crate::error::LearnError;

/// A number in a message. Very large and very small ones have an exponent: 300 digits hide the rest
/// of the line.
pub struct Shown(pub f64);

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Shown(number) = self;
        let plain = *number == 0.0 || !number.is_finite() || (1e-6..1e9).contains(&number.abs());
        if plain { write!(f, "{number}") } else { write!(f, "{number:e}") }
    }
}

/// A range in words.
pub(super) fn range(low: f64, high: f64) -> String {
    let (least, most) = (Shown(low), Shown(high));
    if high == f64::MAX {
        format!("a number of at least {least}")
    } else {
        format!("a number from {least} to {most}")
    }
}

pub(super) fn refuse(
    name: &str,
    given: &dyn fmt::Display,
    allowed: &str,
) -> Result<(), LearnError> {
    Err(LearnError::Config(format!("{name} cannot be {given}; it must be {allowed}")))
}

/// Refuses what is no number of at least 0, as budgets and scales are.
///
/// # Errors
/// Calls the number `name`.
pub fn check_number(name: &str, given: f64) -> Result<(), LearnError> {
    if given.is_finite() && given >= 0.0 {
        return Ok(());
    }
    refuse(name, &Shown(given), &range(0.0, f64::MAX))
}
