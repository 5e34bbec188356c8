//! Maps: the editable source (UDMF), the builder that authors it in Rust, and the built, immutable form.

mod built;
mod source;

pub use built::{
    Blockmap, Line, LineFlags, Map, MapThing, Node, Sector, SectorId, Seg, Side, SideId, Subsector, TextureId, Vertex,
};
pub use source::{MapSource, SourceLine, SourceSector, SourceSide, SourceThing, SourceVertex, TextureName};
