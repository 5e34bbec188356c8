//! A patch column by column.

use crate::render::buffers::frame::Frame;
use crate::render::buffers::written::{ClassBuffer, DepthBuffer};
use crate::render::patch::data::{DrawnBounds, Patch};
use crate::render::textures::masked::MaskedTexture;
use std::ops::Range;

/// More rows than these are searched for those of a column that show no air: in a learner's frame
/// few sprites have so many.
const SEARCHED_ROWS: usize = 32;

/// Draws some rows of a patch; `base_rows` are the base rows of the frame's.
pub(crate) fn draw<D: DepthBuffer, C: ClassBuffer>(
    stamp: &Patch,
    frame: &mut Frame,
    base_rows: &[u32],
    rows: Range<usize>,
) -> DrawnBounds {
    let mut covered = DrawnBounds::NOTHING;
    for i in 0..stamp.columns.count() {
        let (top, bottom) =
            (stamp.columns.tops[i].max(0) as usize, stamp.columns.bottoms[i].max(0) as usize);
        let open = rows.start.max(top)..rows.end.min(bottom);
        if !open.is_empty() {
            column::<D, C>(stamp, frame, base_rows, i, open, &mut covered);
        }
    }
    covered
}

/// Draws the rows `open` of column `i`.
fn column<D: DepthBuffer, C: ClassBuffer>(
    stamp: &Patch,
    frame: &mut Frame,
    base_rows: &[u32],
    i: usize,
    mut open: Range<usize>,
    covered: &mut DrawnBounds,
) {
    let (x, width) = (stamp.first + i, frame.width);
    let texels = stamp.picture.column(stamp.columns.texels[i]);
    if open.len() > SEARCHED_ROWS {
        // Half of a weapon's picture is air above it.
        let extent = stamp.picture.extent(stamp.columns.texels[i]);
        let before = |texel: usize| {
            base_rows[open.clone()].partition_point(|&base_row| stamp.texel_row(base_row) < texel)
        };
        open = open.start + before(extent.start)..open.start + before(extent.end);
    }
    let lines =
        frame.colour[open.start * width..].chunks_exact_mut(width).zip(&base_rows[open.clone()]);
    // Which texels are holes is unpredictable.
    match stamp.mixture {
        None => lines.for_each(|(line, &base_row)| {
            let texel = texels[stamp.texel_row(base_row)];
            let lit = stamp.table[usize::from(texel as u8)];
            line[x] = if texel & MaskedTexture::OPAQUE != 0 { lit } else { line[x] };
        }),
        Some(mixture) => lines.for_each(|(line, &base_row)| {
            let texel = texels[stamp.texel_row(base_row)];
            let lit = mixture.over(stamp.table[usize::from(texel as u8)], line[x]);
            line[x] = if texel & MaskedTexture::OPAQUE != 0 { lit } else { line[x] };
        }),
    }
    if !(D::WRITTEN || C::WRITTEN) {
        return;
    }
    let (mut first, mut end) = (usize::MAX, 0);
    for row in open {
        let (opaque, at) =
            (texels[stamp.texel_row(base_rows[row])] & MaskedTexture::OPAQUE != 0, row * width + x);
        if D::WRITTEN {
            let pixel = &mut frame.depth[at];
            *pixel = if opaque { stamp.depth } else { *pixel };
        }
        if C::WRITTEN {
            let pixel = &mut frame.class[at];
            *pixel = if opaque { stamp.class } else { *pixel };
            first = if opaque { first.min(row) } else { first };
            end = if opaque { row + 1 } else { end };
        }
    }
    if first < end {
        covered.add(x..x + 1, first..end);
    }
}
