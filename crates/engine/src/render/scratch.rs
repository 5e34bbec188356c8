//! Memory that a frame is drawn in and that nobody reads afterwards: one a thread.
//!
//! A thread draws one frame at a time. If each of the worlds that it steps in turn had such memory of its own, that of a
//! batch of 32 would not fit the second cache of a core, and every frame would begin with cold memory: 2 to 4 % of a step.

use crate::render::buffers::clip::Openings;
use crate::render::buffers::drawsegs::list::Silhouettes;
use crate::render::buffers::frame::{Columns, Frame};
use crate::render::buffers::sectors::Looks;
use crate::render::buffers::visplane::{Planes, Span};
use crate::render::overlay::weapon_cache::WeaponCache;
use crate::render::patch::data::StampColumns;
use crate::render::published_depth::midtexture::FenceDepth;
use crate::render::scene::prepared::Scene;
use crate::render::sprites::particles::SeenTrails;
use crate::render::sprites::sprite::Sprites;
use crate::render::view::tables::View;
use crate::render::walls::batch::data::WallBatch;
use crate::render::walls::pass::WalkScratch;
use std::cell::RefCell;

thread_local! {
    static WORKSPACE: RefCell<Workspace> = RefCell::default();
}

/// What is worked out on the way to a frame. Whatever was drawn before it shows in no pixel of the next.
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    /// The frame of whoever does not keep it.
    pub frame: Frame,
    pub openings: Openings,
    pub planes: Planes,
    pub silhouettes: Silhouettes,
    pub walk: WalkScratch,
    pub looks: Looks,
    /// Columns of walls that wait to be drawn.
    pub walls: WallBatch,
    /// What is drawn by columns.
    pub columns: Columns,
    /// Sectors that the frame entered.
    pub entered: Vec<bool>,
    /// Index of the picture that each texture shows.
    pub pictures: Vec<u32>,
    /// First column of each row's span, and one entry that nobody reads.
    pub span_starts: Vec<u16>,
    /// Spans of the plane at hand.
    pub spans: Vec<Span>,
    /// Start of each column's texels in the sky's picture.
    pub sky_columns: Vec<u32>,
    pub sprites: Sprites,
    pub trails: SeenTrails,
    /// Columns of the sprite or weapon at hand.
    pub stamp_columns: StampColumns,
    pub weapons: WeaponCache,
    pub fence_depth: FenceDepth,
}

impl Workspace {
    /// Draws in this thread's workspace.
    pub fn with(draw: impl FnOnce(&mut Workspace)) {
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
        self.openings.reset(width, rows);
        self.planes.reset(width);
        self.silhouettes.reset();
        self.walk.fit(scene, width);
        self.looks.reset(scene.sector_count);
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
