//! What a world is: plain data, and the slots that actors live in.

pub mod actor;
pub mod arena;
pub mod command;
pub mod event;
pub mod fingerprint;
pub mod player;
pub mod sector;
pub mod spawn;
pub mod world;
