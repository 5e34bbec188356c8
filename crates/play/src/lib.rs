//! Episodes as people meet them: recorded, played again at any size, and played by hand.
//!
//! | module | what it holds |
//! |---|---|
//! | [`Stage`] | an environment that is shown tic by tic while its agent acts step by step |
//! | [`Recorder`], [`Replay`] | episodes into files and back |
//! | [`Views`] | a moment as pictures: colour, depth, segmentation, labels, grey, automap, side by side |
//! | [`Film`] | an episode as MP4 or GIF |
//! | [`Controls`] | keys and mouse as actions |
//! | [`guide`] | what a task asks of a person, and the keys it has |
//! | `panel` | time, return, cost and budget beside the game |
//! | [`Overlay`] | rewards and costs over the picture where they happen |
//! | `window` | the window (feature `window`) |
//!
//! ```
//! use hasard_envs::{Env, EnvOptions};
//! use hasard_play::{Recorder, Replay};
//! let mut env = Env::new("RemedyRushLevel1-v0", &EnvOptions::default())?;
//! let mut recorder = Recorder::begin(&mut env, 7, "example")?;
//! for _ in 0..50 {
//!     env.step(&[1, 1, 0, 0], &[])?;
//!     recorder.push(&[1, 1, 0, 0], &[])?;
//! }
//! let file = recorder.finish(&env);
//! let mut replay = Replay::new(file, "example.episode".as_ref(), &EnvOptions::default())?;
//! while replay.tic() {
//!     // draw a moment: Views::draw(replay.stage())
//! }
//! assert_eq!(replay.difference(), None);
//! # Ok::<(), hasard_play::PlayError>(())
//! ```

// They panic where a stream is closed or its disk is full.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

#[cfg(any(feature = "window", test))]
mod card;
mod controls;
mod error;
mod film;
pub mod guide;
mod overlay;
mod panel;
mod recording;
mod stage;
mod views;
#[cfg(feature = "window")]
mod window;
pub mod witness;

pub use controls::{Controls, Key};
pub use error::PlayError;
pub use film::Film;
pub use overlay::{Overlay, plain, with_strip};
pub use panel::{Panel, with_panel};
pub use recording::{
    Recorder, Replay, keep_episode, kept_results, option_names, options_from_names,
};
pub use stage::{Moment, Stage};
pub use views::{ViewKind, Views};
#[cfg(feature = "window")]
pub use window::{KEYS, PlaySettings, play};

/// A result that a person's is held against: of an agent or another person, within the budget.
#[derive(Clone, Debug, PartialEq)]
pub struct Rival {
    /// Whose it is.
    pub who: String,
    /// Its return.
    pub episode_return: f64,
}

#[cfg(test)]
mod tests;
