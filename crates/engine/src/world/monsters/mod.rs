//! What monsters do: hunting and patrols.

pub mod hunt;
pub mod patrol;
#[cfg(test)]
pub mod patrol_tests;
