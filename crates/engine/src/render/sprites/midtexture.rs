//! The textures in clip, which have holes: drawn column by column, where nothing nearer hides them.

use crate::map::SectorId;
use crate::math::Fixed;
use crate::render::buffers::drawsegs::list::DrawSeg;
use crate::render::buffers::frame::{Frame, class};
use crate::render::buffers::written::{ClassBuffer, DepthBuffer};
use crate::render::sprites::midcolumn::{self, data::MidColumn};
use crate::render::sprites::pass::SpritePass;
use crate::render::sprites::posts::{PostProjection, PostScale};
use crate::render::textures::local_palette::LocalPalette;
use crate::render::textures::midtexture::Midtexture;
use crate::render::view::light::{Light, ONE_TABLE_DISTANCE};
use crate::render::view::line::{Edge, INVERSE_BITS, TextureLine};
use crate::render::view::view_space::ViewLine;
use std::ops::Range;

/// A masked texture as a frame sees it.
struct SeenTexture<'a> {
    drawseg: &'a DrawSeg,
    fence: &'a Midtexture,
    own: &'a LocalPalette,
    /// Where what is within the opening begins and ends.
    edges: [Edge; 2],
    /// Height of the top row relative to the eye, 16.16.
    hung_from: i64,
    along: TextureLine,
    light: Light,
    scales: PostScale,
}

/// A column of it.
struct Place {
    /// Frame column.
    x: usize,
    rows: Range<usize>,
}

impl SpritePass<'_> {
    /// Draws the frame columns `first..end` of the masked texture of an opening, and marks them as
    /// drawn.
    pub fn texture<D: DepthBuffer, C: ClassBuffer>(
        &mut self,
        drawseg: &DrawSeg,
        first: usize,
        end: usize,
    ) {
        let Some(seen) = self.seen_texture(drawseg) else { return };
        for x in first..end {
            let row_index = drawseg.rows + x - drawseg.first;
            let drawn = std::mem::replace(&mut self.drawsegs.drawn[row_index], true);
            if D::WRITTEN
                && let Some(published) = &mut self.published
            {
                let [from, to, column] = [first, end - 1, x].map(|x| self.view.columns[x]);
                let bottoms = &self.drawsegs.bottoms;
                published.begin_midtexture_column([from, to], column, bottoms, row_index);
            }
            let open =
                [self.drawsegs.tops[row_index], self.drawsegs.bottoms[row_index]].map(i32::from);
            let [top, bottom] =
                seen.edges.map(|edge| edge.row(&self.view.first_row, self.view.columns[x]));
            let rows = top.max(open[0])..bottom.min(open[1]);
            if !drawn && !rows.is_empty() {
                let rows = rows.start as usize..rows.end as usize;
                self.texture_column::<D, C>(&seen, Place { x, rows });
            }
            if D::WRITTEN
                && let Some(published) = &mut self.published
            {
                published.end_midtexture_column(x, self.frame.width, &mut self.frame.depth);
            }
        }
    }

    /// What its columns have in common, if there is a texture.
    fn seen_texture<'s>(&self, drawseg: &'s DrawSeg) -> Option<SeenTexture<'s>>
    where
        Self: 's,
    {
        let (scene, camera, view) = (self.scene, self.camera, self.view);
        let seg = &scene.segs[drawseg.seg as usize];
        let face = &scene.sidedefs[seg.face as usize];
        let picture = self.pictures[usize::from(face.middle?.0)] as usize;
        let fence = &scene.textures.midtextures[picture];
        let (front, back) =
            (self.world.sector(SectorId(seg.front)), self.world.sector(SectorId(seg.back)));
        let (floor, ceiling) = (front.floor.max(back.floor), front.ceiling.min(back.ceiling));
        let height = Fixed::from_int(fence.picture.height as i32);
        let hung_from =
            i64::from(if face.lower_unpegged { floor + height } else { ceiling }.0) + face.v_offset;
        let top = hung_from.min(i64::from(ceiling.0));
        let bottom = (hung_from - i64::from(height.0)).max(i64::from(floor.0));
        Some(SeenTexture {
            drawseg,
            fence,
            own: &scene.textures.own[picture],
            edges: [top, bottom].map(|height| drawseg.ends.edge(camera, view, height - camera.z)),
            hung_from: hung_from - camera.z,
            along: ViewLine::of_sidedef(camera, face).texture(view, face, drawseg.base_ends),
            light: Light::new(camera, i32::from(front.light) + face.contrast),
            scales: PostScale::new(view, &drawseg.line, drawseg.base_ends),
        })
    }

    #[inline]
    fn texture_column<D: DepthBuffer, C: ClassBuffer>(&mut self, seen: &SeenTexture, place: Place) {
        let Place { x, rows } = place;
        let (drawseg, fence, base_column) =
            (seen.drawseg, seen.fence, i64::from(self.view.columns[x]));
        let distance = drawseg.line.distance_at(base_column);
        let nearness =
            (drawseg.ends.inverse_at(base_column) * ONE_TABLE_DISTANCE) >> (INVERSE_BITS - 16);
        let u = seen.along.at(base_column, distance) >> 16;
        let u = u.rem_euclid(i64::from(fence.picture.width)) as u32;
        let (texels, runs) = fence.column(u);
        let table = seen.light.table(nearness);
        let step = (distance * self.view.inverse_focal_y) >> 16;
        let shown = MidColumn {
            texels,
            table: &self.scene.assets.light_tables[table],
            local_texels: &seen.own.texels[(u * fence.picture.height) as usize..][..texels.len()],
            lit: seen.own.lit(table),
            at: (seen.hung_from << 16) - self.camera.to_horizon(step),
            step,
            runs,
            hung: PostProjection {
                horizon: self.camera.horizon,
                eye: seen.hung_from,
                scale: seen.scales.at(base_column),
            },
        };
        let Frame { width, colour, depth, class: classes, depths, .. } = &mut *self.frame;
        let (height, focal_y) = (fence.picture.height, self.view.focal_y);
        let mut published = self.published.as_deref_mut().filter(|_| D::WRITTEN);
        let written = match &mut published {
            Some(published) => published.midtexture(distance, height, focal_y),
            None => depths.wall(distance, height),
        };
        midcolumn::draw(&shown, self.simd, &self.view.rows, rows, |row, lit| {
            let pixel = row * *width + x;
            colour[pixel] = lit;
            if D::WRITTEN {
                depth[pixel] = written;
            }
            if let Some(published) = &mut published {
                published.midtexture_row(row, written, || shown.run_at(self.view.rows[row]));
            }
            if C::WRITTEN {
                classes[pixel] = class::WALL;
            }
        });
    }
}
