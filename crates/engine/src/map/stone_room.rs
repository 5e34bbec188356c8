//! A bare room for tests.

use super::{Map, MapBuilder, Style};
use std::sync::Arc;

/// A room of stone between two corners, 128 high, with players who look east.
pub(crate) fn stone_room(light: i32, [x0, y0, x1, y1]: [i32; 4], players: &[[f64; 2]]) -> Arc<Map> {
    let style = Style {
        floor: 0,
        ceiling: 128,
        light,
        floor_texture: "STONE5",
        ceiling_texture: "STONE5",
        wall: "STONE5",
        step: "STONE5",
        lintel: "STONE5",
        special: 0,
        tag: 0,
    };
    let mut builder = MapBuilder::new();
    builder.rectangle(style, x0, y0, x1, y1);
    for &[x, y] in players {
        builder.thing(1, x, y, 0);
    }
    Arc::new(Map::build(&builder.finish().unwrap(), "room", &[]).unwrap())
}
