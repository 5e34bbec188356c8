//! Building the blockmap: which lines touch which 128-unit block.

use super::{Blockmap, Line, MapError};
use crate::math::Fixed;
use std::ops::Range;

/// Side of a block: 128 map units, as a shift of raw fixed-point values.
const BLOCK_SHIFT: u32 = 16 + 7;

/// Most line entries of a blockmap; a map of 65,000 lines of ordinary length has some 200,000.
const ENTRY_LIMIT: usize = 8_000_000;

impl Blockmap {
    /// Lists the lines by block. A line is in every block whose closed square it touches, so that
    /// a look in the blocks that a box overlaps meets every line that the box touches.
    pub(super) fn build(lines: &[Line]) -> Result<Blockmap, MapError> {
        let limit = |pick: fn(&Line) -> i32, low: bool| {
            let all = lines.iter().map(pick);
            (if low { all.min() } else { all.max() }).unwrap_or(0)
        };
        // At the map's corner, where the original has it: slides look for walls block by block, and
        // tile maps have the lines of one tile in few blocks.
        let origin_x = limit(|l| l.bounds[0].0, true) >> 16 << 16;
        let origin_y = limit(|l| l.bounds[2].0, true) >> 16 << 16;
        let columns = block_of(limit(|l| l.bounds[1].0, false), origin_x) + 1;
        let rows = block_of(limit(|l| l.bounds[3].0, false), origin_y) + 1;

        let mut counts = vec![0u32; (columns * rows) as usize + 1];
        let mut total = 0usize;
        for line in lines {
            for_each_block(line, origin_x, origin_y, columns, rows, |block| {
                counts[block + 1] += 1;
                total += 1;
            });
            if total > ENTRY_LIMIT {
                return Err(MapError::TooComplex {
                    what: "its lines cross too many 128-unit blocks",
                });
            }
        }
        for i in 1..counts.len() {
            counts[i] += counts[i - 1];
        }
        let starts = counts;
        let mut next = starts.clone();
        let mut entries = vec![0u32; total];
        for (index, line) in lines.iter().enumerate() {
            for_each_block(line, origin_x, origin_y, columns, rows, |block| {
                entries[next[block] as usize] = index as u32;
                next[block] += 1;
            });
        }
        let bounds = entries.iter().map(|&index| lines[index as usize].bounds).collect();
        let (origin_x, origin_y) = (Fixed(origin_x), Fixed(origin_y));
        Ok(Blockmap { origin_x, origin_y, columns, rows, starts, lines: entries, bounds })
    }

    /// The lines of the block in column `column` and row `row`; none outside the map.
    #[must_use]
    pub fn lines_in(&self, column: i32, row: i32) -> &[u32] {
        &self.lines[self.entries_of(column, row)]
    }

    /// The same with their limits.
    #[inline]
    pub(crate) fn bounded_lines_in(
        &self,
        column: i32,
        row: i32,
    ) -> impl Iterator<Item = (u32, &[Fixed; 4])> {
        let entries = self.entries_of(column, row);
        self.lines[entries.clone()].iter().copied().zip(&self.bounds[entries])
    }

    fn entries_of(&self, column: i32, row: i32) -> Range<usize> {
        if column < 0 || row < 0 || column >= self.columns || row >= self.rows {
            return 0..0;
        }
        let block = (row * self.columns + column) as usize;
        self.starts[block] as usize..self.starts[block + 1] as usize
    }

    /// The block column of `x`, which may lie outside the map.
    #[must_use]
    pub fn column_of(&self, x: Fixed) -> i32 {
        block_of(x.0, self.origin_x.0)
    }

    /// The block row of `y`, which may lie outside the map.
    #[must_use]
    pub fn row_of(&self, y: Fixed) -> i32 {
        block_of(y.0, self.origin_y.0)
    }
}

fn block_of(raw: i32, origin: i32) -> i32 {
    ((i64::from(raw) - i64::from(origin)) >> BLOCK_SHIFT) as i32
}

/// Calls `visit` with each block that the line touches: row by row, the columns between the line's
/// least and greatest x within the row, widened by one raw unit against rounding and by the
/// neighbours that share a touched edge.
fn for_each_block(
    line: &Line,
    origin_x: i32,
    origin_y: i32,
    columns: i32,
    rows: i32,
    mut visit: impl FnMut(usize),
) {
    let [west, east, south, north] = line.bounds.map(|limit| i64::from(limit.0));
    let (x1, y1) = (i64::from(line.v1.x.0), i64::from(line.v1.y.0));
    let (dx, dy) = (i64::from(line.dx.0), i64::from(line.dy.0));
    let (origin_x, origin_y) = (i64::from(origin_x), i64::from(origin_y));
    // The least block whose closed square holds `low`, and the greatest that holds `high`.
    let first = |low: i64, origin: i64| (low - origin - 1) >> BLOCK_SHIFT;
    let last = |high: i64, origin: i64| (high - origin) >> BLOCK_SHIFT;
    let first_row = first(south, origin_y).max(0);
    let last_row = last(north, origin_y).min(i64::from(rows) - 1);
    for row in first_row..=last_row {
        let bottom = (origin_y + (row << BLOCK_SHIFT)).max(south);
        let top = (origin_y + ((row + 1) << BLOCK_SHIFT)).min(north);
        let (low, high) = if dy == 0 {
            (west, east)
        } else {
            let at = |y: i64| {
                (i128::from(x1) + i128::from(y - y1) * i128::from(dx) / i128::from(dy)) as i64
            };
            let (a, b) = (at(bottom), at(top));
            ((a.min(b) - 1).max(west), (a.max(b) + 1).min(east))
        };
        let first_column = first(low, origin_x).max(0);
        let last_column = last(high, origin_x).min(i64::from(columns) - 1);
        for column in first_column..=last_column {
            visit((row * i64::from(columns) + column) as usize);
        }
    }
}
