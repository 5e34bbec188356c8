//! Reads the tiles of `[map]`: a drawing of letters, or how one is made anew at each reset.

use super::fields::{Fields, wholes};
use super::mistakes::{Mistakes, excerpt, unknown};
use super::model::{Generate, GenerateKind, TileKind, Tiles};
use super::tree::Node;

/// Most tiles a side: a map of them is built in a few milliseconds.
const MOST_TILES: usize = 64;

/// The largest coordinate that a map can have, map units; drawings begin at 0.
const FARTHEST: usize = 16_383;

/// The tiles of a drawing.
pub(super) fn drawn(
    text: &str,
    at: usize,
    side: i32,
    kinds: Vec<TileKind>,
    mistakes: &mut Mistakes,
) -> Option<Tiles> {
    let lines: Vec<Vec<char>> =
        text.lines().map(|line| line.trim_end().chars().collect()).collect();
    let first = lines.iter().position(|line: &Vec<char>| !line.is_empty());
    let last = lines.iter().rposition(|line| !line.is_empty());
    let (Some(first), Some(last)) = (first, last) else {
        mistakes
            .add(at, "the map is empty; draw it with # for rock, . for ground, @ for the start");
        return None;
    };
    let lines = &lines[first..=last];
    let (columns, rows) = (lines.iter().map(Vec::len).max().unwrap_or(0), lines.len());
    if columns > MOST_TILES || rows > MOST_TILES {
        mistakes.add(
            at,
            format!("the map has {columns} x {rows} tiles; at most {MOST_TILES} x {MOST_TILES}"),
        );
        return None;
    }
    let widest = columns.max(rows);
    if widest > FARTHEST / side as usize {
        mistakes.add(
            at,
            format!(
                "the map has {columns} x {rows} tiles of {side} map units; at most {} a side of that size, or a smaller `tile`",
                FARTHEST / side as usize
            ),
        );
        return None;
    }
    let rock = kinds.iter().position(|kind| kind.rock).unwrap_or(0) as u8;
    let mut tiles = vec![rock; columns * rows];
    for (row, line) in lines.iter().enumerate() {
        for (column, letter) in line.iter().enumerate() {
            match kinds.iter().position(|kind| kind.letter == *letter) {
                Some(kind) => tiles[(rows - 1 - row) * columns + column] = kind as u8,
                None => {
                    let known: Vec<String> =
                        kinds.iter().map(|kind| kind.letter.to_string()).collect();
                    let letter = excerpt(&letter.to_string());
                    let at = mistakes.within_drawing(at, first + row, column);
                    mistakes.add(
                        at,
                        format!("the legend has no letter `{letter}`, only {}", known.join(" ")),
                    );
                }
            }
        }
    }
    if tiles.iter().all(|tile| kinds[usize::from(*tile)].rock) {
        mistakes.add(at, "the map is all rock; draw ground with a full stop");
        return None;
    }
    Some(Tiles { side, columns, rows, tiles, kinds, generate: None })
}

/// The tiles of a map that is made anew at each reset.
pub(super) fn generated(
    node: &Node,
    side: i32,
    kinds: Vec<TileKind>,
    mistakes: &mut Mistakes,
) -> Option<Tiles> {
    let mut fields = Fields::of(node, "[map.generate]", mistakes);
    let kind = match fields.text("kind", mistakes) {
        Some(("maze", _)) => Some(GenerateKind::Maze),
        Some(("rooms", _)) => Some(GenerateKind::Rooms),
        Some(("columns", _)) => Some(GenerateKind::Columns),
        Some(("platforms", _)) => Some(GenerateKind::Platforms),
        Some((other, at)) => {
            mistakes
                .add(at, unknown("kind of map", other, ["maze", "rooms", "columns", "platforms"]));
            None
        }
        None => {
            mistakes.add(node.at, "[map.generate] needs a kind: maze, rooms, columns or platforms");
            None
        }
    };
    let columns = fields.whole("columns", 3, 31, mistakes).unwrap_or(13) as usize;
    let rows = fields.whole("rows", 3, 31, mistakes).unwrap_or(13) as usize;
    let share = (fields.number("share", 0.0, 0.9, mistakes).unwrap_or(0.3) * 1000.0) as u32;
    let loops = (fields.number("loops", 0.0, 1.0, mistakes).unwrap_or(0.0) * 1000.0) as u32;
    let train_seeds = fields.whole("train_seeds", 0, 1_000_000_000, mistakes).unwrap_or(0) as u32;
    let room = fields.whole("room", 2, 16, mistakes).unwrap_or(4) as u32;
    let heights = fields
        .node("heights")
        .and_then(|node| wholes::<2>(node, "heights", -512, 512, mistakes))
        .unwrap_or([0, 24]);
    if heights[0] > heights[1] {
        mistakes.add(node.at, "heights = [lowest, highest]: the lower one comes first");
    }
    if let Some(kind) = kind {
        warn_of_others(&fields, kind, mistakes);
    }
    fields.finish(mistakes);
    let kind = kind?;
    if kind == GenerateKind::Maze && (columns.is_multiple_of(2) || rows.is_multiple_of(2)) {
        mistakes.add(
            node.at,
            "a maze has an odd number of columns and of rows: corridors and walls by turns",
        );
    }
    let ground = kinds.iter().position(|kind| kind.letter == '.').unwrap_or(0) as u8;
    let heights = [heights[0], heights[1].max(heights[0])];
    Some(Tiles {
        side,
        columns,
        rows,
        tiles: vec![ground; columns * rows],
        kinds,
        generate: Some(Generate { kind, share, room, loops, heights, train_seeds }),
    })
}

/// Warns of fields that are for other kinds of maps.
fn warn_of_others(fields: &Fields<'_>, kind: GenerateKind, mistakes: &mut Mistakes) {
    use GenerateKind::{Columns, Maze, Platforms, Rooms};
    for (key, kinds, names) in [
        ("loops", &[Maze][..], "a maze"),
        ("room", &[Rooms], "rooms"),
        ("share", &[Columns, Platforms], "columns and platforms"),
        ("heights", &[Platforms], "platforms"),
    ] {
        if let Some(at) = fields.place_of(key).filter(|_| !kinds.contains(&kind)) {
            mistakes.warn(at, format!("`{key}` has no effect here: it is for {names}"));
        }
    }
}
