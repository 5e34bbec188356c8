//! Maps: the editable source (UDMF), the builder that authors it in Rust, and the built, immutable
//! form.

mod arrangement;
mod blockmap;
mod blocks;
mod bsp;
mod build;
#[cfg(test)]
mod build_tests;
mod builder;
mod built;
mod error;
#[cfg(test)]
mod hostile_tests;
mod locator;
mod source;
pub mod special;
mod stand_ins;
#[cfg(test)]
mod stone_room;
mod tile_grid;
pub mod udmf;

pub use blocks::Blocks;
pub use builder::{BuilderError, MapBuilder, Mark, Style};
pub use built::{
    Blockmap, Line, LineFlags, Map, MapThing, Node, Sector, SectorId, Seg, Side, SideId, Subsector,
    TextureId, Vertex,
};
pub use error::MapError;
pub use locator::Locator;
pub use source::{
    MapSource, SourceLine, SourceSector, SourceSide, SourceThing, SourceVertex, TextureName,
};
pub(crate) use stand_ins::STAND_INS;
#[cfg(test)]
pub(crate) use stone_room::stone_room;
pub use tile_grid::TileGrid;
