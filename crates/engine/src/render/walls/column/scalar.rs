//! A column of a texture of any height, row by row.

use crate::render::walls::column::data::Column;

/// Draws rows `top..bottom` of a column.
pub(crate) fn draw(column: &Column, pixels: &mut [u8], rows: &[u32], top: usize, bottom: usize) {
    for (pixel, &row) in pixels[top..bottom].iter_mut().zip(&rows[top..bottom]) {
        let texel = (u64::from(column.at.wrapping_add(column.step.wrapping_mul(row)))
            * column.texels.len() as u64)
            >> 32;
        *pixel = column.table[usize::from(column.texels[texel as usize])];
    }
}
