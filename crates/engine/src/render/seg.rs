//! What a seg does to the picture: it ends planes, has wall parts, and narrows or closes columns.

use super::light::Light;
use super::plane::PlaneKey;
use super::scene::{Face, NO_SECTOR, SceneSeg};
use super::silhouette::Silhouette;
use super::walk::{Walk, WalkScratch};
use super::wall::{SeenLine, WallShader};
use crate::map::TextureId;
use crate::math::Fixed;
use crate::world::SectorState;

/// A seg in view, on its way through the stages.
struct SeenSeg<'a> {
    index: u32,
    face: &'a Face,
    line: SeenLine,
    light: Light,
    /// Frame columns.
    first: usize,
    end: usize,
    /// First and last base column.
    base_ends: [i64; 2],
}

/// The columns of a seg that faces the eye.
struct SeenColumns {
    /// Frame columns.
    first: usize,
    end: usize,
    /// First and last base column: what depends on these is the same in every reduction of a frame.
    base_ends: [i64; 2],
}

impl Walk<'_> {
    /// Draws a seg if it faces the eye and any of it may be seen.
    #[inline]
    pub fn seg<const DEPTH: bool, const CLASS: bool>(&mut self, index: u32) {
        let (scene, sectors) = (self.scene, self.sectors);
        let seg = &scene.segs[index as usize];
        let away = self.camera.x * seg.normal[0] + self.camera.y * seg.normal[1] - seg.offset;
        if away <= 0 {
            return;
        }
        let front = &sectors[seg.front as usize];
        let back = (seg.back != NO_SECTOR).then(|| &sectors[seg.back as usize]);
        let face = &scene.faces[seg.face as usize];
        if back.is_some_and(|back| same_planes(front, back)) && face.middle.is_none() {
            return;
        }
        let Some(SeenColumns { first, end, base_ends }) = self.columns(seg) else { return };
        let line = SeenLine::new(self.camera, seg, face, away);
        let light = Light::new(self.camera, i32::from(front.light) + face.contrast);
        let seen = SeenSeg { index, face, line, light, first, end, base_ends };
        match back {
            None => self.solid::<DEPTH, CLASS>(&seen, front),
            Some(back) => self.opening::<DEPTH, CLASS>(&seen, front, back),
        }
    }

    /// The frame columns of a seg that faces the eye, if any of them is open.
    #[inline]
    fn columns(&self, seg: &SceneSeg) -> Option<SeenColumns> {
        let (camera, view) = (self.camera, self.view);
        let [left1, right1] = camera.edges(seg.ends[0][0], seg.ends[0][1]);
        let [left2, right2] = camera.edges(seg.ends[1][0], seg.ends[1][1]);
        // Facing the eye, it runs clockwise by less than half a turn: it enters the view over the left edge or not at
        // all, and leaves it over the right one.
        if (left1 < 0 && left2 < 0) || (right1 < 0 && right2 < 0) {
            return None;
        }
        if (left1 >= 0 && right1 < 0) || (right2 >= 0 && left2 < 0) {
            return None;
        }
        let width = i64::from(view.base_width);
        let column = |left: i64, right: i64| {
            // The first column whose middle is right of the point.
            let position = ((left * (width << 16)) as u64 / (left + right).max(1) as u64) as i64;
            ((position + 0x7FFF) >> 16) as usize
        };
        let first = if left1 < 0 { 0 } else { column(left1, right1) };
        let end = if right2 < 0 { width as usize } else { column(left2, right2) };
        let base_ends = [first as i64, end as i64 - 1];
        let first = usize::from(*view.first_column.get(first)?);
        let end = usize::from(*view.first_column.get(end)?);
        (first < end && self.openings.any_open(first, end)).then_some(SeenColumns { first, end, base_ends })
    }

    /// A wall without another side.
    fn solid<const DEPTH: bool, const CLASS: bool>(&mut self, seen: &SeenSeg, front: &SectorState) {
        self.upper_edge(seen, front.ceiling, EdgeOf::Opening);
        self.mark_ceiling(seen, front);
        let range = seen.first..seen.end;
        self.openings.top[range.clone()].copy_from_slice(&self.scratch.upper[range]);
        self.lower_edge(seen, front.floor, EdgeOf::Opening);
        self.mark_floor(seen, front);
        let hung_from = match seen.face.middle {
            Some(texture) if seen.face.lower_unpegged => front.floor + self.texture_height(texture),
            _ => front.ceiling,
        };
        self.wall::<DEPTH, CLASS>(seen, seen.face.middle, hung_from);
        self.openings.close(seen.first, seen.end);
        self.silhouette(seen, None, None, true);
    }

    /// A line with a sector on its other side.
    fn opening<const DEPTH: bool, const CLASS: bool>(&mut self, seen: &SeenSeg, front: &SectorState, back: &SectorState) {
        let (face, range) = (seen.face, seen.first..seen.end);
        let shut = back.ceiling <= front.floor || back.floor >= front.ceiling || back.floor >= back.ceiling;
        // Between two skies there is no wall: the sky goes on.
        let both_sky = self.is_sky(front.ceiling_texture) && self.is_sky(back.ceiling_texture);
        let other_light = front.light != back.light;
        let ceiling = if both_sky { back.ceiling } else { front.ceiling };
        if shut || ceiling != back.ceiling || front.ceiling_texture != back.ceiling_texture || (other_light && !both_sky) {
            self.upper_edge(seen, ceiling, EdgeOf::Opening);
            let marked = self.mark_ceiling(seen, front);
            if back.ceiling < ceiling {
                self.lower_edge(seen, back.ceiling, EdgeOf::Wall);
                let hung_from = match face.top {
                    Some(texture) if !face.upper_unpegged => back.ceiling + self.texture_height(texture),
                    _ => ceiling,
                };
                self.wall::<DEPTH, CLASS>(seen, face.top, hung_from);
                self.openings.top[range.clone()].copy_from_slice(&self.scratch.lower[range.clone()]);
            } else if marked {
                self.openings.top[range.clone()].copy_from_slice(&self.scratch.upper[range.clone()]);
            }
        }
        if shut || front.floor != back.floor || front.floor_texture != back.floor_texture || other_light {
            self.lower_edge(seen, front.floor, EdgeOf::Opening);
            let marked = self.mark_floor(seen, front);
            if back.floor > front.floor {
                self.upper_edge(seen, back.floor, EdgeOf::Wall);
                let hung_from = if face.lower_unpegged { front.ceiling.max(back.ceiling) } else { back.floor };
                self.wall::<DEPTH, CLASS>(seen, face.bottom, hung_from);
                self.openings.bottom[range.clone()].copy_from_slice(&self.scratch.upper[range.clone()]);
            } else if marked {
                self.openings.bottom[range.clone()].copy_from_slice(&self.scratch.lower[range]);
            }
        }
        let eye = Fixed(self.camera.z as i32);
        let below = if front.floor > back.floor { Some(front.floor) } else { (back.floor > eye).then_some(Fixed::MAX) };
        let above = if ceiling < back.ceiling { Some(ceiling) } else { (back.ceiling < eye && !both_sky).then_some(Fixed::MIN) };
        if shut {
            self.openings.close(seen.first, seen.end);
        } else {
            self.openings.note_closed(seen.first, seen.end);
        }
        if shut || below.is_some() || above.is_some() || face.middle.is_some() {
            self.silhouette(seen, below, above, shut);
        }
    }

    /// Puts the rows of a height into the upper scratch.
    fn upper_edge(&mut self, seen: &SeenSeg, height: Fixed, of: EdgeOf) {
        let range = seen.first..seen.end;
        let WalkScratch { upper, lower, .. } = &mut *self.scratch;
        let upper = &mut upper[range.clone()];
        let edge = seen.line.edge(self.camera, self.view, i64::from(height.0) - self.camera.z);
        edge.rows(self.view, seen.first, upper);
        let tops = &self.openings.top[range.clone()];
        let bottoms = match of {
            EdgeOf::Opening => &self.openings.bottom[range],
            EdgeOf::Wall => &lower[range],
        };
        for (row, (&top, &bottom)) in upper.iter_mut().zip(tops.iter().zip(bottoms)) {
            *row = (*row).max(top).min(bottom);
        }
    }

    /// Puts the rows of a height into the lower scratch.
    fn lower_edge(&mut self, seen: &SeenSeg, height: Fixed, of: EdgeOf) {
        let range = seen.first..seen.end;
        let WalkScratch { upper, lower, .. } = &mut *self.scratch;
        let lower = &mut lower[range.clone()];
        let edge = seen.line.edge(self.camera, self.view, i64::from(height.0) - self.camera.z);
        edge.rows(self.view, seen.first, lower);
        let tops = match of {
            EdgeOf::Opening => &self.openings.top[range.clone()],
            EdgeOf::Wall => &upper[range.clone()],
        };
        for (row, (&top, &bottom)) in lower.iter_mut().zip(tops.iter().zip(&self.openings.bottom[range])) {
            *row = (*row).max(top).min(bottom);
        }
    }

    /// Gives the open rows above the upper scratch to the ceiling, if the eye sees it.
    fn mark_ceiling(&mut self, seen: &SeenSeg, front: &SectorState) -> bool {
        let sky = self.is_sky(front.ceiling_texture);
        if !sky && i64::from(front.ceiling.0) <= self.camera.z {
            return false;
        }
        let key = if sky {
            PlaneKey { height: Fixed::ZERO, texture: front.ceiling_texture, light: 0, sky }
        } else {
            PlaneKey { height: front.ceiling, texture: front.ceiling_texture, light: front.light, sky }
        };
        let range = seen.first..seen.end;
        let plane = self.planes.find(key);
        self.planes.add(plane, seen.first, &self.openings.top[range.clone()], &self.scratch.upper[range]);
        true
    }

    /// Gives the open rows below the lower scratch to the floor, if the eye sees it.
    fn mark_floor(&mut self, seen: &SeenSeg, front: &SectorState) -> bool {
        let sky = self.is_sky(front.floor_texture);
        if !sky && i64::from(front.floor.0) >= self.camera.z {
            return false;
        }
        let key = if sky {
            PlaneKey { height: Fixed::ZERO, texture: front.floor_texture, light: 0, sky }
        } else {
            PlaneKey { height: front.floor, texture: front.floor_texture, light: front.light, sky }
        };
        let range = seen.first..seen.end;
        let plane = self.planes.find(key);
        self.planes.add(plane, seen.first, &self.scratch.lower[range.clone()], &self.openings.bottom[range]);
        true
    }

    /// Draws what is between the upper and the lower scratch.
    fn wall<const DEPTH: bool, const CLASS: bool>(&mut self, seen: &SeenSeg, texture: Option<TextureId>, top: Fixed) {
        let range = seen.first..seen.end;
        let shader = WallShader {
            camera: self.camera,
            view: self.view,
            tables: &self.scene.assets.light_tables,
            line: &seen.line,
            picture: &self.scene.textures.walls[self.picture(texture)],
            light: seen.light,
            hung_from: i64::from(top.0) - self.camera.z + seen.face.v_offset,
        };
        let (tops, bottoms) = (&self.scratch.upper[range.clone()], &self.scratch.lower[range]);
        shader.draw::<DEPTH, CLASS>(self.frame, seen.first, tops, bottoms);
    }

    fn silhouette(&mut self, seen: &SeenSeg, floor: Option<Fixed>, ceiling: Option<Fixed>, solid: bool) {
        let range = seen.first..seen.end;
        let ends = seen.base_ends.map(|column| seen.line.inverse_at(column));
        let silhouette = Silhouette {
            first: seen.first,
            end: seen.end,
            line: seen.line,
            seg: seen.index,
            inverses: [ends[0].min(ends[1]), ends[0].max(ends[1])],
            floor,
            ceiling,
            solid,
            masked: !solid && seen.face.middle.is_some(),
            rows: 0,
        };
        self.silhouettes.add(silhouette, &self.openings.top[range.clone()], &self.openings.bottom[range]);
    }

    fn is_sky(&self, texture: TextureId) -> bool {
        self.scene.sky_flat == Some(texture)
    }

    fn picture(&self, texture: Option<TextureId>) -> usize {
        texture.map_or(self.scene.missing_picture, |texture| self.pictures[usize::from(texture.0)] as usize)
    }

    fn texture_height(&self, texture: TextureId) -> Fixed {
        Fixed::from_int(self.scene.textures.walls[self.picture(Some(texture))].height as i32)
    }
}

/// What bounds an edge on its far side.
#[derive(Clone, Copy)]
enum EdgeOf {
    /// The open rows.
    Opening,
    /// The other end of the wall part, in the other scratch.
    Wall,
}

/// Whether nothing of floor and ceiling changes from one sector to the other.
#[inline]
fn same_planes(a: &SectorState, b: &SectorState) -> bool {
    a.floor == b.floor
        && a.ceiling == b.ceiling
        && a.floor_texture == b.floor_texture
        && a.ceiling_texture == b.ceiling_texture
        && a.light == b.light
}
