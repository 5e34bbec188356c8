//! Authoring maps that are grids of square tiles.

use super::{MapBuilder, Mark, Style};

/// A grid of square tiles, row by row from the south-west.
#[derive(Clone, Debug)]
pub struct TileGrid {
    origin: (i32, i32),
    tile: i32,
    columns: usize,
    rows: usize,
    styles: Vec<Style>,
}

impl TileGrid {
    /// A grid whose tile (0, 0) has its south-western corner at `origin`, every tile in the style
    /// that `style` gives for its (column, row).
    pub fn new(
        origin: (i32, i32),
        tile: i32,
        columns: usize,
        rows: usize,
        mut style: impl FnMut(usize, usize) -> Style,
    ) -> TileGrid {
        let styles = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
        let styles = styles.map(|(column, row)| style(column, row)).collect();
        TileGrid { origin, tile, columns, rows, styles }
    }

    /// Paints the tiles. Neighbours of equal style become one sector, unless they have tags.
    pub fn paint(&self, builder: &mut MapBuilder) {
        for row in 0..self.rows {
            for column in 0..self.columns {
                let (west, south) = self.corner(column, row);
                let style = self.styles[row * self.columns + column];
                builder.rectangle(style, west, south, west + self.tile, south + self.tile);
            }
        }
    }

    /// Paints the tiles, and keeps a line between any two of them, also where they are one sector.
    pub fn paint_apart(&self, builder: &mut MapBuilder) {
        self.paint(builder);
        let kept = Mark { kept: true, ..Mark::default() };
        for column in 1..self.columns {
            builder.mark(kept, &[self.corner(column, 0), self.corner(column, self.rows)]);
        }
        for row in 1..self.rows {
            builder.mark(kept, &[self.corner(0, row), self.corner(self.columns, row)]);
        }
    }

    /// The south-western corner of a tile; also valid one past the last column and row.
    #[must_use]
    pub fn corner(&self, column: usize, row: usize) -> (i32, i32) {
        (self.origin.0 + column as i32 * self.tile, self.origin.1 + row as i32 * self.tile)
    }
}
