//! Contact sheets: which moments they show, and how they are laid out.

pub mod layout;
pub mod moments;
