//! Sprites, particles and midtextures, far to near: the third pass of a frame.

pub mod draw_particles;
pub mod midcolumn;
pub mod midtexture;
pub mod particles;
pub mod pass;
pub mod posts;
pub mod sprite;
