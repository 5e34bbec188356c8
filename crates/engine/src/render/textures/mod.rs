//! Pictures as they are drawn from: walls, flats, posts of midtextures, sprites.

pub mod flat;
pub mod hud;
pub mod local_palette;
pub mod masked;
pub mod midtexture;
pub mod set;
pub mod sprite;
pub mod wall;
