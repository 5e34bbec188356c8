//! The spans of a plane, their rows by vectors of 32 bytes.

use crate::render::buffers::frame::Frame;
use crate::render::buffers::visplane::Span;
use crate::render::buffers::written::{ClassBuffer, DepthBuffer};
use crate::render::planes::row;
use crate::render::planes::shader::PlaneShader;

/// Draws spans of a square texture of side `2^BITS`.
#[target_feature(enable = "avx2")]
pub(crate) fn draw<D: DepthBuffer, C: ClassBuffer, const BITS: u32, const TEXELS: usize>(
    shader: &PlaneShader,
    frame: &mut Frame,
    texels: &[u8; TEXELS],
    spans: &[Span],
) {
    for span in spans {
        let (first, end) = (usize::from(span.first), usize::from(span.end));
        let (distance, table, start) = shader.row(frame.width, span.row);
        // The status bar follows the last row.
        let pixels = &mut frame.colour[start + first..start + end + row::avx2::ROW_GROUP];
        let columns = shader.view.columns[first..].first_chunk().expect("the list is padded");
        let walk = shader.walk::<BITS>(distance);
        row::avx2::draw::<BITS, TEXELS>(
            &walk,
            pixels,
            end - first,
            columns,
            shader.view.chunk_stride,
            (texels, table),
        );
        shader.write::<D, C>(frame, distance, start + first..start + end);
    }
}
