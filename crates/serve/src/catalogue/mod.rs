//! Which runs there are, and what is remembered of them.

mod columns;
mod evaluated;
pub(crate) mod files;
mod list;
pub(crate) mod notes;

pub(crate) use list::Catalogue;
