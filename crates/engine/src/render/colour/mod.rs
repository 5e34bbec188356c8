//! The palette: what tints it, and what shines through something else.

pub mod blend;
pub mod palette;
pub mod tint;
