//! What one column of a wall shows, as a formula.

use crate::render::buffers::frame::Columns;
use crate::render::buffers::written::DepthBuffer;
use crate::render::view::light::ONE_TABLE_DISTANCE;
use crate::render::view::line::INVERSE_BITS;
use crate::render::walls::column::{self, data::Column};
use crate::render::walls::shader::{WallColumn, WallShader, WallSlope};
use crate::simd::Simd;

/// What a base column shows.
#[inline(always)]
pub(crate) fn column(shader: &WallShader, slope: &WallSlope, column: i64) -> WallColumn {
    let distance = shader.line.distance_at(column);
    let nearness = (shader.ends.inverse_at(column) * ONE_TABLE_DISTANCE) >> (INVERSE_BITS - 16);
    let step = (((distance * shader.view.inverse_focal_y) >> 24)
        .wrapping_mul(shader.picture.inverse_height))
        >> 24;
    let at = slope
        .start
        .wrapping_add(step.wrapping_mul(slope.rows))
        .wrapping_sub((step * slope.fraction) >> 16);
    WallColumn {
        distance,
        u: shader.texture.at(column, distance),
        table: shader.light.table(nearness),
        at: at as u32,
        step: step as u32,
    }
}

/// Draws rows `top..bottom` of frame column `x`.
#[inline(always)]
pub(crate) fn draw_column<D: DepthBuffer>(
    shader: &WallShader,
    simd: Simd,
    frame: &mut Columns,
    x: usize,
    [top, bottom]: [usize; 2],
    WallColumn { distance, u, table, at, step }: WallColumn,
) {
    let column =
        Column { texels: shader.picture.column(u), table: &shader.tables[table], at, step };
    column::draw(&column, simd, frame.colour_of(x), &shader.view.rows, top, bottom);
    if D::WRITTEN {
        let depth = shader.depths.wall(distance, shader.picture.height);
        frame.depth_of(x)[top..bottom].fill(depth);
    }
    // The class of a wall is what the frame was cleared to.
}

/// Draws rows `tops[i]..bottoms[i]` of the frame columns from `first` on.
pub(crate) fn draw<D: DepthBuffer>(
    shader: &WallShader,
    simd: Simd,
    frame: &mut Columns,
    first: usize,
    tops: &[i16],
    bottoms: &[i16],
) {
    let slope = shader.slope();
    for (x, (&top, &bottom)) in (first..).zip(tops.iter().zip(bottoms)) {
        if top < bottom {
            let shown = column(shader, &slope, i64::from(shader.view.columns[x]));
            draw_column::<D>(shader, simd, frame, x, [top as usize, bottom as usize], shown);
        }
    }
}
