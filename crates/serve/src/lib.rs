//! The page in the browser: runs while they train, agents that are watched, episodes that are
//! played.
//!
//! | module | what it holds |
//! |---|---|
//! | [`Server`] | the socket, the routes, the thread pool |
//! | `guard` | who may ask: Host, Origin, token; headers of every answer |
//! | `door` | how many may ask: connections, and those that ask or take nothing |
//! | `asked` | what an address asks for, refused in words |
//! | `catalogue` | run directories found and read from where they were left off |
//! | `stages` | stages built lately, shared by their viewers |
//! | `shared` | what the routes share |
//! | `runs` | what the page asks of runs |
//! | `episodes` | recorded episodes: the table of the best, downloads, films |
//! | `show` | a world for a viewer: rehearsed and watched, or played; frames over a WebSocket |
//! | `pages` | HTML, CSS and ES modules, embedded |
//!
//! The stage, its views and its controls are those of `hasard-play`: the window and this page are
//! two fronts of it.

// They panic where a stream is closed or its disk is full.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]
#![allow(
    clippy::result_large_err,
    reason = "an answer is the error type of a handler, as axum has it; none is hot"
)]

mod answer;
mod asked;
mod catalogue;
mod door;
mod episodes;
mod guard;
mod pages;
mod runs;
mod server;
mod shared;
mod show;
mod stages;

pub use server::{Server, Settings};
pub use shared::Agents;
