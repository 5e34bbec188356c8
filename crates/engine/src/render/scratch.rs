//! Memory that a frame is drawn in and that nothing reads afterwards: one a thread.
//!
//! A thread draws one frame at a time. If each of the worlds that it steps in turn had such memory of its own, that of a
//! batch of 32 would not fit the second cache of a core, and every frame would begin with cold memory: 2 to 4 % of a step.

use crate::render::buffers::clip::ColumnClip;
use crate::render::buffers::drawsegs::list::DrawSegs;
use crate::render::buffers::frame::{Columns, Frame};
use crate::render::buffers::sectors::SurfaceCache;
use crate::render::buffers::visplane::{Span, VisPlanes};
use crate::render::overlay::weapon_cache::WeaponCache;
use crate::render::patch::data::PatchColumns;
use crate::render::published_depth::midtexture::MidtextureDepth;
use crate::render::scene::prepared::Scene;
use crate::render::sprites::particles::Particles;
use crate::render::sprites::sprite::Sprites;
use crate::render::view::tables::View;
use crate::render::walls::batch::data::WallBatch;
use crate::render::walls::pass::WallScratch;
use std::cell::RefCell;

thread_local! {
    static WORKSPACE: RefCell<FrameScratch> = RefCell::default();
}

/// What is worked out on the way to a frame. Whatever was drawn before it shows in no pixel of the next.
#[derive(Debug, Default)]
pub(crate) struct FrameScratch {
    /// The frame of a renderer that does not keep its own.
    pub frame: Frame,
    pub clip: ColumnClip,
    pub planes: VisPlanes,
    pub drawsegs: DrawSegs,
    pub walk: WallScratch,
    pub surfaces: SurfaceCache,
    /// Columns of walls that wait to be drawn.
    pub walls: WallBatch,
    /// What is drawn by columns.
    pub columns: Columns,
    /// Sectors that the frame entered.
    pub entered: Vec<bool>,
    /// Index of the picture that each texture shows.
    pub pictures: Vec<u32>,
    /// First column of each row's span, and one entry that nothing reads.
    pub span_starts: Vec<u16>,
    /// Spans of the plane at hand.
    pub spans: Vec<Span>,
    /// Start of each column's texels in the sky's picture.
    pub sky_columns: Vec<u32>,
    pub sprites: Sprites,
    pub trails: Particles,
    /// Columns of the sprite or weapon at hand.
    pub patch_columns: PatchColumns,
    pub weapons: WeaponCache,
    pub midtexture_depth: MidtextureDepth,
}

impl FrameScratch {
    /// Draws in this thread's workspace.
    pub fn with(draw: impl FnOnce(&mut FrameScratch)) {
        WORKSPACE.with_borrow_mut(draw);
    }

    /// How many layers of weapons this thread would copy.
    #[cfg(test)]
    pub fn weapons_known() -> usize {
        WORKSPACE.with_borrow(|space| space.weapons.known())
    }

    /// Makes ready for a frame of a scene at tic `tic`.
    pub fn begin(&mut self, scene: &Scene, view: &View, tic: u32) {
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
            if texture.frames == 1 { texture.first } else { texture.first + tic / texture.tics % texture.frames }
        }));
    }
}
