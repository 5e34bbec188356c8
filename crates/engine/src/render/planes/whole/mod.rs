//! Whole floors and ceilings at once, where the vectors and the frame allow it.

crate::simd::kernel_files!(avx512);
use crate::render::buffers::frame::Frame;
use crate::render::buffers::visplane::VisPlane;
use crate::render::buffers::written::{ClassBuffer, DepthBuffer};
use crate::render::planes::shader::PlaneShader;
use crate::render::textures::flat::FlatTexture;
use crate::simd::{Simd, dispatch};

/// Draws a plane, if it can be drawn as a whole; returns whether it was. What is left is drawn span
/// by span.
pub(crate) fn draw<D: DepthBuffer, C: ClassBuffer>(
    shader: &PlaneShader,
    simd: Simd,
    frame: &mut Frame,
    flat: &FlatTexture,
    plane: &VisPlane,
) -> bool {
    dispatch!(simd; avx512 => avx512::draw::<D, C>(shader, frame, flat, plane), scalar => {
        let _ = (shader, frame, flat, plane);
        false
    })
}
