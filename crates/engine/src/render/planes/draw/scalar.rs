//! The spans of a plane, their rows by the vectors that every processor has.

use crate::render::buffers::frame::Frame;
use crate::render::buffers::visplane::Span;
use crate::render::buffers::written::{ClassBuffer, DepthBuffer};
use crate::render::planes::row;
use crate::render::planes::shader::PlaneShader;

/// Draws spans of a square texture of side `2^BITS`.
#[inline]
pub(crate) fn draw<D: DepthBuffer, C: ClassBuffer, const BITS: u32, const TEXELS: usize>(
    shader: &PlaneShader,
    frame: &mut Frame,
    texels: &[u8; TEXELS],
    spans: &[Span],
) {
    for span in spans {
        let (first, end) = (usize::from(span.first), usize::from(span.end));
        let (distance, table, start) = shader.row(frame.width, span.row);
        let pixels = &mut frame.colour[start + first..start + end];
        let fetch = |index: usize| table[usize::from(texels[index & (TEXELS - 1)])];
        row::draw::<BITS>(
            &shader.walk::<BITS>(distance),
            pixels,
            &shader.view.columns[first..end],
            shader.view.chunk_stride,
            fetch,
        );
        shader.write::<D, C>(frame, distance, start + first..start + end);
    }
}
