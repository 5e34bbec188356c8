//! The arena of Armament Burden: a square hall of 15 x 15 tiles with a delivery strip along its
//! western wall.

use crate::scenarios::armament_burden::tiles;
use hasard_engine::map::{MapBuilder, MapSource, Mark, Style, TileGrid};

/// Side of a tile, map units.
pub const TILE: i32 = 64;
/// South-western corner of the hall.
pub const ORIGIN: (i32, i32) = (0, 256);
/// Tiles a side.
pub const TILES: usize = 15;
/// Weapons are delivered west of this line.
pub const DELIVERY_EAST: i32 = 128;

/// Solid decorations of levels 2 and 3: editor number, x, y. Columns are 40 high, pillars 128.
const DECOR: [(i32, f64, f64); 8] = [
    (33, 224.0, 352.0),
    (33, 224.0, 1120.0),
    (31, 224.0, 928.0),
    (31, 224.0, 544.0),
    (48, 864.0, 800.0),
    (48, 864.0, 672.0),
    (36, 608.0, 864.0),
    (36, 608.0, 608.0),
];

/// The map of a level, 1..=3. Level 1 has four low crates; levels 2 and 3 have obstacles of every
/// height, and in level 3 the tiles that may become acid pits carry tags.
#[must_use]
pub fn source(level: u8) -> MapSource {
    let (floors, textures) = if level == 1 {
        (&tiles::FLOOR_LEVEL_1, &tiles::TEXTURE_LEVEL_1)
    } else {
        (&tiles::FLOOR_LEVELS_2_3, &tiles::TEXTURE_LEVELS_2_3)
    };
    let grid = TileGrid::new(ORIGIN, TILE, TILES, TILES, |column, row| {
        let texture = tiles::TEXTURES[textures[row][column]];
        Style {
            floor: floors[row][column],
            ceiling: 150,
            light: 210,
            floor_texture: texture,
            ceiling_texture: "SLIME16",
            wall: "AQRUST07",
            step: if texture == "CRATOP2" { "LITEYEL3" } else { "LITEBLU4" },
            lintel: "AQRUST07",
            special: 0,
            tag: if level == 3 { tiles::PIT_TAGS[row][column] } else { 0 },
        }
    });
    let mut builder = MapBuilder::new();
    grid.paint_apart(&mut builder);
    let wall = |texture| Mark { wall: Some(texture), ..Mark::default() };
    let at = |column, row| grid.corner(column, row);
    // A stretch of wall for each tile, as in the original: how a body in the air stops at a wall
    // depends on its length.
    for i in 0..TILES {
        // Steel ribs between the computers.
        let east = if matches!(i, 2 | 5 | 9 | 12) { "METAL5" } else { "COMPUTE2" };
        builder.mark(wall("BSTONE3"), &[at(0, i), at(0, i + 1)]);
        builder.mark(wall(east), &[at(TILES, i), at(TILES, i + 1)]);
        builder.mark(wall("AQRUST07"), &[at(i, 0), at(i + 1, 0)]);
        builder.mark(wall("AQRUST07"), &[at(i, TILES), at(i + 1, TILES)]);
    }
    builder.thing(1, 32.0, 736.0, 0);
    if level != 1 {
        for (kind, x, y) in DECOR {
            builder.thing(kind, x, y, 0);
        }
    }
    let mut map = builder.finish().expect("the tiles fit together");
    // From north to south and from west to east.
    map.turn_lines(|[(x1, _), (x2, _)], _| x1 == x2);
    map
}
