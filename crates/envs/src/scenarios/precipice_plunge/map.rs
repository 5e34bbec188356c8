//! The shaft of Precipice Plunge: a corridor of 58 x 7 tiles that the rules lower into a descending
//! cave.

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

/// Whether the lines at a column's western edge run from north to south; those of all other columns
/// run from south to north.
const fn runs_south(column: usize) -> bool {
    matches!(column, 11 | 13 | 15 | 17 | 55 | 57)
        || (column >= 18 && column <= 54 && column.is_multiple_of(2))
}

/// The row whose southern lines run from east to west; those of all other rows run from west to
/// east.
const WESTWARD_ROW: usize = 5;

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
    // Every tile has lines of its own, on the platform too, and its outer walls are in pieces of a
    // tile.
    grid.paint_apart(&mut builder);
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
    let tile = |at: f64| at as usize / TILE as usize;
    map.turn_lines(
        |[(x1, y1), (x2, _)], _| {
            if x1 == x2 { runs_south(tile(x1)) } else { tile(y1) == WESTWARD_ROW }
        },
    );
    // The western wall comes last: of two walls that a body wedged in a corner meets at once, it
    // slides along the earlier.
    let west = |vertex: usize| map.vertices[vertex].x == 0.0;
    map.lines.sort_by_key(|line| west(line.v1) && west(line.v2));
    map
}
