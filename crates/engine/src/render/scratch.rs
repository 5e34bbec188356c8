//! Memory that a frame is drawn in and that nothing reads afterwards: a value that the caller owns
//! and passes in.
//!
//! One for each thread is best. If each of the worlds that a thread steps in turn had such memory
//! of its own, that of a batch of 32 would not fit the second cache of a core, and every frame
//! would begin with cold memory: 2 to 4 % of a step.

use crate::render::buffers::clip::ColumnClip;
use crate::render::buffers::drawsegs::list::DrawSegs;
use crate::render::buffers::frame::{Columns, Frame};
use crate::render::buffers::sectors::SurfaceCache;
use crate::render::buffers::visplane::{Span, VisPlanes};
use crate::render::overlay::weapon_cache::WeaponCache;
use crate::render::patch::data::PatchColumns;
use crate::render::scene::prepared::Scene;
use crate::render::sprites::particles::Particles;
use crate::render::sprites::sprite::Sprites;
use crate::render::view::tables::View;
use crate::render::walls::batch::data::WallBatch;
use crate::render::walls::pass::WallScratch;

/// What is worked out on the way to a frame. Whatever was drawn before it shows in no pixel of the
/// next.
#[derive(Debug, Default)]
pub struct FrameScratch {
    /// The frame of a renderer that does not keep its own.
    pub(super) frame: Frame,
    pub(super) clip: ColumnClip,
    pub(super) planes: VisPlanes,
    pub(super) drawsegs: DrawSegs,
    pub(super) walk: WallScratch,
    pub(super) surfaces: SurfaceCache,
    /// Columns of walls that wait to be drawn.
    pub(super) walls: WallBatch,
    /// What is drawn by columns.
    pub(super) columns: Columns,
    /// Sectors that the frame entered.
    pub(super) entered: Vec<bool>,
    /// Index of the picture that each texture shows.
    pub(super) pictures: Vec<u32>,
    /// First column of each row's span, and one entry that nothing reads.
    pub(super) span_starts: Vec<u16>,
    /// Spans of the plane at hand.
    pub(super) spans: Vec<Span>,
    /// Start of each column's texels in the sky's picture.
    pub(super) sky_columns: Vec<u32>,
    pub(super) sprites: Sprites,
    pub(super) trails: Particles,
    /// Columns of the sprite or weapon at hand.
    pub(super) patch_columns: PatchColumns,
    pub(super) weapons: WeaponCache,
}

impl FrameScratch {
    /// How many layers of weapons would be copied.
    #[cfg(test)]
    pub(super) fn weapons_known(&self) -> usize {
        self.weapons.known()
    }

    /// Makes ready for a frame of a scene at tic `tic`.
    pub(super) fn begin(&mut self, scene: &Scene, view: &View, tic: u32) {
        let (width, rows) = (view.width(), view.view_rows);
        self.clip.reset(width, rows);
        self.planes.reset(width);
        self.drawsegs.reset();
        self.walk.fit(scene, width);
        self.surfaces.reset(scene.sector_count);
        self.columns.fit(width, rows);
        self.entered.clear();
        self.entered.resize(scene.sector_count, false);
        self.span_starts.resize(rows + 1, 0);
        self.sky_columns.resize(width, 0);
        self.pictures.clear();
        // The frame of each animated texture.
        self.pictures.extend(scene.textures.list.iter().map(|texture| {
            if texture.frames == 1 {
                texture.first
            } else {
                texture.first + tic / texture.tics % texture.frames
            }
        }));
    }
}
