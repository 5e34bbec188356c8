//! Runs of pixels of a floor or ceiling.

use crate::render::buffers::frame::Frame;
use crate::render::buffers::visplane::Span;
use crate::render::planes::row;
use crate::render::planes::shader::PlaneShader;
use crate::render::textures::flat::FlatTexture;
use crate::simd::{Simd, dispatch};

/// Draws runs of pixels.
pub(crate) fn draw<const DEPTH: bool, const CLASS: bool>(
    shader: &PlaneShader,
    simd: Simd,
    frame: &mut Frame,
    flat: &FlatTexture,
    spans: &[Span],
) {
    match flat {
        FlatTexture::Small(texels) => {
            draw_from::<DEPTH, CLASS, 6, { 64 * 64 }>(shader, simd, frame, texels, spans)
        }
        FlatTexture::Large(texels) => {
            draw_from::<DEPTH, CLASS, 7, { 128 * 128 }>(shader, simd, frame, texels, spans)
        }
    }
}

fn draw_from<const DEPTH: bool, const CLASS: bool, const BITS: u32, const TEXELS: usize>(
    shader: &PlaneShader,
    simd: Simd,
    frame: &mut Frame,
    texels: &[u8; TEXELS],
    spans: &[Span],
) {
    dispatch!(simd;
        avx512 => draw_avx2::<DEPTH, CLASS, BITS, TEXELS>(shader, frame, texels, spans),
        avx2 => draw_avx2::<DEPTH, CLASS, BITS, TEXELS>(shader, frame, texels, spans),
        scalar => draw_scalar::<DEPTH, CLASS, BITS, TEXELS>(shader, frame, texels, spans),
    );
}

fn draw_scalar<const DEPTH: bool, const CLASS: bool, const BITS: u32, const TEXELS: usize>(
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
        shader.write::<DEPTH, CLASS>(frame, distance, start + first..start + end);
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn draw_avx2<const DEPTH: bool, const CLASS: bool, const BITS: u32, const TEXELS: usize>(
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
        shader.write::<DEPTH, CLASS>(frame, distance, start + first..start + end);
    }
}
