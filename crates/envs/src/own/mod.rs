//! Own scenarios: a task is one file, read once into tables. `docs/guide/own_task.md` has the whole
//! format.

mod check;
mod fields;
mod generate;
mod intern;
pub(crate) use intern::intern;
mod layers;
mod map_file;
mod mistakes;
mod model;
mod open;
mod opening;
mod place;
mod placing;
mod program;
mod read;
mod read_map;
mod read_parts;
mod read_spawns;
mod read_tiles;
mod read_whens;
mod rehearsal;
#[cfg(test)]
mod rule_tests;
mod rules;
mod task;
mod template;
#[cfg(test)]
mod tests;
mod textures;
mod tiles;
mod tree;
mod walkers;
#[cfg(test)]
mod world_tests;

pub use mistakes::Mistake;
pub use open::open;
pub use place::{
    LARGEST_TEXT, changed, fingerprint, is_file, path_and_level, read_text, read_to_check,
};
pub use task::{Checked, check, recall, register};
pub use template::template;
