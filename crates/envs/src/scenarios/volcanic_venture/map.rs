//! The cavern of Volcanic Venture: 17 x 17 tiles, each its own sector, which the rules raise to
//! platforms or flood.

use crate::scenarios::volcanic_venture::tiles::TAGS;
use hasard_engine::map::{MapBuilder, MapSource, Style, TileGrid};

/// Side of a tile, map units.
pub const TILE: i32 = 128;
/// South-western corner of the cavern.
pub const ORIGIN: (i32, i32) = (0, 64);
/// Tiles a side.
pub const TILES: usize = 17;
/// Tag of the tile in the middle.
pub const CENTRE_TAG: i32 = 116;
/// Sector special of every tile: damage before the rules have set their own.
pub const LAVA_SPECIAL: i32 = 83;

/// The map of every level; all floors start level, as lava.
#[must_use]
pub fn source() -> MapSource {
    let mut builder = MapBuilder::new();
    let grid = TileGrid::new(ORIGIN, TILE, TILES, TILES, |column, row| Style {
        floor: 0,
        ceiling: 250,
        light: 210,
        floor_texture: "LAVA1",
        ceiling_texture: "FLAT5_5",
        wall: "A-BROK28",
        step: "AQF052",
        lintel: "A-BROK28",
        special: LAVA_SPECIAL,
        tag: TAGS[row][column],
    });
    grid.paint(&mut builder);
    builder.thing(1, 1088.0, 1152.0, 0);
    let mut map = builder.finish().expect("the tiles fit together");
    let tile = |at: f64, origin: i32| (at as i32 - origin) / TILE;
    map.turn_lines(|[(x1, y1), (x2, _)], _| {
        let (column, row) = (tile(x1, ORIGIN.0), tile(y1, ORIGIN.1));
        if x1 == x2 { runs_south(column, row) } else { runs_west(column, row) }
    });
    map
}

/// Whether the line at a tile's western edge runs from north to south; the others run from south to
/// north.
const fn runs_south(column: i32, row: i32) -> bool {
    match column {
        1..=8 => row < 9 || column % 2 == 0,
        9 => row < 9,
        _ => column % 2 == 1,
    }
}

/// Whether the line at a tile's southern edge runs from east to west; the others run from west to
/// east.
const fn runs_west(column: i32, row: i32) -> bool {
    row % 2 == 0 && (row > 9 || column >= 9)
}
