//! What the pass over the walls reads and writes.

use crate::render::blocks::padded;
use crate::render::buffers::clip::Openings;
use crate::render::buffers::drawsegs::list::Silhouettes;
use crate::render::buffers::frame::Columns;
use crate::render::buffers::sectors::Looks;
use crate::render::buffers::visplane::Planes;
use crate::render::published_depth::decal::SootDepth;
use crate::render::scene::prepared::{Face, Scene, SceneSeg};
use crate::render::view::camera::Camera;
use crate::render::view::depth::Depths;
use crate::render::view::line::SeenLine;
use crate::render::view::tables::View;
use crate::render::view::view_space::TurnedLine;
use crate::render::walls::batch::data::WallBatch;
use crate::simd::Simd;
use crate::world::World;

/// Everything that the walk reads and writes.
pub(crate) struct Walk<'a> {
    pub scene: &'a Scene,
    pub view: &'a View,
    pub camera: &'a Camera,
    pub world: &'a World,
    pub looks: &'a mut Looks,
    /// Index of the picture that each texture shows now.
    pub pictures: &'a [u32],
    pub depths: Depths,
    pub columns: &'a mut Columns,
    pub openings: &'a mut Openings,
    pub planes: &'a mut Planes,
    pub silhouettes: &'a mut Silhouettes,
    /// Sectors that were entered.
    pub entered: &'a mut [bool],
    pub scratch: &'a mut WalkScratch,
    /// Columns of walls that wait to be drawn.
    pub walls: &'a mut WallBatch,
    pub simd: Simd,
}

/// Memory that the walk reuses.
#[derive(Debug, Default)]
pub(crate) struct WalkScratch {
    /// Children to visit later: node index times two, plus the side.
    pub stack: Vec<u32>,
    /// Segs of the subsector at hand that face the eye and matter.
    pub facing: Vec<u32>,
    /// Rows of the upper end of the part of a wall that is being drawn.
    pub upper: Vec<i16>,
    /// Rows of its lower end.
    pub lower: Vec<i16>,
    /// Its columns, where it bears soot.
    pub sooty: Vec<SootyColumn>,
    pub soot_depth: SootDepth,
}

impl WalkScratch {
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
    pub face: &'a Face,
    /// Its line before the eye.
    pub turned: TurnedLine,
    /// Its line.
    pub line: SeenLine,
    /// Its line as drawn between the whole columns of its ends.
    pub ends: SeenLine,
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
pub(crate) struct SootyColumn {
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
