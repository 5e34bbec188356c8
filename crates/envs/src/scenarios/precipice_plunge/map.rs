//! The shaft of Precipice Plunge: a corridor of 58 x 7 tiles that the rules lower into a descending cave.

use hasard_engine::map::{MapBuilder, MapSource, Mark, Style, TileGrid};

/// Side of a tile, map units.
pub const TILE: i32 = 64;
/// Tiles from west to east.
pub const COLUMNS: usize = 58;
/// Tiles from south to north.
pub const ROWS: usize = 7;
/// Columns of the platform that stays at height 0.
pub const START_COLUMNS: usize = 2;
/// Tag of tile (2, 0); tags go up row by row, then column by column.
pub const FIRST_TAG: i32 = 128;

/// Ceiling before it sinks.
pub const CEILING: i32 = 128;

/// The lines at the western edge of these columns run from north to south, all others that part two tiles from south to north or
/// from west to east. The engine counts a body within a 64th of a unit of a tile's line as in front of it, so that the direction
/// decides on which tic a body that falls along a step begins to slide: episodes recorded with random actions come out exactly
/// with these columns turned, and with any one of them not so, several do not.
const TURNED_COLUMNS: [i32; 9] = [11, 13, 15, 17, 18, 20, 22, 24, 28];

/// The tag of a tile, 0 on the start platform.
#[must_use]
pub fn tag(column: usize, row: usize) -> i32 {
    column.checked_sub(START_COLUMNS).map_or(0, |x| FIRST_TAG + (x * ROWS + row) as i32)
}

/// The map, with the flat bottom of the cave beginning at column `bottom`. All floors start at 0.
#[must_use]
pub fn source(bottom: usize) -> MapSource {
    let mut builder = MapBuilder::new();
    let grid = TileGrid::new((0, 0), TILE, COLUMNS, ROWS, |column, row| Style {
        floor: 0,
        ceiling: CEILING,
        light: 260,
        floor_texture: if column < bottom { "FLAT5" } else { "AQF018" },
        ceiling_texture: "RROCK15",
        wall: "BIGBRIK1",
        step: if column < START_COLUMNS || column % 2 == 0 { "A-MUD" } else { "ZIMMER4" },
        lintel: "BIGBRIK1",
        special: 0,
        tag: tag(column, row),
    });
    grid.paint(&mut builder);
    // The platform's walls are in pieces of a tile, as in the original: how a body in the air stops at a wall depends on
    // its length.
    let mut piece = |from: (usize, usize), to: (usize, usize)| {
        builder.mark(Mark::default(), &[grid.corner(from.0, from.1), grid.corner(to.0, to.1)]);
    };
    for column in 0..START_COLUMNS {
        piece((column, 0), (column + 1, 0));
        piece((column, ROWS), (column + 1, ROWS));
    }
    for row in 0..ROWS {
        piece((0, row), (0, row + 1));
    }
    builder.thing(1, 32.0, 224.0, 0);
    let mut map = builder.finish().expect("the tiles fit together");
    let runs_along = |x: f64| TURNED_COLUMNS.iter().any(|column| x == f64::from(column * TILE));
    for line in &mut map.lines {
        let (x1, x2) = (map.vertices[line.v1].x, map.vertices[line.v2].x);
        if let Some(back) = line.back
            && x1 == x2
            && runs_along(x1)
        {
            std::mem::swap(&mut line.v1, &mut line.v2);
            (line.front, line.back) = (back, Some(line.front));
        }
    }
    map
}
