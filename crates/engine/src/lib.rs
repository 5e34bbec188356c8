//! The engine of HASARD: a deterministic Doom-like world that advances tic by tic (35 a second),
//! and its picture.
//!
//! | module | what it holds |
//! |---|---|
//! | [`math`] | 16.16 fixed point, binary angles, frozen trigonometry, the random stream |
//! | [`map`] | UDMF text in and out, the map builder, the BSP and blockmap; a built map is immutable and shared |
//! | [`assets`] | palette, light tables, textures, sprites, status-bar art: the embedded set, or an IWAD |
//! | [`wad`] | the container that maps and pictures come in |
//! | [`world`] | things, movement, sector movers, weapons, monsters, events: plain data, `Clone` is a snapshot |
//! | [`simd`] | which vector instructions are used: every variant gives the same bits |
//! | [`render`] | first-person colour, depth and labels, status bar, top-down map |
//!
//! The engine knows no reward, no scenario, no thread and no file system.

// They panic where a stream is closed or its disk is full.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]
#![cfg_attr(
    test,
    allow(
        clippy::disallowed_methods,
        clippy::disallowed_types,
        reason = "tests compare with the exact functions"
    )
)]

pub mod assets;
pub mod map;
pub mod math;
#[cfg(test)]
mod mutation;
pub mod render;
pub mod simd;
pub mod wad;
pub mod world;
