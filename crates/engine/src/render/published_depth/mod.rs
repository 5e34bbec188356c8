//! All that exists only for depth as ViZDoom writes it.

pub mod decal;
pub mod midtexture;
pub mod quads;
