//! A column of a midtexture row by row.

use crate::render::sprites::midcolumn::data::MidColumn;
use std::ops::Range;

/// Gives the frame rows of `rows` that show a texel and their colours to `put`.
#[inline(always)]
pub(crate) fn draw(
    column: &MidColumn,
    base_rows: &[u32],
    rows: Range<usize>,
    mut put: impl FnMut(usize, u8),
) {
    // Further down there are no texels further up.
    let (mut runs, mut run, mut first_row) = (column.runs.iter(), [0, 0], i64::MAX);
    for row in rows {
        let v = column.texel_at(base_rows[row]);
        while v >= usize::from(run[1]) {
            let Some(&next) = runs.next() else { return };
            (run, first_row) = (next, column.hung.first_row(next));
        }
        if v >= usize::from(run[0]) && i64::from(base_rows[row]) >= first_row {
            put(row, column.table[usize::from(column.texels[v] as u8)]);
        }
    }
}
