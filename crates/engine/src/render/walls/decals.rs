//! Soot on walls: darkens what was just drawn of one.
//!
//! Fitted to moments of ViZDoom.

use crate::assets::Stain;
use crate::render::buffers::written::DepthBuffer;
use crate::render::colour::blend::WHOLE;
use crate::render::patch::data::first_row;
use crate::render::scene::prepared::Sidedef;
use crate::render::view::light::{Light, ONE_TABLE_DISTANCE};
use crate::render::view::line::INVERSE_BITS;
use crate::render::walls::pass::SeenSeg;
use crate::render::walls::pass::{DecalColumn, WallPass};
use crate::world::Soot;

/// Texels of a stain to a map unit.
const TEXELS: i64 = 2;

/// How many light tables there are.
const LIGHT_TABLES: usize = 32;

impl WallPass<'_> {
    /// Darkens the part of a wall between the upper and the lower scratch where its side bears
    /// soot.
    pub fn soot<D: DepthBuffer>(&mut self, seen: &SeenSeg<'_>, light: Light) {
        let Some(stain) = &self.scene.assets.soot else { return };
        let world = self.world;
        let mut marks = world.soot.iter().filter(|mark| mark.side.0 == seen.seg.face).peekable();
        if marks.peek().is_none() {
            return;
        }
        self.draw_walls::<D>();
        self.list_decal_columns(seen, light);
        let columns = std::mem::take(&mut self.scratch.decal_columns);
        if D::WRITTEN
            && let Some(published) = &mut self.published
            && let Some(last) = columns.last()
        {
            let written = self.columns.depth_of(last.x)[last.rows[0]];
            let distance = |x: usize| seen.line.distance_at(i64::from(self.view.columns[x]));
            published.begin_decals(written, seen.first..seen.end, distance);
        }
        for mark in marks {
            self.stain::<D>(&columns, seen.face, stain, mark);
        }
        self.scratch.decal_columns = columns;
    }

    /// What all marks of a wall need of its columns: a wall may bear dozens, most of which touch
    /// few of them.
    fn list_decal_columns(&mut self, seen: &SeenSeg<'_>, light: Light) {
        let (camera, view) = (self.camera, self.view);
        let texture = seen.turned.texture(view, seen.face, seen.base_ends);
        let rows = self.scratch.upper.iter().zip(&self.scratch.lower).enumerate();
        let shown = rows.take(seen.end).skip(seen.first).filter(|(_, (top, bottom))| top < bottom);
        self.scratch.decal_columns.clear();
        self.scratch.decal_columns.extend(shown.map(|(x, (&top, &bottom))| {
            let column = i64::from(view.columns[x]);
            let distance = seen.line.distance_at(column);
            let nearness =
                (seen.ends.inverse_at(column) * ONE_TABLE_DISTANCE) >> (INVERSE_BITS - 16);
            let step = ((distance * view.inverse_focal_y) >> 16) * TEXELS;
            DecalColumn {
                x,
                rows: [top.max(0) as usize, bottom.max(0) as usize],
                along: texture.at(column, distance) - seen.face.u_offset,
                table: light.table(nearness),
                step,
                to_horizon: camera.to_horizon(step),
                depth: self.depths.stain(distance),
            }
        }));
    }

    fn stain<D: DepthBuffer>(
        &mut self,
        columns: &[DecalColumn],
        face: &Sidedef,
        stain: &Stain,
        mark: &Soot,
    ) {
        // Where its left and upper end lie: along the line, and above the eye.
        let left = face.position([mark.x, mark.y]) - (i64::from(stain.offset_x) << 16) / TEXELS;
        let above =
            i64::from(mark.z.0) + (i64::from(stain.offset_y) << 16) / TEXELS - self.camera.z;
        // From column to column positions along the wall rise.
        let texel_column = |column: &DecalColumn| ((column.along - left) * TEXELS) >> 16;
        let first = columns.partition_point(|column| texel_column(column) < 0);
        let count = columns[first..]
            .partition_point(|column| texel_column(column) < i64::from(stain.width));
        let columns = &columns[first..first + count];
        let covered = columns.first().map_or(0, |column| column.x)
            ..columns.last().map_or(0, |column| column.x + 1);
        let published = self.published.as_deref_mut().filter(|_| D::WRITTEN);
        let mut decal = published.and_then(|published| published.decal(covered));
        for column in columns {
            let Some(texels) = stain.column(texel_column(column), mark.mirrored) else { continue };
            // By the lower edges of rows as all things are, but upside down by the upper ones.
            let from_edge = if mark.upturned { column.step } else { 0 };
            let at = ((above * TEXELS) << 16) - column.to_horizon - from_edge;
            // Downwards texel rows grow: those of the picture are one run.
            let [top, bottom] = column.rows;
            let frame_row =
                |texel: usize| first_row(self.view, texel as u32, at, column.step.max(1)) as usize;
            let (first, end) = (frame_row(0).max(top), frame_row(texels.len()).min(bottom));
            if let Some(decal) = &mut decal {
                let shown = |row: usize| {
                    texels[if mark.upturned { texels.len() - 1 - row } else { row }] > 0
                };
                let rows = |run: [u16; 2]| {
                    let [start, end] = run.map(|texel| frame_row(texel.into()));
                    start.max(top)..end.min(bottom)
                };
                let depth = self.columns.depth_of(column.x);
                decal.column(column.x, depth, (0..texels.len()).map(shown), rows);
            }
            if first >= end {
                continue;
            }
            // Upside down from the last row upwards: what is left of a row counts as a whole one.
            let last = (texels.len() as i64) << 32;
            let (at, step) =
                if mark.upturned { (last - 1 - at, -column.step) } else { (at, column.step) };
            let hidden = |row: u32| {
                hidden(texels[((at + step * i64::from(row)) >> 32) as usize], column.table)
            };
            let rows = &self.view.rows[first..end];
            for (pixel, &row) in self.columns.colour_of(column.x)[first..end].iter_mut().zip(rows) {
                *pixel = self.scene.blend.darkened(*pixel, hidden(row));
            }
            if D::WRITTEN && decal.is_none() {
                let pixels = self.columns.depth_of(column.x)[first..end].iter_mut();
                pixels
                    .zip(rows)
                    .filter(|&(_, &row)| hidden(row) > 0)
                    .for_each(|(pixel, _)| *pixel = column.depth);
            }
        }
    }
}

