//! What a seg does to the picture: it ends planes, has wall parts, and clips or closes columns.
//!
//! Long because a seg is clipped, drawn and remembered in one walk over its tiers.

use crate::map::TextureId;
use crate::math::Fixed;
use crate::render::buffers::drawsegs::list::DrawSeg;
use crate::render::buffers::sectors::SectorSurfaces;
use crate::render::buffers::visplane::VisPlaneKey;
use crate::render::buffers::written::DepthBuffer;
use crate::render::published_depth::PublishedDepth;
use crate::render::scene::prepared::{NO_SECTOR, SceneSeg};
use crate::render::view::light::Light;
use crate::render::view::line::{END_BITS, Edge};
use crate::render::view::view_space::ViewLine;
use crate::render::walls::batch;
use crate::render::walls::clip::parts::{
    Ceiling, Floor, Parts, PlaneAndWall, PlaneOnly, Side, WallOnly,
};
use crate::render::walls::clip::{clip_columns, pass::ClipLists};
use crate::render::walls::pass::{SeenSeg, WallPass, WallScratch};
use crate::render::walls::shade;
use crate::render::walls::shader::WallShader;

/// The columns of a seg that sidedefs the eye.
struct SeenColumns {
    /// Frame columns.
    first: usize,
    end: usize,
    /// Where its ends are exactly, base columns with [`END_BITS`] fractional bits.
    positions: [i64; 2],
    /// First base column and one past the last: what depends on these is the same in every
    /// reduction of a frame.
    base_ends: [i64; 2],
    /// Its ends.
    turned: ViewLine,
}

/// The part of a seg above or below its opening.
#[derive(Clone, Copy)]
struct WallTier {
    /// The plane that ends at the seg, if the eye sees it.
    plane: Option<u16>,
    /// Where it ends.
    edge: Edge,
    /// Where the wall between it and the opening ends, if there is one.
    wall: Option<Edge>,
}

