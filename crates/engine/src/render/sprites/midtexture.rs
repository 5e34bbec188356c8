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
    /// The base columns that ViZDoom draws four at once; the depth of the others it writes as a
    /// sprite's.
    fours: Range<u32>,
}

/// A column of it.
struct Place {
    /// Frame column.
    x: usize,
    rows: Range<usize>,
    /// Which of four that are drawn at once it is.
    in_four: Option<usize>,
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
        let Some(seen) = self.seen_texture(drawseg, first, end) else { return };
        let by_quads = D::WRITTEN && self.frame.depths.by_quads();
        for x in first..end {
            let row_index = drawseg.rows + x - drawseg.first;
            let drawn = std::mem::replace(&mut self.drawsegs.drawn[row_index], true);
            let in_four = if D::WRITTEN { self.in_four(&seen, x) } else { None };
            if by_quads && in_four == Some(0) {
                self.midtexture_depth.begin();
            }
            let open =
                [self.drawsegs.tops[row_index], self.drawsegs.bottoms[row_index]].map(i32::from);
            let [top, bottom] =
                seen.edges.map(|edge| edge.row(&self.view.first_row, self.view.columns[x]));
            let rows = top.max(open[0])..bottom.min(open[1]);
            if !drawn && !rows.is_empty() {
                let rows = rows.start as usize..rows.end as usize;
                self.texture_column::<D, C>(&seen, Place { x, rows, in_four });
            }
            if by_quads && in_four == Some(3) {
                let Frame { width, depth, .. } = &mut *self.frame;
                self.midtexture_depth.end(|column, row, written| {
                    depth[usize::from(row) * *width + x - 3 + column] = written
                });
            }
        }
    }

    /// What the columns `first..end` have in common, if there is a texture.
    fn seen_texture<'s>(
        &self,
        drawseg: &'s DrawSeg,
        first: usize,
        end: usize,
    ) -> Option<SeenTexture<'s>>
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
            fours: (view.columns[first] + 3) & !3..(view.columns[end - 1] + 1) & !3,
        })
    }

    /// Which of four columns that are drawn at once a frame column is.
    fn in_four(&self, seen: &SeenTexture, x: usize) -> Option<usize> {
        let column = self.view.columns[x];
        let place = (column & 3) as usize;
        // Nor are they drawn at once where nearer walls without an opening hide one of them.
        let is_whole = || {
            let four = seen.drawseg.rows + x - seen.drawseg.first - place;
            self.drawsegs.bottoms[four..four + 4].iter().all(|&bottom| bottom > 0)
        };
        (seen.fours.contains(&column) && (!self.frame.depths.by_quads() || is_whole()))
            .then_some(place)
    }

    #[inline]
    fn texture_column<D: DepthBuffer, C: ClassBuffer>(&mut self, seen: &SeenTexture, place: Place) {
        let Place { x, rows, in_four } = place;
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
        let written = match in_four {
            Some(_) => depths.wall(distance, fence.picture.height),
            None => depths.sprite(distance, self.view.focal_y),
        };
        if D::WRITTEN && in_four.is_none() {
            self.midtexture_depth.note(written);
        }
        midcolumn::draw(&shown, self.simd, &self.view.rows, rows, |row, lit| {
            let pixel = row * *width + x;
            colour[pixel] = lit;
            if D::WRITTEN {
                depth[pixel] = written;
            }
            if D::WRITTEN
                && depths.by_quads()
                && let Some(column) = in_four
            {
                self.midtexture_depth.add(
                    column,
                    row as u16,
                    shown.run_at(self.view.rows[row]),
                    written,
                );
            }
            if C::WRITTEN {
                classes[pixel] = class::WALL;
            }
        });
    }
}