/// Parts of [`WHOLE`] that a texel hides in the light of a table: in the dark there is less to
/// hide.
fn hidden(texel: u8, table: usize) -> u8 {
    let hidden = ((usize::from(texel) + 2) * (LIGHT_TABLES - table) + 2) >> 7;
    hidden.min(usize::from(WHOLE)) as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::Assets;
    use crate::map::stone_room;
    use crate::math::Angle;
    use crate::math::Fixed;
    use crate::render::buffers::request::Buffers;
    use crate::render::renderer::Renderer;
    use crate::render::scene::prepared::Scene;
    use crate::render::scratch::FrameScratch;
    use crate::render::view::size::FrameSize;
    use crate::render::view::tables::View;
    use crate::world::World;
    use std::sync::Arc;

    /// A room whose eastern wall the player sidedefs, and the pictures with a stain of 16 by 16
    /// texels that hides all but its rim.
    fn room() -> (World, Arc<Scene>) {
        let map = stone_room(255, [-64, -64, 64, 64], &[[0.0, 0.0]]);
        let texels = (0..256)
            .map(|at| if at % 16 % 15 == 0 || at / 16 % 15 == 0 { 0 } else { 255 })
            .collect();
        let soot = Some(Stain { width: 16, height: 16, offset_x: 8, offset_y: 8, texels });
        let scene =
            Arc::new(Scene::new(&map, Arc::new(Assets { soot, ..(*Assets::embedded()).clone() })));
        (World::new(map, 1), scene)
    }

    fn leave(world: &mut World, y: i32) {
        let east = Fixed::from_int(64);
        let index =
            world.map.lines.iter().position(|line| line.v1.x == east && line.v2.x == east).unwrap();
        world.leave_soot(
            index as u32,
            Fixed::from_int(50),
            Fixed::from_int(y),
            Fixed::from_int(41),
        );
    }

    fn frame(world: &World, scene: &Arc<Scene>, size: FrameSize) -> Vec<[u8; 3]> {
        let mut scratch = FrameScratch::default();
        let mut renderer = Renderer::new(Arc::clone(scene), Arc::new(View::new(size).unwrap()));
        renderer.render(&mut scratch, world, 0, Buffers { depth: true, labels: true });
        let mut rgb = vec![0; size.pixels() * 3];
        renderer.write_rgb_hwc(&mut rgb);
        rgb.as_chunks().0.to_vec()
    }

    #[test]
    fn a_stain_darkens_as_much_of_the_view_as_its_size_says() {
        let (mut world, scene) = room();
        let id = world.players[0].actor;
        world.get_mut(id).unwrap().angle = Angle::EAST;
        world.players[0].view_z = Fixed::from_int(41);
        world.players[0].sprites = [None; 2];
        for size in [FrameSize { width: 160, height: 120 }, FrameSize { width: 640, height: 480 }] {
            world.soot.clear();
            let clean = frame(&world, &scene, size);
            leave(&mut world, 0);
            let decal_columns = frame(&world, &scene, size);
            let dark: Vec<usize> =
                (0..clean.len()).filter(|&at| clean[at] != decal_columns[at]).collect();
            let darkest: Vec<[u8; 3]> = dark.iter().map(|&at| decal_columns[at]).collect();
            assert!(darkest.iter().flatten().all(|&channel| channel < 16), "{darkest:?}");
            // 14 texels are 7 units, 64 away: seven 128ths of the width, and 1.2 times as many
            // rows.
            let width = usize::from(size.width);
            let extent = |places: Vec<usize>| {
                1 + places.iter().max().unwrap() - places.iter().min().unwrap()
            };
            let columns = extent(dark.iter().map(|at| at % width).collect());
            let rows = extent(dark.iter().map(|at| at / width).collect());
            assert!(
                columns.abs_diff(width * 7 / 128) <= 1 && rows.abs_diff(width * 84 / 1280) <= 1,
                "{size:?}: {columns} {rows}"
            );
            assert_eq!(dark.len(), columns * rows);
        }
    }

    #[test]
    fn the_learners_frame_is_the_reduction_and_clean_pictures_stay_clean() {
        let (mut world, scene) = room();
        leave(&mut world, -3);
        leave(&mut world, 11);
        let large = frame(&world, &scene, FrameSize { width: 160, height: 120 });
        let small = frame(&world, &scene, FrameSize::LEARNER);
        let kept = (0..72 * 128).map(|at| large[at / 128 * 120 / 72 * 160 + at % 128 * 160 / 128]);
        assert!(kept.eq(small.iter().copied()));
        let without = Arc::new(Scene::new(&world.map, Assets::embedded()));
        let clean = frame(&world, &without, FrameSize::LEARNER);
        world.soot.clear();
        assert_eq!(frame(&world, &without, FrameSize::LEARNER), clean);
        assert_ne!(small, clean);
    }

    #[test]
    fn in_the_dark_there_is_less_to_hide() {
        assert_eq!([hidden(255, 0), hidden(0, 0), hidden(128, 0)], [WHOLE, 0, WHOLE / 2]);
        assert_eq!([hidden(255, 16), hidden(255, 31)], [WHOLE / 2, 2]);
    }
}
