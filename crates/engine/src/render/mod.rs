//! Pictures of a world: first-person colour, depth and labels with the status bar, and the top-down
//! map.
//!
//! The folders stand in the order of a frame, and each imports only from those before it
//! (docs/rendering.md walks through them).
//!
//! A [`Scene`] is a map made ready for drawing with a set of pictures, a [`View`] is the tables of
//! a frame size; both are immutable and shared. A [`Renderer`] holds the frames of one world. All
//! arithmetic is on integers, so that the same world gives the same pixels everywhere.

// Physics and pixels are whole numbers: a floating-point operation here is a mistake.
#![cfg_attr(not(test), deny(clippy::float_arithmetic))]

mod automap;
mod blocks;
mod buffers;
mod colour;
#[cfg(test)]
mod measured_tests;
mod output;
mod overlay;
mod patch;
mod planes;
mod published_depth;
#[cfg(test)]
mod render_tests;
mod renderer;
mod scene;
mod scratch;
mod sprites;
mod textures;
mod view;
mod walls;

pub use automap::TopDown;
pub use buffers::frame::class;
pub use buffers::labels::{InView, Label};
pub use buffers::request::Buffers;
pub use output::segmentation::SegmentationColours;
pub use renderer::{RenderOptions, Renderer};
pub use scene::prepared::Scene;
pub use scratch::FrameScratch;
pub use view::size::{FrameSize, SizeError};
pub use view::tables::View;
