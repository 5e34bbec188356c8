//! What can be done: action spaces and commands by name.

pub mod action;
mod together;
