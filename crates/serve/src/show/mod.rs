//! A world for a viewer. It lives in a thread of its own while the viewer is there, and costs
//! nothing otherwise.
//!
//! | module | what it holds |
//! |---|---|
//! | `performer` | who acts |
//! | `query` | what an address asks for, bounded |
//! | `rehearsal` | an episode acted out once, with what every step brought and what the agent thought |
//! | `repertoire` | an agent's episodes at a glance: seed, return, cost |
//! | `watching` | an episode shown: pause, tic, speed, jumps |
//! | `filming` | an episode as a film to keep |
//! | `playing` | an episode played by a person |
//! | `frame` | a moment as one message: numbers and compressed pictures |
//! | `line` | the WebSocket: frames out, commands in, both bounded |

mod filming;
mod frame;
mod line;
mod performer;
mod playing;
mod query;
mod rehearsal;
mod repertoire;
mod routes;
mod watching;

pub(crate) use filming::film;
pub(crate) use repertoire::episodes;
pub(crate) use routes::{play, watch};
