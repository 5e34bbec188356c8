//! Pictures as they are drawn from: walls, flats, posts of midtextures, sprites.

pub mod hud;
pub mod local_palette;
pub mod midtexture;
pub mod picture;
pub mod sprite;
