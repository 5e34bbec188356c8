//! The sky pixel by pixel.

use crate::render::buffers::frame::Columns;
use crate::render::buffers::visplane::VisPlane;
use crate::render::planes::sky::shader::SkyShader;

/// Draws the columns of a plane of the sky; `starts` has the first texel of each.
pub(crate) fn draw(
    shader: &SkyShader,
    columns: &mut Columns,
    plane: &VisPlane,
    starts: &[u32],
    texel_rows: &[u16],
) {
    let shown = plane.first..plane.end;
    for (x, &start) in shown.clone().zip(&starts[shown]) {
        let (top, bottom) = (plane.top[x], plane.bottom[x]);
        if top >= bottom {
            continue;
        }
        let texels = &shader.picture.pixels[start as usize..];
        let rows = top as usize..bottom as usize;
        for (pixel, &row) in columns.colour_of(x)[rows.clone()].iter_mut().zip(&texel_rows[rows]) {
            *pixel = shader.table[usize::from(texels[usize::from(row)])];
        }
    }
}
