//! Maps of tiles: the map that they make, and what of it the rules must know.

use super::generate::Layout;
use super::model::{Plan, TileKind, Tiles};
use super::program::{FIRST_TAG, LooseTile, Program};
use crate::EnvError;
use hasard_engine::map::{Map, MapBuilder, MapSource, Mark, SourceThing, Style};
use hasard_engine::math::Fixed;

impl Tiles {
    /// The kind of a tile; rock beyond the edge.
    pub fn at(&self, column: usize, row: usize) -> Option<&TileKind> {
        let within = column < self.columns && row < self.rows;
        let kind =
            within.then(|| &self.kinds[usize::from(self.tiles[row * self.columns + column])])?;
        (!kind.rock).then_some(kind)
    }

    /// West, south, east, north of a tile.
    fn area(&self, column: usize, row: usize) -> [i32; 4] {
        let (west, south) = (column as i32 * self.side, row as i32 * self.side);
        [west, south, west + self.side, south + self.side]
    }

    /// Whether any ground is within west, south, east, north.
    pub fn has_ground_in(&self, [west, south, east, north]: [i32; 4]) -> bool {
        self.ground().any(|(column, row, _)| {
            let [left, lower, right, upper] = self.area(column, row);
            west < right && left < east && south < upper && lower < north
        })
    }

    /// Every tile that is no rock, from the south-west.
    fn ground(&self) -> impl Iterator<Item = (usize, usize, &TileKind)> {
        let all = (0..self.rows).flat_map(|row| (0..self.columns).map(move |column| (column, row)));
        all.filter_map(|(column, row)| Some((column, row, self.at(column, row)?)))
    }
}

/// The tag of a kind of tile.
fn tag(index: usize) -> i32 {
    FIRST_TAG + index as i32
}

/// Whether the tiles of a kind must have a tag for the rules.
fn needs_tag(kind: &TileKind) -> bool {
    let moves = kind.floor[0] != kind.floor[1] || kind.waggle.is_some() || kind.damage.is_some();
    moves || kind.zone.is_some()
}

/// The map of a plan.
pub(super) fn source(plan: &Plan, tiles: &Tiles) -> Result<MapSource, EnvError> {
    let mut builder = MapBuilder::new();
    let wall = tiles
        .kinds
        .iter()
        .find(|kind| kind.letter == '#')
        .and_then(|kind| kind.wall)
        .unwrap_or("BIGSTON3");
    let style = |index: usize, kind: &TileKind| Style {
        floor: kind.floor[0],
        ceiling: kind.ceiling,
        light: kind.light,
        floor_texture: kind.floor_texture,
        ceiling_texture: kind.ceiling_texture,
        wall: kind.wall.filter(|_| !kind.rock).unwrap_or(wall),
        step: kind.step,
        lintel: kind.step,
        special: 0,
        tag: if needs_tag(kind) || tiles.generate.is_some() { tag(index) } else { 0 },
    };
    for row in 0..tiles.rows {
        let mut column = 0;
        while column < tiles.columns {
            let Some(kind) = tiles.at(column, row) else {
                column += 1;
                continue;
            };
            let index = usize::from(tiles.tiles[row * tiles.columns + column]);
            // Equal tiles in a row are one piece, unless each moves by itself.
            let alone = kind.floor[0] != kind.floor[1] || tiles.generate.is_some();
            let from = column;
            column += 1;
            while !alone
                && column < tiles.columns
                && usize::from(tiles.tiles[row * tiles.columns + column]) == index
            {
                column += 1;
            }
            let ([west, south, ..], [.., east, north]) =
                (tiles.area(from, row), tiles.area(column - 1, row));
            builder.rectangle(style(index, kind), west, south, east, north);
        }
    }
    mark_walls(tiles, wall, &mut builder);
    let start = tiles.ground().find(|(.., kind)| kind.start).or_else(|| tiles.ground().next());
    for (column, row, kind) in tiles.ground() {
        let [west, south, east, north] = tiles.area(column, row);
        let (x, y) = (f64::from(west + east) / 2.0, f64::from(south + north) / 2.0);
        if start.is_some_and(|(first, of, _)| (first, of) == (column, row)) {
            builder.thing(1, x, y, kind.start_angle);
        }
        if let Some(thing) = kind.thing {
            builder.thing_with(SourceThing {
                x,
                y,
                kind: thing.info().editor_number,
                ..SourceThing::default()
            });
        }
    }
    builder.finish().map_err(|error| EnvError::Map {
        why: format!("{}: the map cannot be built: {error}", plan.name),
    })
}

/// Rock that looks otherwise than the usual: its sides are marked.
fn mark_walls(tiles: &Tiles, usual: &'static str, builder: &mut MapBuilder) {
    let texture = |column: usize, row: usize| -> Option<&'static str> {
        let within = column < tiles.columns && row < tiles.rows;
        let kind =
            within.then(|| &tiles.kinds[usize::from(tiles.tiles[row * tiles.columns + column])])?;
        kind.wall.filter(|wall| kind.rock && *wall != usual)
    };
    for (column, row, _) in tiles.ground() {
        let [west, south, east, north] = tiles.area(column, row);
        let sides = [
            (column.wrapping_sub(1), row, [(west, south), (west, north)]),
            (column + 1, row, [(east, south), (east, north)]),
            (column, row.wrapping_sub(1), [(west, south), (east, south)]),
            (column, row + 1, [(west, north), (east, north)]),
        ];
        for (column, row, path) in sides {
            if let Some(wall) = texture(column, row) {
                builder.mark(Mark { wall: Some(wall), ..Mark::default() }, &path);
            }
        }
    }
}

impl Program {
    /// What the rules must know of a map of tiles.
    pub(super) fn place_tiles(&mut self, tiles: &Tiles, map: &Map) {
        let sector = |[west, south, east, north]: [i32; 4]| {
            map.sector_at(Fixed::from_int((west + east) / 2), Fixed::from_int((south + north) / 2))
        };
        let mut order = Vec::new();
        for (column, row, kind) in tiles.ground() {
            let area = tiles.area(column, row);
            let own = sector(area);
            order.push(own);
            if let Some(zone) = kind.zone {
                self.zones_of[own.0 as usize] |= 1 << zone;
                self.areas[usize::from(zone)].push(area);
            }
            if kind.damage.is_none() {
                self.free.push(area);
            }
            if kind.start {
                self.starts.push((area, kind.start_angle));
            }
            if kind.floor[0] != kind.floor[1] {
                self.loose.push(LooseTile { sector: own, floor: kind.floor });
            }
        }
        for (index, kind) in tiles.kinds.iter().enumerate() {
            if !tiles.tiles.iter().any(|tile| usize::from(*tile) == index) {
                continue;
            }
            if let Some(zone) = kind.zone {
                self.tags[usize::from(zone)].push(tag(index));
            }
            if let Some([height, period]) = kind.waggle {
                self.waggles.push((tag(index), height * 8, 4096 / period.max(1)));
            }
            if let Some(damage) = kind.damage {
                self.damages.push((tag(index), damage));
            }
        }
        if let Some(generate) = tiles.generate {
            let kind =
                tiles.ground().next().map_or([0, 128], |(.., kind)| [kind.floor[0], kind.ceiling]);
            self.layout = Some(Layout::new(generate, tiles.columns, tiles.rows, kind, order));
        }
    }
}