impl WallPass<'_> {
    /// Draws a seg that sidedefs the eye, if any column shows it.
    #[inline]
    pub fn seg<D: DepthBuffer>(&mut self, index: u32) {
        let seg = &self.scene.segs[index as usize];
        let Some(SeenColumns { first, end, positions, base_ends, turned }) = self.columns(seg)
        else {
            return;
        };
        let face = &self.scene.sidedefs[seg.face as usize];
        let turned = if seg.piece { ViewLine::of_sidedef(self.camera, face) } else { turned };
        let line = turned.seen(self.view);
        let ends = line.between(positions, base_ends);
        let [one, other] = base_ends.map(|column| ends.inverse_at(column));
        let inverses = [one.min(other), one.max(other)];
        let seen =
            SeenSeg { index, seg, face, turned, line, ends, inverses, first, end, base_ends };
        let front = &self.surfaces.of(self.world, seg.front);
        if seg.back == NO_SECTOR {
            self.solid::<D>(&seen, front);
        } else {
            let back = &self.surfaces.of(self.world, seg.back);
            self.opening::<D>(&seen, front, back);
        }
    }

    /// The frame columns of a seg that sidedefs the eye, if any of them is open.
    #[inline]
    fn columns(&self, seg: &SceneSeg) -> Option<SeenColumns> {
        let (camera, view) = (self.camera, self.view);
        let turned = seg.ends.map(|end| camera.turned(end));
        // How far they are to the right of the view's left edge and to the left of its right one.
        let [[left1, right1], [left2, right2]] =
            turned.map(|[right, ahead]| [ahead + right, ahead - right]);
        // Facing the eye, it runs clockwise by less than half a turn: it enters the view over the
        // left edge or not at all, and leaves it over the right one.
        if (left1 < 0 && left2 < 0) || (right1 < 0 && right2 < 0) {
            return None;
        }
        if (left1 >= 0 && right1 < 0) || (right2 >= 0 && left2 < 0) {
            return None;
        }
        let width = i64::from(view.base_width);
        let exact = |left: i64, right: i64| {
            ((left * (width << END_BITS)) as u64 / (left + right).max(1) as u64) as i64
        };
        // A column is the seg's from the one in which it begins: left of the middle that one
        // counts, right of it not.
        let column =
            |position: i64| (position >> END_BITS) + i64::from(2 * position >= width << END_BITS);
        let (mut positions, mut base_ends) = ([0, width << END_BITS], [0, width]);
        if left1 >= 0 {
            positions[0] = exact(left1, right1);
            base_ends[0] = column(positions[0]);
        }
        if right2 >= 0 {
            positions[1] = exact(left2, right2);
            base_ends[1] = column(positions[1]).min(width);
        }
        let first = usize::from(*view.first_column.get(base_ends[0] as usize)?);
        let end = usize::from(view.first_column[base_ends[1] as usize]);
        let seen = first < end && self.clip.any_open(first, end);
        seen.then_some(SeenColumns { first, end, positions, base_ends, turned: ViewLine(turned) })
    }

    /// A wall without another side.
    fn solid<D: DepthBuffer>(&mut self, seen: &SeenSeg, front: &SectorSurfaces) {
        let (ceiling, floor) = (self.edge(seen, front.ceiling), self.edge(seen, front.floor));
        // As if there were an opening without height where the floor is.
        let above = WallTier { plane: self.ceiling_plane(front), edge: ceiling, wall: Some(floor) };
        let below = WallTier { plane: self.floor_plane(front), edge: floor, wall: None };
        let hung_from = match seen.face.middle {
            Some(texture) if seen.face.lower_unpegged => front.floor + self.texture_height(texture),
            _ => front.ceiling,
        };
        if self.above(seen, above) {
            self.wall::<D>(seen, front, seen.face.middle, hung_from);
        }
        self.below(seen, below);
        self.clip.close(seen.first, seen.end);
        self.drawseg(seen, None, None, true);
    }

    /// A line with a sector on its other side.
    fn opening<D: DepthBuffer>(
        &mut self,
        seen: &SeenSeg,
        front: &SectorSurfaces,
        back: &SectorSurfaces,
    ) {
        let face = seen.face;
        let shut = back.ceiling <= front.floor
            || back.floor >= front.ceiling
            || back.floor >= back.ceiling;
        // Between two skies there is no wall: the sky goes on, down to the floor at most.
        let both_sky = self.is_sky(front.ceiling_texture) && self.is_sky(back.ceiling_texture);
        let other_light = front.light != back.light;
        let ceiling = if both_sky { back.ceiling.max(front.floor) } else { front.ceiling };
        let other_texture = front.ceiling_texture != back.ceiling_texture;
        if shut || ceiling != back.ceiling || other_texture || (other_light && !both_sky) {
            let wall = (back.ceiling < ceiling && !both_sky).then(|| self.edge(seen, back.ceiling));
            let part =
                WallTier { plane: self.ceiling_plane(front), edge: self.edge(seen, ceiling), wall };
            if self.above(seen, part) {
                let hung_from = match face.top {
                    Some(texture) if !face.upper_unpegged => {
                        back.ceiling + self.texture_height(texture)
                    }
                    _ => ceiling,
                };
                self.wall::<D>(seen, front, face.top, hung_from);
            }
        }
        if shut
            || front.floor != back.floor
            || front.floor_texture != back.floor_texture
            || other_light
        {
            let wall = (back.floor > front.floor).then(|| self.edge(seen, back.floor));
            let part = WallTier {
                plane: self.floor_plane(front),
                edge: self.edge(seen, front.floor),
                wall,
            };
            if self.below(seen, part) {
                let hung_from =
                    if face.lower_unpegged { front.ceiling.max(back.ceiling) } else { back.floor };
                self.wall::<D>(seen, front, face.bottom, hung_from);
            }
        }
        let eye = Fixed(self.camera.z as i32);
        let below = if front.floor > back.floor {
            Some(front.floor)
        } else {
            (back.floor > eye).then_some(Fixed::MAX)
        };
        let above = if ceiling < back.ceiling {
            Some(ceiling)
        } else {
            (back.ceiling < eye && !both_sky).then_some(Fixed::MIN)
        };
        if shut {
            self.clip.close(seen.first, seen.end);
        }
        if shut || below.is_some() || above.is_some() || seen.seg.masked {
            self.drawseg(seen, below, above, shut);
        }
    }

    /// Ends the ceiling at the seg and clips the columns from above. Returns whether any of the
    /// part's wall is to be seen; its rows are then in the scratch.
    fn above(&mut self, seen: &SeenSeg, part: WallTier) -> bool {
        match (part.plane, part.wall) {
            (Some(plane), None) => {
                self.clip_columns::<Ceiling, PlaneOnly>(seen, plane, part.edge, part.edge)
            }
            (Some(plane), Some(wall)) => {
                self.clip_columns::<Ceiling, PlaneAndWall>(seen, plane, part.edge, wall)
            }
            (None, Some(wall)) => self.clip_columns::<Ceiling, WallOnly>(seen, 0, part.edge, wall),
            (None, None) => false,
        }
    }

    /// Ends the floor at the seg and clips the columns from below, as [`WallPass::above`] does.
    fn below(&mut self, seen: &SeenSeg, part: WallTier) -> bool {
        match (part.plane, part.wall) {
            (Some(plane), None) => {
                self.clip_columns::<Floor, PlaneOnly>(seen, plane, part.edge, part.edge)
            }
            (Some(plane), Some(wall)) => {
                self.clip_columns::<Floor, PlaneAndWall>(seen, plane, part.edge, wall)
            }
            (None, Some(wall)) => self.clip_columns::<Floor, WallOnly>(seen, 0, part.edge, wall),
            (None, None) => false,
        }
    }

    /// The plane takes the rows up to `edge`, the wall those from there to `wall`, and what is left
    /// stays open.
    #[inline]
    fn clip_columns<S: Side, P: Parts>(
        &mut self,
        seen: &SeenSeg,
        plane: u16,
        edge: Edge,
        wall: Edge,
    ) -> bool {
        let WallScratch { upper, lower, .. } = &mut *self.scratch;
        let mut lists = ClipLists {
            view: self.view,
            clip: self.clip,
            planes: self.planes,
            wall: [upper, lower],
        };
        clip_columns::<S, P>(self.simd, &mut lists, seen.first..seen.end, plane, [edge, wall])
    }

    /// The plane of a sector's ceiling, if the eye sees it.
    fn ceiling_plane(&mut self, sector: &SectorSurfaces) -> Option<u16> {
        if self.is_sky(sector.ceiling_texture) {
            return Some(self.sky_plane(sector.ceiling_texture));
        }
        let key = VisPlaneKey {
            height: sector.ceiling,
            texture: sector.ceiling_texture,
            light: sector.light,
            sky: false,
        };
        (i64::from(sector.ceiling.0) > self.camera.z).then(|| self.planes.find(key))
    }

    /// The plane of a sector's floor, if the eye sees it.
    fn floor_plane(&mut self, sector: &SectorSurfaces) -> Option<u16> {
        if self.is_sky(sector.floor_texture) {
            return Some(self.sky_plane(sector.floor_texture));
        }
        let key = VisPlaneKey {
            height: sector.floor,
            texture: sector.floor_texture,
            light: sector.light,
            sky: false,
        };
        (i64::from(sector.floor.0) < self.camera.z).then(|| self.planes.find(key))
    }

    fn sky_plane(&mut self, texture: TextureId) -> u16 {
        self.planes.find(VisPlaneKey { height: Fixed::ZERO, texture, light: 0, sky: true })
    }

    fn edge(&self, seen: &SeenSeg, height: Fixed) -> Edge {
        seen.ends.edge(self.camera, self.view, i64::from(height.0) - self.camera.z)
    }

    /// Draws the wall between the upper and the lower scratch.
    fn wall<D: DepthBuffer>(
        &mut self,
        seen: &SeenSeg,
        front: &SectorSurfaces,
        texture: Option<TextureId>,
        hung_from: Fixed,
    ) {
        let (first, end, picture) = (seen.first, seen.end, self.picture(texture));
        let light = Light::new(self.camera, i32::from(front.light) + seen.face.contrast);
        let shader = WallShader {
            camera: self.camera,
            view: self.view,
            depths: self.depths,
            tables: &self.scene.assets.light_tables,
            line: &seen.line,
            ends: &seen.ends,
            texture: seen.turned.texture(self.view, seen.face, seen.base_ends),
            picture: &self.scene.textures.walls[picture],
            own: &self.scene.textures.own[picture],
            light,
            hung_from: i64::from(hung_from.0) - self.camera.z + seen.face.v_offset,
        };
        let (tops, bottoms) = (&self.scratch.upper[first..], &self.scratch.lower[first..]);
        let listed_from = self.scene.textures.listed_from[picture].filter(|_| self.batches_walls());
        if let Some(start) = listed_from {
            batch::add::<D>(
                self.walls,
                self.simd,
                &shader,
                start,
                first,
                end - first,
                tops,
                bottoms,
            );
        } else {
            shade::draw::<D>(
                &shader,
                self.simd,
                self.columns,
                first,
                &tops[..end - first],
                &bottoms[..end - first],
            );
        }
        if D::WRITTEN
            && let Some(published) = &self.published
        {
            let ends = [&tops[..end - first], &bottoms[..end - first]];
            published.below(first, ends, |x, row| {
                let distance = || seen.line.distance_at(i64::from(self.view.columns[x]));
                let depth = || shader.depths.wall(distance(), shader.picture.height);
                self.columns.put_depth(x, row, depth);
            });
        }
        if !self.world.soot.is_empty() {
            self.soot::<D>(seen, light);
        }
    }

    /// Whether columns of walls are listed and drawn together.
    fn batches_walls(&self) -> bool {
        let may_wait = self.published.as_deref().is_none_or(PublishedDepth::lets_walls_wait);
        batch::is_used(self.simd) && self.columns.are_blocks() && may_wait
    }

    /// Draws the walls that wait for it.
    pub fn draw_walls<D: DepthBuffer>(&mut self) {
        if self.batches_walls() {
            let (scene, rows) =
                (self.scene, self.view.rows.first_chunk().expect("the list is padded"));
            let (texels, tables) = (&scene.textures.listed, &scene.assets.light_tables);
            batch::draw::<D>(
                self.walls,
                self.simd,
                self.columns,
                rows,
                texels,
                tables,
                self.depths,
            );
        }
    }

    fn drawseg(
        &mut self,
        seen: &SeenSeg,
        floor: Option<Fixed>,
        ceiling: Option<Fixed>,
        solid: bool,
    ) {
        let drawseg = DrawSeg {
            first: seen.first,
            end: seen.end,
            base_ends: seen.base_ends,
            line: seen.line,
            ends: seen.ends,
            seg: seen.index,
            inverses: seen.inverses,
            floor,
            ceiling,
            solid,
            masked: !solid && seen.seg.masked,
            rows: 0,
        };
        self.drawsegs.add(drawseg, &self.clip.top[seen.first..], &self.clip.bottom[seen.first..]);
    }

    fn is_sky(&self, texture: TextureId) -> bool {
        self.scene.sky_flat == Some(texture)
    }

    fn picture(&self, texture: Option<TextureId>) -> usize {
        texture.map_or(self.scene.missing_picture, |texture| {
            self.pictures[usize::from(texture.0)] as usize
        })
    }

    fn texture_height(&self, texture: TextureId) -> Fixed {
        Fixed::from_int(self.scene.textures.walls[self.picture(Some(texture))].height as i32)
    }
}
