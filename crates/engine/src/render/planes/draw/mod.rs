//! Runs of pixels of a floor or ceiling.

crate::simd::kernel_files!(avx2);
mod scalar;

use crate::render::buffers::frame::Frame;
use crate::render::buffers::visplane::Span;
use crate::render::buffers::written::{ClassBuffer, DepthBuffer};
use crate::render::planes::shader::PlaneShader;
use crate::render::textures::flat::FlatTexture;
use crate::simd::{Simd, dispatch};

/// Draws runs of pixels.
pub(crate) fn draw<D: DepthBuffer, C: ClassBuffer>(
    shader: &PlaneShader,
    simd: Simd,
    frame: &mut Frame,
    flat: &FlatTexture,
    spans: &[Span],
) {
    match flat {
        FlatTexture::Small(texels) => {
            draw_from::<D, C, 6, { 64 * 64 }>(shader, simd, frame, texels, spans)
        }
        FlatTexture::Large(texels) => {
            draw_from::<D, C, 7, { 128 * 128 }>(shader, simd, frame, texels, spans)
        }
    }
}

fn draw_from<D: DepthBuffer, C: ClassBuffer, const BITS: u32, const TEXELS: usize>(
    shader: &PlaneShader,
    simd: Simd,
    frame: &mut Frame,
    texels: &[u8; TEXELS],
    spans: &[Span],
) {
    dispatch!(simd;
        avx512 => avx2::draw::<D, C, BITS, TEXELS>(shader, frame, texels, spans),
        avx2 => avx2::draw::<D, C, BITS, TEXELS>(shader, frame, texels, spans),
        scalar => scalar::draw::<D, C, BITS, TEXELS>(shader, frame, texels, spans),
    );
}
