//! The world as a whole: its state, the slots that actors live in, its fingerprint.

pub mod animation;
pub mod arena;
pub mod fingerprint;
pub mod spawn;
pub mod world;
