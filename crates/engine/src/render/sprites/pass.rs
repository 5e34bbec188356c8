//! What has holes: sprites and the textures in clip, drawn far to near over walls and planes.

use crate::render::buffers::drawsegs::list::{DrawSeg, DrawSegs};
use crate::render::buffers::frame::Frame;
use crate::render::buffers::labels::{Label, Labels};
use crate::render::buffers::written::{ClassBuffer, DepthBuffer};
use crate::render::patch;
use crate::render::patch::data::{DrawnBounds, PatchColumns};
use crate::render::published_depth::PublishedDepth;
use crate::render::scene::prepared::Scene;
use crate::render::sprites::particles::Particles;
use crate::render::sprites::sprite::{Extent, Sprites, VisSprite};
use crate::render::view::camera::Camera;
use crate::render::view::tables::View;
use crate::simd::Simd;
use crate::world::World;

/// Everything that the drawing of masked things reads and writes.
pub(crate) struct SpritePass<'a> {
    pub scene: &'a Scene,
    pub view: &'a View,
    pub camera: &'a Camera,
    pub world: &'a World,
    pub pictures: &'a [u32],
    pub frame: &'a mut Frame,
    pub drawsegs: &'a mut DrawSegs,
    pub labels: &'a mut Labels,
    /// Trails, as far as they are not drawn yet.
    pub trails: &'a mut Particles,
    /// Scratch: the columns of the sprite at hand.
    pub columns: &'a mut PatchColumns,
    /// If depth is written as ViZDoom writes it.
    pub published: Option<&'a mut PublishedDepth>,
    pub simd: Simd,
}

impl SpritePass<'_> {
    /// Draws sprites with the squares of trails and the masked textures between them.
    pub fn draw<D: DepthBuffer, C: ClassBuffer>(&mut self, sprites: &Sprites) {
        if let Some(published) = &mut self.published {
            published.begin_masked();
        }
        self.find_hidden_trails();
        for sprite in sprites.far_to_near() {
            self.squares_beyond::<D, C>(sprite.distance);
            self.sprite::<D, C>(sprite);
        }
        self.squares_beyond::<D, C>(i64::MIN);
        for at in (0..self.drawsegs.masked().len()).rev() {
            let drawseg = self.drawsegs.list[self.drawsegs.masked()[at] as usize];
            self.texture::<D, C>(&drawseg, drawseg.first, drawseg.end);
        }
    }

    /// Whether something stands behind a drawseg where the two overlap.
    fn is_behind(&self, extent: &Extent, drawseg: &DrawSeg) -> bool {
        let [far, near] = drawseg.inverses;
        if near < extent.inverse {
            return false;
        }
        let seg = &self.scene.segs[drawseg.seg as usize];
        let in_front = || seg.away(extent.x, extent.y) > 0;
        far >= extent.inverse || !in_front()
    }

    /// Clips the columns at hand to what is seen of something past the drawsegs before it, and
    /// draws the masked textures that are behind it.
    pub fn occlude<D: DepthBuffer, C: ClassBuffer>(&mut self, extent: &Extent) {
        for at in (0..self.drawsegs.meet(self.simd, extent.first, extent.end, extent.inverse)).rev()
        {
            let drawseg = &self.drawsegs.list[self.drawsegs.met(at)];
            let (first, end) = (drawseg.first.max(extent.first), drawseg.end.min(extent.end));
            if !self.is_behind(extent, drawseg) {
                if drawseg.masked {
                    let drawseg = *drawseg;
                    self.texture::<D, C>(&drawseg, first, end);
                }
                continue;
            }
            let own = first - extent.first..end - extent.first;
            if drawseg.solid {
                self.columns.bottoms[own].fill(0);
                continue;
            }
            let open = drawseg.rows + first - drawseg.first..drawseg.rows + end - drawseg.first;
            if drawseg.floor.is_some_and(|height| extent.bottom < height) {
                for (row, &limit) in self.columns.bottoms[own.clone()]
                    .iter_mut()
                    .zip(&self.drawsegs.bottoms[open.clone()])
                {
                    *row = (*row).min(limit);
                }
            }
            if drawseg.ceiling.is_some_and(|height| extent.top > height) {
                for (row, &limit) in
                    self.columns.tops[own].iter_mut().zip(&self.drawsegs.tops[open])
                {
                    *row = (*row).max(limit);
                }
            }
        }
    }

    fn sprite<D: DepthBuffer, C: ClassBuffer>(&mut self, sprite: &VisSprite) {
        let Some(picture) = self.scene.sprite_pictures[sprite.picture as usize].as_ref() else {
            return;
        };
        sprite.open(self.columns, self.view);
        self.occlude::<D, C>(&sprite.extent);
        let label = self.labels.next_class();
        let depth = self.frame.depths.sprite(sprite.distance, self.view.focal_y);
        if let Some(published) = &mut self.published {
            published.note(depth);
        }
        let stamp = sprite.stamp(self.scene, picture, self.columns, depth, label);
        let covered = patch::draw::<D, C>(&stamp, self.simd, self.frame, &self.view.rows);
        if C::WRITTEN && covered != DrawnBounds::NOTHING {
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
