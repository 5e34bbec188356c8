//! How many columns are turned together.

/// Columns that are turned together, so that the lines of their rows stay near.
pub(crate) const STRIP: usize = 16;
