//! What a world is made of: plain data, each part by itself.

pub mod actor;
pub mod by_sector;
pub mod command;
pub mod crossing;
pub mod event;
pub mod face;
pub mod hands;
pub mod lights;
pub mod lines;
pub mod movers;
pub mod player;
pub mod riders;
pub mod sector;
pub mod soot;
pub mod trail;
pub mod waggle;
