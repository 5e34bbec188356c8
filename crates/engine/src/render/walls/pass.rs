//! What the pass over the walls reads and writes.

use crate::render::blocks::padded;
use crate::render::buffers::clip::ColumnClip;
use crate::render::buffers::drawsegs::list::DrawSegs;
use crate::render::buffers::frame::Columns;
use crate::render::buffers::sectors::SurfaceCache;
use crate::render::buffers::visplane::VisPlanes;
use crate::render::published_depth::PublishedDepth;
use crate::render::scene::prepared::{Scene, SceneSeg, Sidedef};
use crate::render::view::camera::Camera;
use crate::render::view::depth::DepthEncoding;
use crate::render::view::line::ProjectedLine;
use crate::render::view::tables::View;
use crate::render::view::view_space::ViewLine;
use crate::render::walls::batch::data::WallBatch;
use crate::simd::Simd;
use crate::world::World;

/// Everything that the walk reads and writes.
pub(crate) struct WallPass<'a> {
    pub scene: &'a Scene,
    pub view: &'a View,
    pub camera: &'a Camera,
    pub world: &'a World,
    pub surfaces: &'a mut SurfaceCache,
    /// Index of the picture that each texture shows now.
    pub pictures: &'a [u32],
    pub depths: DepthEncoding,
    pub columns: &'a mut Columns,
    pub clip: &'a mut ColumnClip,
    pub planes: &'a mut VisPlanes,
    pub drawsegs: &'a mut DrawSegs,
    /// Sectors that were entered.
    pub entered: &'a mut [bool],
    pub scratch: &'a mut WallScratch,
    /// Columns of walls that wait to be drawn.
    pub walls: &'a mut WallBatch,
    /// If depth is written as ViZDoom writes it.
    pub published: Option<&'a mut PublishedDepth>,
    pub simd: Simd,
}

/// Memory that the walk reuses.
#[derive(Debug, Default)]
pub(crate) struct WallScratch {
    /// Children to visit later: node index times two, plus the side.
    pub stack: Vec<u32>,
    /// Segs of the subsector at hand that face the eye and matter.
    pub facing: Vec<u32>,
    /// Rows of the upper end of the part of a wall that is being drawn.
    pub upper: Vec<i16>,
    /// Rows of its lower end.
    pub lower: Vec<i16>,
    /// Its columns, where it bears soot.
    pub decal_columns: Vec<DecalColumn>,
}

impl WallScratch {
    /// Has room for frames of `width` columns of a scene.
    pub fn fit(&mut self, scene: &Scene, width: usize) {
        self.stack.resize(scene.nodes.len() + 2, 0);
        self.facing.resize(scene.most_segs + 1, 0);
        self.upper.resize(padded(width), 0);
        self.lower.resize(padded(width), 0);
    }
}

/// A seg in view, on its way through the stages.
pub(crate) struct SeenSeg<'a> {
    pub index: u32,
    pub seg: &'a SceneSeg,
    pub face: &'a Sidedef,
    /// Its line before the eye.
    pub turned: ViewLine,
    /// Its line.
    pub line: ProjectedLine,
    /// Its line as drawn between the whole columns of its ends.
    pub ends: ProjectedLine,
    /// Inverse distances of its farther and its nearer end.
    pub inverses: [i64; 2],
    /// Frame columns.
    pub first: usize,
    pub end: usize,
    /// First base column and one past the last.
    pub base_ends: [i64; 2],
}

/// A column of a wall that bears soot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DecalColumn {
    /// Frame column.
    pub x: usize,
    /// First frame row of the wall, and one past the last.
    pub rows: [usize; 2],
    /// Position along the line, 16.16.
    pub along: i64,
    /// Light table.
    pub table: usize,
    /// Change of the stain's texel row a base row, 32 fractional bits.
    pub step: i64,
    /// The same from the lower edge of base row 0 to the horizon.
    pub to_horizon: i64,
    pub depth: u8,
}
