//! Texture positions one by one.

use crate::render::blocks::CHUNK;
use crate::render::planes::row::data::{RowWalk, index};

/// Fills whole chunks, the first of which has the given base columns.
pub(crate) fn draw_chunks<const BITS: u32>(
    walk: &RowWalk,
    pixels: &mut [u8],
    columns: &[u32; CHUNK],
    stride: u32,
    fetch: impl Fn(usize) -> u8 + Copy,
) {
    let mut columns = *columns;
    for chunk in pixels.chunks_exact_mut(CHUNK) {
        for (pixel, column) in chunk.iter_mut().zip(&mut columns) {
            let (u, v) = walk.at(*column);
            *pixel = fetch(index::<BITS>(u, v) as usize);
            *column = column.wrapping_add(stride);
        }
    }
}
