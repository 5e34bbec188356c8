//! Where a search of the BSP tree may begin: below all nodes whose partition line passes a whole
//! cell of a grid by.

use super::{Node, Vertex};
use crate::math::Fixed;

/// Smallest side of a cell: 32 map units, as a shift of raw fixed-point values.
const LEAST_SHIFT: u32 = 16 + 5;
/// Most cells; larger maps get larger ones.
const CELL_LIMIT: u64 = 1 << 14;

/// For each cell the child of the tree that holds all of it. Most cells lie in one leaf or near it,
/// so that finding the leaf of a point takes a step or two instead of the whole way from the root,
/// each a branch that cannot be predicted.
#[derive(Clone, Debug, Default)]
pub struct Locator {
    /// South-west corner of the first cell, raw.
    origin: [i64; 2],
    /// Side of a cell, as a shift.
    shift: u32,
    columns: u64,
    rows: u64,
    /// Row by row.
    starts: Vec<u32>,
}

impl Locator {
    /// Cells over all vertices.
    pub(super) fn build(vertices: &[Vertex], nodes: &[Node]) -> Locator {
        let limits = |pick: fn(&Vertex) -> i32| {
            let all = || vertices.iter().map(pick);
            (i64::from(all().min().unwrap_or(0)), i64::from(all().max().unwrap_or(0)))
        };
        let ((west, east), (south, north)) = (limits(|v| v.x.0), limits(|v| v.y.0));
        let cells = |shift: u32| {
            ((((east - west) >> shift) + 1) as u64, (((north - south) >> shift) + 1) as u64)
        };
        let fits = |&shift: &u32| {
            let (columns, rows) = cells(shift);
            columns * rows <= CELL_LIMIT
        };
        let shift = (LEAST_SHIFT..32).find(fits).unwrap_or(32);
        let (columns, rows) = cells(shift);
        // A cell has its northern edge and not its southern one: points on a line between north and
        // south belong to the south.
        let (south, rows) = (south + 1 - (1 << shift), rows + 1);
        let mut locator =
            Locator { origin: [west, south], shift, columns, rows, starts: Vec::new() };
        let last = (1i64 << shift) - 1;
        for (row, column) in
            (0..rows as i64).flat_map(|row| (0..columns as i64).map(move |column| (row, column)))
        {
            let [west, south] = [west + (column << shift), south + (row << shift)];
            // Cells at the rim may reach beyond what a coordinate holds; no point is there.
            let ends = |first: i64| {
                [first, first + last].map(|raw| Fixed(raw.min(i64::from(i32::MAX)) as i32))
            };
            locator.starts.push(child_of_cell(nodes, ends(west), ends(south)));
        }
        locator
    }

    /// The child of the tree that the search for a point begins at, `root` for points beyond the
    /// cells.
    #[inline]
    pub(super) fn start(&self, x: Fixed, y: Fixed, root: u32) -> u32 {
        let cell = |raw: i32, origin: i64| ((i64::from(raw) - origin) >> self.shift) as u64;
        let (column, row) = (cell(x.0, self.origin[0]), cell(y.0, self.origin[1]));
        if column < self.columns && row < self.rows {
            self.starts[(row * self.columns + column) as usize]
        } else {
            root
        }
    }
}

/// The lowest child that holds a whole cell: the side of a line that all four corners are on is
/// that of the cell.
fn child_of_cell(nodes: &[Node], x: [Fixed; 2], y: [Fixed; 2]) -> u32 {
    let Some(root) = nodes.len().checked_sub(1) else { return Node::SUBSECTOR };
    let mut child = root as u32;
    while child & Node::SUBSECTOR == 0 {
        let node = &nodes[child as usize];
        let left = node.is_left(x[0], y[0]);
        if [(0, 1), (1, 0), (1, 1)].iter().any(|&(i, j)| node.is_left(x[i], y[j]) != left) {
            break;
        }
        child = node.children[usize::from(left)];
    }
    child
}
