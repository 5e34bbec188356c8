//! Contact sheets: how they are laid out.

pub mod layout;
