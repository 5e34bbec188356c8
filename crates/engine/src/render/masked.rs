//! What has holes: sprites and the textures in openings, drawn far to near over walls and planes.

use super::View;
use super::camera::Camera;
use super::fence::{Hung, Scales};
use super::fence_depth::FenceDepth;
use super::frame::{Frame, class};
use super::label::{Label, Labels};
use super::light::{Light, ONE_TABLE_DISTANCE};
use super::masked_column::MaskedColumn;
use super::scene::Scene;
use super::silhouette::{Silhouette, Silhouettes};
use super::sprite::{Extent, SeenSprite, Sprites};
use super::stamp::{Covered, StampColumns};
use super::trail::SeenTrails;
use super::turned::TurnedLine;
use super::wall::INVERSE_BITS;
use crate::map::SectorId;
use crate::math::Fixed;
use crate::simd::Simd;
use crate::world::World;

/// Everything that the drawing of masked things reads and writes.
pub(super) struct Masked<'a> {
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
        let covered = stamp.draw::<DEPTH, CLASS>(self.simd, self.frame, &self.view.rows);
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

    /// Draws the frame columns `first..end` of the masked texture of an opening, and marks them as drawn.
    fn texture<const DEPTH: bool, const CLASS: bool>(&mut self, silhouette: &Silhouette, first: usize, end: usize) {
        let scene = self.scene;
        let seg = &scene.segs[silhouette.seg as usize];
        let face = &scene.faces[seg.face as usize];
        let Some(texture) = face.middle else { return };
        let (front, back) = (self.world.sector(SectorId(seg.front)), self.world.sector(SectorId(seg.back)));
        let fence = &scene.textures.fences[self.pictures[usize::from(texture.0)] as usize];
        let (floor, ceiling) = (front.floor.max(back.floor), front.ceiling.min(back.ceiling));
        let height = Fixed::from_int(fence.picture.height as i32);
        let hung_from = i64::from(if face.lower_unpegged { floor + height } else { ceiling }.0) + face.v_offset;
        // Of the texture, what is within the opening.
        let top = hung_from.min(i64::from(ceiling.0)) - self.camera.z;
        let bottom = (hung_from - i64::from(height.0)).max(i64::from(floor.0)) - self.camera.z;
        let light = Light::new(self.camera, i32::from(front.light) + face.contrast);
        let along = TurnedLine::of_face(self.camera, face).texture(self.view, face, silhouette.first);
        let (upper, lower) =
            (silhouette.ends.edge(self.camera, self.view, top), silhouette.ends.edge(self.camera, self.view, bottom));
        let first_rows = &self.view.first_row;
        // The published engine draws four columns at once; the depth of those that do not fill a four it tells as a sprite's.
        let whole_fours = (self.view.columns[first] + 3) & !3..(self.view.columns[end - 1] + 1) & !3;
        // A reduced frame lacks columns and rows that decide what is told.
        let by_fours = DEPTH && self.frame.depths.by_fours();
        let scales = Scales::new(self.view, &silhouette.line, silhouette.base_ends);
        let eye = hung_from - self.camera.z;
        for x in first..end {
            let row_index = silhouette.rows + x - silhouette.first;
            let (open_top, open_bottom) = (self.silhouettes.tops[row_index], self.silhouettes.bottoms[row_index]);
            let drawn = std::mem::replace(&mut self.silhouettes.drawn[row_index], true);
            let column = self.view.columns[x];
            let (open_top, open_bottom) = (i32::from(open_top), i32::from(open_bottom));
            let rows = upper.row(first_rows, column).max(open_top)..lower.row(first_rows, column).min(open_bottom);
            let mut whole = whole_fours.contains(&column);
            if by_fours && whole {
                // Nor does a four count as whole where nearer walls without an opening hide a column.
                let four = row_index - (column & 3) as usize;
                whole = self.silhouettes.bottoms[four..four + 4].iter().all(|&bottom| bottom > 0);
            }
            let in_four = whole.then_some((column & 3) as usize);
            if by_fours && in_four == Some(0) {
                self.fence_depth.begin();
            }
            if !drawn && !rows.is_empty() {
                let column = i64::from(column);
                let distance = silhouette.line.distance_at(column);
                let nearness = (silhouette.ends.inverse_at(column) * ONE_TABLE_DISTANCE) >> (INVERSE_BITS - 16);
                let table = &scene.assets.light_tables[light.table(nearness)];
                let u = along.at(column, distance) >> 16;
                let (texels, runs) = fence.column(u.rem_euclid(i64::from(fence.picture.width)) as u32);
                let step = (distance * self.view.inverse_focal_y) >> 16;
                let at = (eye << 16) - self.camera.to_horizon(step);
                let hung = Hung { horizon: self.camera.horizon, eye, scale: scales.at(column) };
                let shown = MaskedColumn { texels, table, at, step, runs, hung };
                let Frame { width, colour, depth, class: classes, depths, .. } = &mut *self.frame;
                let told = if in_four.is_some() {
                    depths.wall(distance, fence.picture.height)
                } else {
                    depths.sprite(distance, self.view.focal_y)
                };
                if DEPTH && in_four.is_none() {
                    self.fence_depth.tell(told);
                }
                let rows = rows.start as usize..rows.end as usize;
                shown.draw(self.simd, &self.view.rows, rows, |row, lit| {
                    let pixel = row * *width + x;
                    colour[pixel] = lit;
                    if DEPTH {
                        depth[pixel] = told;
                    }
                    if by_fours && let Some(column) = in_four {
                        self.fence_depth.add(column, row as u16, shown.run_at(self.view.rows[row]), told);
                    }
                    if CLASS {
                        classes[pixel] = class::WALL;
                    }
                });
            }
            if by_fours && in_four == Some(3) {
                let Frame { width, depth, .. } = &mut *self.frame;
                self.fence_depth.end(|column, row, told| depth[usize::from(row) * *width + x - 3 + column] = told);
            }
        }
    }
}
