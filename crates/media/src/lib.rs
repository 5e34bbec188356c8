//! What leaves hasard as a picture, an animation or a recorded episode.
//!
//! | module | what it holds |
//! |---|---|
//! | [`Picture`] | red, green, blue pixels, and drawing on them |
//! | [`png`] | PNG files, written and read |
//! | [`gif`] | animated GIF |
//! | `video` | MP4, of a [`Quality`] |
//! | [`AnimationWriter`] | either, by the name of the file |
//! | [`compose`] | several views of one moment side by side, with captions |
//! | [`text`] | captions |
//! | [`episode`] | the episode file: environment, options, seed and actions, enough to play an episode again |
//! | [`files`] | files that are written whole or not at all |
//! | [`shell`] | words quoted for commands that are to be pasted |
//!
//! This crate knows no world and no environment: pixels and actions come from its caller.
//!
//! ```
//! use hasard_media::{Picture, compose::{Panel, side_by_side}};
//! let colour = Picture::filled(160, 120, [90, 40, 20]);
//! let depth = Picture::from_grey(160, 120, &vec![128; 160 * 120]).unwrap();
//! let both = side_by_side(&[Panel::new(&colour, "colour"), Panel::new(&depth, "depth")], 1);
//! assert!(both.width() > 2 * 160);
//! ```

// They panic where a stream is closed or its disk is full.
#![cfg_attr(not(test), deny(clippy::print_stdout, clippy::print_stderr))]

mod animation;
pub mod compose;
pub mod episode;
mod error;
pub mod files;
pub mod gif;
mod picture;
pub mod png;
mod quality;
mod quantise;
pub mod shell;
pub mod text;
mod video;

pub use animation::AnimationWriter;
pub use error::MediaError;
pub use picture::Picture;
pub use quality::Quality;
