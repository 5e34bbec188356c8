//! Maps from files: the published package's, where the user has it, or the user's own in their
//! place.
//!
//! A folder of maps is laid out as the published package is: `remedy_rush/level_1.wad`, and beside
//! the levels `level_1_hard.wad`. Each file is a WAD with a UDMF map `MAP01`; its pictures are laid
//! over the IWAD's, and over those of ViZDoom's own file where that lies beside the
//! IWAD. The scenario's rules act on the map at hand: `docs/guide/maps.md` says what they look for.

mod auto;
mod engine_file;
pub(crate) mod files;
pub(crate) mod folder;
mod own_task;

pub use auto::{ask, find_iwad, find_maps};
pub use engine_file::pictures_beside;
pub use folder::{LevelFile, Maps};
pub use own_task::report_tasks_to;
pub(crate) use own_task::say_of_task;
