//! What has holes: sprites and the textures in openings, drawn far to near over walls and planes.

use crate::render::buffers::drawsegs::list::{Silhouette, Silhouettes};
use crate::render::buffers::frame::Frame;
use crate::render::buffers::labels::{Label, Labels};
use crate::render::patch;
use crate::render::patch::data::{Covered, StampColumns};
use crate::render::published_depth::midtexture::FenceDepth;
use crate::render::scene::prepared::Scene;
use crate::render::sprites::particles::SeenTrails;
use crate::render::sprites::sprite::{Extent, SeenSprite, Sprites};
use crate::render::view::camera::Camera;
use crate::render::view::tables::View;
use crate::simd::Simd;
use crate::world::World;

/// Everything that the drawing of masked things reads and writes.
pub(crate) struct Masked<'a> {
    pub scene: &'a Scene,
    pub view: &'a View,
    pub camera: &'a Camera,
    pub world: &'a World,
    pub pictures: &'a [u32],
    pub frame: &'a mut Frame,
    pub silhouettes: &'a mut Silhouettes,
    pub labels: &'a mut Labels,
    /// Trails, as far as they are not drawn yet.
    pub trails: &'a mut SeenTrails,
    /// Scratch: the columns of the sprite at hand.
    pub columns: &'a mut StampColumns,
    pub fence_depth: &'a mut FenceDepth,
    pub simd: Simd,
}

impl Masked<'_> {
    /// Draws sprites with the squares of trails and the masked textures between them.
    pub fn draw<const DEPTH: bool, const CLASS: bool>(&mut self, sprites: &Sprites) {
        self.fence_depth.reset();
        self.meet_trails();
        for sprite in sprites.far_to_near() {
            self.squares_beyond::<DEPTH, CLASS>(sprite.distance);
            self.sprite::<DEPTH, CLASS>(sprite);
        }
        self.squares_beyond::<DEPTH, CLASS>(i64::MIN);
        for at in (0..self.silhouettes.masked().len()).rev() {
            let silhouette = self.silhouettes.list[self.silhouettes.masked()[at] as usize];
            self.texture::<DEPTH, CLASS>(&silhouette, silhouette.first, silhouette.end);
        }
    }

    /// Whether something stands behind a silhouette where the two overlap.
    fn is_behind(&self, extent: &Extent, silhouette: &Silhouette) -> bool {
        let [far, near] = silhouette.inverses;
        if near < extent.inverse {
            return false;
        }
        let seg = &self.scene.segs[silhouette.seg as usize];
        let in_front = || seg.away(extent.x, extent.y) > 0;
        far >= extent.inverse || !in_front()
    }

    /// Narrows the columns at hand to what is seen of something past the silhouettes before it, and draws the masked textures that are
    /// behind it.
    pub fn narrow<const DEPTH: bool, const CLASS: bool>(&mut self, extent: &Extent) {
        for at in (0..self.silhouettes.meet(self.simd, extent.first, extent.end, extent.inverse)).rev() {
            let silhouette = &self.silhouettes.list[self.silhouettes.met(at)];
            let (first, end) = (silhouette.first.max(extent.first), silhouette.end.min(extent.end));
            if !self.is_behind(extent, silhouette) {
                if silhouette.masked {
                    let silhouette = *silhouette;
                    self.texture::<DEPTH, CLASS>(&silhouette, first, end);
                }
                continue;
            }
            let own = first - extent.first..end - extent.first;
            if silhouette.solid {
                self.columns.bottoms[own].fill(0);
                continue;
            }
            let open = silhouette.rows + first - silhouette.first..silhouette.rows + end - silhouette.first;
            if silhouette.floor.is_some_and(|height| extent.bottom < height) {
                for (row, &limit) in self.columns.bottoms[own.clone()].iter_mut().zip(&self.silhouettes.bottoms[open.clone()]) {
                    *row = (*row).min(limit);
                }
            }
            if silhouette.ceiling.is_some_and(|height| extent.top > height) {
                for (row, &limit) in self.columns.tops[own].iter_mut().zip(&self.silhouettes.tops[open]) {
                    *row = (*row).max(limit);
                }
            }
        }
    }

    fn sprite<const DEPTH: bool, const CLASS: bool>(&mut self, sprite: &SeenSprite) {
        let Some(picture) = self.scene.sprite_pictures[sprite.picture as usize].as_ref() else { return };
        sprite.open(self.columns, self.view);
        self.narrow::<DEPTH, CLASS>(&sprite.extent);
        let label = self.labels.next_class();
        let depth = self.frame.depths.sprite(sprite.distance, self.view.focal_y);
        self.fence_depth.tell(depth);
        let stamp = sprite.stamp(self.scene, picture, self.columns, depth, label);
        let covered = patch::draw::<DEPTH, CLASS>(&stamp, self.simd, self.frame, &self.view.rows);
        if CLASS && covered != Covered::NOTHING {
            let [[left, right], [top, bottom]] = [covered.columns, covered.rows];
            self.labels.list.push(Label {
                kind: sprite.kind,
                actor: self.world.id_of(usize::from(sprite.slot)),
                class: label,
                x: left as u16,
                y: top as u16,
                width: (right - left) as u16,
                height: (bottom - top) as u16,
            });
        }
    }
}
