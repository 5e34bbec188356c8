//! Where things go: collision, steps, slides along walls, lines of sight.

pub mod collision;
pub mod movement;
pub mod sight;
pub mod slide;
