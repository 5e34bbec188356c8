//! The built map: cross-referenced lists in fixed point, the BSP tree and the blockmap. Immutable
//! once built.

use super::{Blocks, Locator, TextureName, special};
use crate::math::{Angle, Fixed};

/// Index into [`Map::textures`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct TextureId(pub u16);

/// Index into [`Map::sectors`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct SectorId(pub u32);

/// Index into [`Map::sides`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct SideId(pub u32);

/// A point of the map.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub struct Vertex {
    /// East.
    pub x: Fixed,
    /// North.
    pub y: Fixed,
}

/// What a line stops and how its textures hang.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct LineFlags {
    /// Blocks every walker even where the opening is large enough.
    pub blocking: bool,
    /// What else it stops.
    pub blocks: Blocks,
    /// Upper texture starts at the higher ceiling.
    pub upper_unpegged: bool,
    /// Lower texture hangs from the higher ceiling; a one-sided texture stands on the floor.
    pub lower_unpegged: bool,
}

/// A wall or the border between two sectors.
#[derive(Clone, Debug)]
pub struct Line {
    /// First end.
    pub v1: Vertex,
    /// Second end; the front side is to the right of `v1 -> v2`.
    pub v2: Vertex,
    /// `v2.x - v1.x`.
    pub dx: Fixed,
    /// `v2.y - v1.y`.
    pub dy: Fixed,
    /// West, east, south and north limits.
    pub bounds: [Fixed; 4],
    /// Flags.
    pub flags: LineFlags,
    /// The side to the right.
    pub front: SideId,
    /// The side to the left, if two-sided.
    pub back: Option<SideId>,
    /// The sector to the right.
    pub front_sector: SectorId,
    /// The sector to the left, if two-sided.
    pub back_sector: Option<SectorId>,
    /// Line tag, 0 for none.
    pub id: i32,
    /// Line special, 0 for none.
    pub special: i32,
    /// Arguments of the special.
    pub args: [i32; 5],
}

/// One face of a line.
#[derive(Clone, Copy, Debug)]
pub struct Side {
    /// The sector that it faces.
    pub sector: SectorId,
    /// Texture offset to the right, texels.
    pub offset_x: Fixed,
    /// Texture offset down, texels.
    pub offset_y: Fixed,
    /// Above the opening.
    pub top: Option<TextureId>,
    /// One-sided wall, or masked texture in the opening.
    pub middle: Option<TextureId>,
    /// Below the opening.
    pub bottom: Option<TextureId>,
}

/// A sector as the map starts; what changes during play lives in the world's `SectorState`.
#[derive(Clone, Debug)]
pub struct Sector {
    /// Floor height.
    pub floor: Fixed,
    /// Ceiling height.
    pub ceiling: Fixed,
    /// Floor texture.
    pub floor_texture: TextureId,
    /// Ceiling texture.
    pub ceiling_texture: TextureId,
    /// Light.
    pub light: i16,
    /// Sector special.
    pub special: i32,
    /// Tag, 0 for none.
    pub tag: i32,
    /// West, east, south and north limits of its lines.
    pub bounds: [Fixed; 4],
    /// Indices of the lines that touch it.
    pub lines: Vec<u32>,
}

impl Sector {
    /// Whether its floor takes health before any script says so.
    #[must_use]
    pub fn hurts(&self) -> bool {
        self.special & 0xFF == special::LAVA
    }
}

/// A thing that the map places.
#[derive(Clone, Copy, Debug)]
pub struct MapThing {
    /// East.
    pub x: Fixed,
    /// North.
    pub y: Fixed,
    /// Height above the floor.
    pub height: Fixed,
    /// Facing.
    pub angle: Angle,
    /// Editor number; 1 is the player's start.
    pub kind: i32,
    /// Thing id, 0 for none.
    pub id: i32,
    /// Arguments.
    pub args: [i32; 5],
}

/// A piece of a line that bounds a subsector; the subsector is on its right.
#[derive(Clone, Copy, Debug)]
pub struct Seg {
    /// Start.
    pub v1: Vertex,
    /// End.
    pub v2: Vertex,
    /// Index of the line that it is part of.
    pub line: u32,
    /// The side of the line that faces the subsector.
    pub side: SideId,
    /// Distance from the line's start as seen from this side, for texture columns.
    pub offset: Fixed,
    /// The sector on its right.
    pub front_sector: SectorId,
    /// The sector on its left, if two-sided.
    pub back_sector: Option<SectorId>,
}

/// A convex piece of a sector.
#[derive(Clone, Copy, Debug)]
pub struct Subsector {
    /// The sector that it is part of.
    pub sector: SectorId,
    /// First of its segs in [`Map::segs`].
    pub first_seg: u32,
    /// Number of its segs.
    pub seg_count: u32,
}

