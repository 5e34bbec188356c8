//! Columns of walls in batches, for processors with 64-byte vectors and frames as low as learners':
//! listed while the world is walked, and drawn together. How many columns a wall has, and which of
//! them are covered, is unpredictable; in one list of all walls one column is like the next. Other
//! walls are drawn column by column (`walls::shade`); `render_tests` compares whole frames.

crate::simd::kernel_files!(avx512);
pub mod data;

use crate::render::blocks::ROW_BLOCK;
use crate::render::buffers::frame::Columns;
use crate::render::buffers::written::DepthBuffer;
use crate::render::view::depth::DepthEncoding;
use crate::render::walls::shader::WallShader;
use crate::simd::{Level, Simd, dispatch};
use data::WallBatch;

/// Whether a family of vectors draws walls in batches.
pub(crate) fn is_used(simd: Simd) -> bool {
    simd.level() == Level::Avx512
}

/// Adds the `count` frame columns from `first` on of a wall that shows a picture with texels from
/// `start` on, where `tops` are above `bottoms`; these lists are padded. Only where batches [are
/// used](is_used).
#[allow(clippy::too_many_arguments, reason = "a wall, its picture and its columns")]
pub(crate) fn add<D: DepthBuffer>(
    batch: &mut WallBatch,
    simd: Simd,
    shader: &WallShader,
    start: u32,
    first: usize,
    count: usize,
    tops: &[i16],
    bottoms: &[i16],
) {
    dispatch!(simd;
        avx512 => avx512::add::<D>(batch, shader, start, first, count, tops, bottoms),
        scalar => unreachable!("batches are of processors with 64-byte vectors alone"),
    );
}

/// Draws the columns and forgets them; `rows` are the frame's base rows, `texels` those of all
/// pictures.
pub(crate) fn draw<D: DepthBuffer>(
    batch: &mut WallBatch,
    simd: Simd,
    frame: &mut Columns,
    rows: &[u32; ROW_BLOCK],
    texels: &[u8],
    tables: &[[u8; 256]; 32],
    depths: DepthEncoding,
) {
    dispatch!(simd;
        avx512 => avx512::draw::<D>(batch, frame, rows, texels, tables, depths),
        scalar => unreachable!("batches are of processors with 64-byte vectors alone"),
    );
    batch.clear();
}
