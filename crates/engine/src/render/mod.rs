//! Pictures of a world: first-person colour, depth and labels with the status bar, and the top-down map.
//!
//! A [`Scene`] is a map made ready for drawing with a set of pictures, a [`View`] is the tables of a frame size; both
//! are immutable and shared. A [`Renderer`] holds the frames of one world. All arithmetic is on integers, so
//! that the same world gives the same pixels everywhere.

// Physics and pixels are whole numbers: a floating-point operation here is a mistake.
#![cfg_attr(not(test), deny(clippy::float_arithmetic))]

mod blend;
mod camera;
mod column;
#[cfg(target_arch = "x86_64")]
mod column_wide;
mod convert;
#[cfg(target_arch = "x86_64")]
mod convert_wide;
mod depth;
mod fence;
mod fence_depth;
mod fours;
mod frame;
mod horizon;
mod label;
mod light;
mod look;
mod masked;
mod masked_column;
mod masked_texture;
#[cfg(target_arch = "x86_64")]
mod masked_wide;
#[cfg(test)]
mod measured_tests;
mod narrow;
#[cfg(target_arch = "x86_64")]
mod narrow_wide;
mod openings;
mod own_colours;
#[cfg(target_arch = "x86_64")]
mod own_wide;
mod palette;
mod picture;
mod plane;
#[cfg(target_arch = "x86_64")]
mod plane_wide;
#[cfg(test)]
mod render_tests;
mod renderer;
mod row_walk;
#[cfg(target_arch = "x86_64")]
mod row_wide;
mod scene;
mod seg;
mod segmentation;
mod silhouette;
#[cfg(target_arch = "x86_64")]
mod silhouette_wide;
mod size;
mod sky;
#[cfg(target_arch = "x86_64")]
mod sky_wide;
mod soot;
mod soot_depth;
#[cfg(target_arch = "x86_64")]
mod span_wide;
mod sprite;
mod sprite_picture;
mod stamp;
#[cfg(target_arch = "x86_64")]
mod stamp_wide;
mod status_bar;
mod top_down;
mod trail;
mod turn;
mod turned;
mod view;
mod walk;
mod wall;
#[cfg(target_arch = "x86_64")]
mod wall_avx2;
#[cfg(target_arch = "x86_64")]
mod wall_list;
#[cfg(target_arch = "x86_64")]
mod wall_wide;
mod weapon;
mod weapon_cache;
mod workspace;

pub use frame::class;
pub use label::{InView, Label};
pub use renderer::{RenderOptions, Renderer};
pub use scene::Scene;
pub use segmentation::SegmentationColours;
pub use size::{FrameSize, SizeError};
pub use top_down::TopDown;
pub use view::View;

/// Which buffers are drawn beside the colours.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Buffers {
    /// Depth, 0 near to 255 far.
    pub depth: bool,
    /// What each pixel shows, and the list of actors in view.
    pub labels: bool,
}
