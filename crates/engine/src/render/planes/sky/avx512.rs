//! Columns of the sky, 64 rows at a time: a column of texels is four vectors.

use crate::render::blocks::ROW_BLOCK;
use crate::render::buffers::frame::Columns;
use crate::render::buffers::visplane::VisPlane;
use crate::render::planes::sky::shader::SkyShader;
use crate::simd::lookup::avx512::{load, load_table, look_up_block};
use std::arch::x86_64::*;

/// Highest picture: as many rows as a byte distinguishes.
const MOST_TEXELS: usize = 256;

/// Whether the picture's columns fit a table.
pub(crate) fn fits(shader: &SkyShader) -> bool {
    shader.picture.height as usize <= MOST_TEXELS
}

/// Draws a plane of the sky. `starts` are where the texels of each column begin, `texel_rows` the
/// texel of each row.
#[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx512vbmi")]
pub(crate) fn draw(
    shader: &SkyShader,
    columns: &mut Columns,
    plane: &VisPlane,
    starts: &[u32],
    texel_rows: &[u16],
) {
    let table = load_table(shader.table);
    for (block, texel_rows) in texel_rows.chunks(ROW_BLOCK).enumerate() {
        let mut bytes = [0; ROW_BLOCK];
        bytes.iter_mut().zip(texel_rows).for_each(|(byte, &row)| *byte = row as u8);
        let rows = load(&bytes);
        let from = block * ROW_BLOCK;
        let range = plane.first..plane.end;
        for (x, &start) in range.clone().zip(&starts[range]) {
            let bounded =
                |row: i16| (i32::from(row) - from as i32).clamp(0, ROW_BLOCK as i32) as u32;
            let (top, bottom) = (bounded(plane.top[x]), bounded(plane.bottom[x]));
            if top >= bottom {
                continue;
            }
            let texels = &shader.picture.pixels[start as usize..][..shader.picture.height as usize];
            let lit = look_up_block(table, look_up_block(texel_table(texels), rows));
            let mask = (u64::MAX << top) & (u64::MAX >> (ROW_BLOCK as u32 - bottom));
            let pixels: &mut [u8; ROW_BLOCK] =
                columns.colour_of(x)[from..].first_chunk_mut().expect("columns are whole blocks");
            // SAFETY: 64 bytes are writable behind the reference.
            unsafe { _mm512_mask_storeu_epi8(pixels.as_mut_ptr().cast(), mask, lit) }
        }
    }
}

/// Up to 256 texels, as a table.
#[inline]
#[target_feature(enable = "avx512f,avx512bw")]
fn texel_table(texels: &[u8]) -> [__m512i; 4] {
    let block = |i: usize| {
        let texels = &texels[(i * 64).min(texels.len())..];
        let there = if texels.len() >= 64 { u64::MAX } else { (1 << texels.len()) - 1 };
        // SAFETY: only the texels that are there are read.
        unsafe { _mm512_maskz_loadu_epi8(there, texels.as_ptr().cast()) }
    };
    [block(0), block(1), block(2), block(3)]
}