/// A partition line of the BSP tree. Children: index of a node, or of a subsector when
/// [`Node::SUBSECTOR`] is set.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// A point on the partition line.
    pub x: Fixed,
    /// A point on the partition line.
    pub y: Fixed,
    /// Its direction.
    pub dx: Fixed,
    /// Its direction.
    pub dy: Fixed,
    /// Limits (west, east, south, north) of the right and the left child.
    pub bounds: [[Fixed; 4]; 2],
    /// Right child, left child.
    pub children: [u32; 2],
}

impl Node {
    /// Marks a child that is a subsector.
    pub const SUBSECTOR: u32 = 1 << 31;
}

/// Lines by 128-unit block.
#[derive(Clone, Debug, Default)]
pub struct Blockmap {
    /// West edge of block column 0.
    pub origin_x: Fixed,
    /// South edge of block row 0.
    pub origin_y: Fixed,
    /// Number of columns.
    pub columns: i32,
    /// Number of rows.
    pub rows: i32,
    /// Row-major: start of each block's run in `lines`, with one end entry more.
    pub starts: Vec<u32>,
    /// Line indices, block after block.
    pub lines: Vec<u32>,
    /// The limits of these lines, as [`Line::bounds`]: side by side, as most lines around a body
    /// are only found to lie apart.
    pub bounds: Vec<[Fixed; 4]>,
}

/// A built map. Worlds share it behind an `Arc` and never change it.
#[derive(Clone, Debug)]
pub struct Map {
    /// Its name, for messages.
    pub name: String,
    /// Every texture name that the map mentions, and those interned on building for scripts.
    pub textures: Vec<TextureName>,
    /// Vertices.
    pub vertices: Vec<Vertex>,
    /// Lines.
    pub lines: Vec<Line>,
    /// Sides.
    pub sides: Vec<Side>,
    /// Sectors.
    pub sectors: Vec<Sector>,
    /// Things.
    pub things: Vec<MapThing>,
    /// Segs, grouped by subsector.
    pub segs: Vec<Seg>,
    /// Convex leaves.
    pub subsectors: Vec<Subsector>,
    /// BSP nodes, the root last; empty when there is a single subsector.
    pub nodes: Vec<Node>,
    /// Lines by block.
    pub blockmap: Blockmap,
    /// Where searches of the tree begin.
    pub locator: Locator,
    /// (tag, sector) sorted by tag then sector.
    pub tags: Vec<(i32, SectorId)>,
}

impl Map {
    /// The sectors with `tag`, in map order.
    pub fn tagged(&self, tag: i32) -> impl Iterator<Item = SectorId> + '_ {
        let start = self.tags.partition_point(|&(t, _)| t < tag);
        self.tags[start..].iter().take_while(move |&&(t, _)| t == tag).map(|&(_, sector)| sector)
    }

    /// The id of a texture that the map mentions or that was interned on building.
    #[must_use]
    pub fn texture(&self, name: &str) -> Option<TextureId> {
        let name = TextureName::new(name);
        self.textures.iter().position(|&t| t == name).map(|i| TextureId(i as u16))
    }

    /// The subsector that contains a point.
    #[must_use]
    pub fn subsector_at(&self, x: Fixed, y: Fixed) -> &Subsector {
        let Some(root) = self.nodes.len().checked_sub(1) else { return &self.subsectors[0] };
        let child = self.locator.start(x, y, root as u32);
        self.subsector_below(child, x, y)
    }

    /// The subsector below a child of the tree that contains a point.
    pub(super) fn subsector_below(&self, mut child: u32, x: Fixed, y: Fixed) -> &Subsector {
        while child & Node::SUBSECTOR == 0 {
            let node = &self.nodes[child as usize];
            child = node.children[usize::from(node.is_left(x, y))];
        }
        &self.subsectors[(child & !Node::SUBSECTOR) as usize]
    }

    /// Whether a point lies in any sector at all. Behind walls there is nothing, but
    /// [`Map::subsector_at`] still gives the nearest piece by the tree.
    #[must_use]
    pub fn is_inside(&self, x: Fixed, y: Fixed) -> bool {
        let subsector = self.subsector_at(x, y);
        let segs = &self.segs[subsector.first_seg as usize..][..subsector.seg_count as usize];
        segs.iter().filter(|seg| seg.back_sector.is_none()).all(|seg| {
            let line = &self.lines[seg.line as usize];
            let (px, py) =
                (i64::from(x.0) - i64::from(line.v1.x.0), i64::from(y.0) - i64::from(line.v1.y.0));
            py * i64::from(line.dx.0) <= px * i64::from(line.dy.0)
        })
    }

    /// The sector under a point.
    #[must_use]
    pub fn sector_at(&self, x: Fixed, y: Fixed) -> SectorId {
        self.subsector_at(x, y).sector
    }
}

impl Node {
    /// Whether a point is on the left of the partition line (points on it are right).
    #[must_use]
    pub fn is_left(&self, x: Fixed, y: Fixed) -> bool {
        let (px, py) = (i64::from(x.0) - i64::from(self.x.0), i64::from(y.0) - i64::from(self.y.0));
        py * i64::from(self.dx.0) - px * i64::from(self.dy.0) > 0
    }
}
