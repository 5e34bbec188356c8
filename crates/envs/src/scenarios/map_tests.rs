//! The authored maps held against the facts of their worlds.

use crate::registry::facts::map_source;
use crate::registry::scenario::EnvId;
use crate::scenarios::common::rule_set::RuleSet;
use crate::scenarios::{
    armament_burden, collateral_damage, detonators_dilemma, precipice_plunge, remedy_rush,
    volcanic_venture,
};
use hasard_engine::assets::Assets;
use hasard_engine::map::{Map, MapSource, TextureName};
use hasard_engine::math::{Angle, Fixed, Rng};
use hasard_engine::world::{ActorKind, World};
use std::sync::Arc;

fn built(source: &MapSource) -> Map {
    Map::build(source, "authored", &[]).expect("an authored map builds")
}

fn floor_at(map: &Map, x: i32, y: i32) -> i32 {
    map.sectors[map.sector_at(Fixed::from_int(x), Fixed::from_int(y)).0 as usize].floor.floor()
}

fn tag_at(map: &Map, x: i32, y: i32) -> i32 {
    map.sectors[map.sector_at(Fixed::from_int(x), Fixed::from_int(y)).0 as usize].tag
}

#[test]
fn armament_burden_has_its_obstacles() {
    let [one, two, three] = [1, 2, 3].map(|level| built(&armament_burden::map::source(level)));
    assert_eq!((one.things.len(), two.things.len(), three.things.len()), (1, 9, 9));
    // The four crates of level 1 are 2 x 2 tiles, 16 high.
    let raised =
        (0..15 * 15).filter(|i| floor_at(&one, 32 + i % 15 * 64, 288 + i / 15 * 64) == 16).count();
    assert_eq!(raised, 16);
    assert_eq!(floor_at(&one, 5 * 64, 256 + 3 * 64), 16);
    for map in [&two, &three] {
        assert_eq!(floor_at(map, 8 * 64 + 32, 256 + 32), 48);
        assert_eq!(floor_at(map, 10 * 64 + 32, 256 + 64 + 32), -16);
    }
    // Each tag of level 3 moves exactly its own tiles.
    assert_eq!(tag_at(&three, 2 * 64 + 1, 1215), 401);
    assert_eq!(tag_at(&three, 14 * 64 + 63, 257), 526);
    assert_eq!(three.tagged(511).count(), 2);
    assert!((401..=526).all(|tag| three.tagged(tag).count() >= 1));
    assert!(two.tags.is_empty());
}

#[test]
fn volcanic_venture_has_one_sector_a_tile() {
    let map = built(&volcanic_venture::map::source());
    assert_eq!(map.sectors.len(), 289);
    assert!((100..=388).all(|tag| map.tagged(tag).count() == 1));
    assert_eq!(tag_at(&map, 1088, 1152), volcanic_venture::map::CENTRE_TAG);
    assert_eq!((tag_at(&map, 1, 65), tag_at(&map, 2175, 2239)), (101, 187));
    assert!(map.sectors.iter().all(|sector| sector.special == 83));
}

#[test]
fn precipice_plunge_has_its_tags() {
    let map = built(&precipice_plunge::map::source(31));
    assert_eq!(map.sectors.len(), 1 + 56 * 7);
    assert_eq!((tag_at(&map, 127, 224), tag_at(&map, 129, 1)), (0, 128));
    assert_eq!(tag_at(&map, 3711, 447), 128 + 55 * 7 + 6);
    assert!((128..128 + 56 * 7).all(|tag| map.tagged(tag).count() == 1));
}

#[test]
fn collateral_damage_has_its_crates() {
    let map = built(&collateral_damage::map::source(-256));
    assert_eq!(map.things[0].x, Fixed::from_int(-256));
    for (x, y, floor) in
        [(176, -336, 24), (224, -288, 32), (-96, 448, 32), (-224, -416, 24), (176, 560, 24)]
    {
        assert_eq!(floor_at(&map, x, y), floor, "crate at ({x}, {y})");
    }
    assert_eq!(floor_at(&map, 100, -500), 0);
    assert_eq!(map.sectors.len(), 4, "room, lamp patch, and crates of two heights");
}

/// Step of the survey of what can be reached, map units.
const STEP: i32 = 16;
/// What a player gains by a jump and a step: 36 + 24.
const JUMP: i32 = 60;

/// Where a player's centre can be, surveyed over a box from a start; trees and other decoration
/// left out.
struct Reach {
    west: i32,
    south: i32,
    columns: i32,
    cells: Vec<bool>,
}

impl Reach {
    fn survey(
        source: &MapSource,
        [west, south, east, north]: [i32; 4],
        start: (i32, i32),
    ) -> Reach {
        let bare = MapSource { things: Vec::new(), ..source.clone() };
        let mut world = World::new(Arc::new(built(&bare)), 1);
        let player =
            world.add_player(Fixed::from_int(start.0), Fixed::from_int(start.1), Angle::EAST);
        let slot = usize::from(world.players[player].actor.slot);
        let (columns, rows) = ((east - west) / STEP + 1, (north - south) / STEP + 1);
        let floors: Vec<Option<i32>> = (0..columns * rows)
            .map(|i| {
                let (x, y) = (
                    Fixed::from_int(west + i % columns * STEP),
                    Fixed::from_int(south + i / columns * STEP),
                );
                let position = world.check_position(slot, x, y);
                (world.map.is_inside(x, y) && position.free).then(|| position.floor_z.floor())
            })
            .collect();
        let mut cells = vec![false; floors.len()];
        let mut open = vec![(start.0 - west) / STEP + (start.1 - south) / STEP * columns];
        while let Some(cell) = open.pop() {
            if std::mem::replace(&mut cells[cell as usize], true) {
                continue;
            }
            let height = floors[cell as usize].expect("only free cells are opened");
            let (column, row) = (cell % columns, cell / columns);
            for (dx, dy) in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
                let (column, row) = (column + dx, row + dy);
                if (0..columns).contains(&column) && (0..rows).contains(&row) {
                    let next = column + row * columns;
                    if floors[next as usize].is_some_and(|floor| floor - height <= JUMP) {
                        open.push(next);
                    }
                }
            }
        }
        Reach { west, south, columns, cells }
    }

    /// Square map units.
    fn area(&self) -> f64 {
        self.cells.iter().filter(|&&reached| reached).count() as f64 * f64::from(STEP * STEP)
    }

    /// Whether some reached cell is within `distance` of a point.
    fn comes_near(&self, x: i32, y: i32, distance: i32) -> bool {
        self.cells.iter().enumerate().any(|(i, &reached)| {
            let (column, row) = (i as i32 % self.columns, i as i32 / self.columns);
            let (dx, dy) = (self.west + column * STEP - x, self.south + row * STEP - y);
            reached && dx.abs() < distance && dy.abs() < distance
        })
    }
}

fn assert_near(what: &str, found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{what}: {found} instead of {expected} +- {tolerance}"
    );
}

#[test]
fn remedy_rush_has_its_yard() {
    let source = remedy_rush::map::source();
    // 2,383,808 square units in the survey of the whole, where it is cut off at -900.
    let reach = Reach::survey(&source, [-900, -900, 1140, 1290], (224, 20));
    assert_near("reachable area", reach.area(), 2.384e6, 0.12e6);

    // Of the box that items are thrown into, 83 % takes them: 71 % within reach, 10 % behind the
    // fences, 3 % inside rock.
    let map = Arc::new(built(&source));
    let mut world = World::new(Arc::clone(&map), 1);
    let mut rng = Rng::new(7);
    let (mut thrown, mut lain, mut lost, mut buried) = (0, 0, 0, 0);
    while thrown < 4000 {
        let (x, y) = (rng.between(-608, 1056), rng.between(-224, 1312));
        thrown += 1;
        let z = Fixed::from_int(20);
        if let Some(id) = world.spawn_checked(
            ActorKind::HealthBonus,
            Fixed::from_int(x),
            Fixed::from_int(y),
            z,
            0,
        ) {
            world.remove(id);
            lain += 1;
            let inside = map.is_inside(Fixed::from_int(x), Fixed::from_int(y));
            buried += i32::from(!inside);
            lost += i32::from(inside && !reach.comes_near(x, y, 36));
        }
    }
    let share = |count: i32| f64::from(count) / f64::from(thrown);
    assert_near("share of the box that takes items", share(lain), 0.83, 0.03);
    assert_near("share of the box within reach", share(lain - lost - buried), 0.705, 0.03);
    assert_near("share of the box inside rock", share(buried), 0.027, 0.015);
    for (x, y) in [(-320, 130), (350, 1000), (0, 500), (224, 24)] {
        assert!(reach.comes_near(x, y, 24), "({x}, {y}) is in the agent's box");
    }
    assert!(remedy_rush::map::STROBE_TAGS.clone().any(|tag| map.tagged(tag).next().is_some()));
    let yard = &map.sectors[map.sector_at(Fixed::from_int(0), Fixed::from_int(500)).0 as usize];
    assert!(remedy_rush::map::STROBE_TAGS.contains(&yard.tag));
    assert_eq!((yard.floor.floor(), yard.ceiling.floor(), yard.light), (0, 160, 240));
}

#[test]
fn detonators_dilemma_has_its_cave() {
    let source = detonators_dilemma::map::source(2);
    // 4,452,320 square units in the survey of hall and courts.
    let reach = Reach::survey(&source, [-1300, -1760, 2100, 960], (1812, -976));
    assert_near("reachable area", reach.area(), 4.452e6, 0.2e6);

    // Heights at which things came to rest in the recordings.
    let map = built(&source);
    for (x, y, floor) in [
        (1300, -500, 224),
        (1380, -590, 232),
        (1380, -655, 240),
        (1310, -730, 248),
        (300, -900, 256),
        (1900, -480, 256),
        (700, -560, 272),
        (-100, -820, 272),
        (-100, -750, 280),
        (-100, -350, 288),
        (-600, -1000, 304),
        (-600, -350, 288),
        (1824, -992, 264),
        (-1052, -1132, 416),
        (750, -200, 336),
    ] {
        assert_eq!(floor_at(&map, x, y), floor, "floor at ({x}, {y})");
    }
    for (level, copies) in [(1, 2), (2, 1), (3, 1)] {
        let source = detonators_dilemma::map::source(level);
        let points =
            |id| source.things.iter().filter(|thing| thing.kind == 9024 && thing.id == id).count();
        assert_eq!((11..=17).map(points).collect::<Vec<_>>(), [1, 1, 1, 1, 1, copies, 1]);
        assert_eq!(source.things.iter().filter(|thing| thing.kind == 2035).count(), 2);
    }
}

/// Every authored map: each piece of the tree is of one sector, and the text form builds the same
/// map.
#[test]
fn authored_maps_are_sound() {
    for (name, source) in [
        ("armament burden 1", armament_burden::map::source(1)),
        ("armament burden 2", armament_burden::map::source(2)),
        ("armament burden 3", armament_burden::map::source(3)),
        ("collateral damage", collateral_damage::map::source(-400)),
        ("detonator's dilemma", detonators_dilemma::map::source(1)),
        ("precipice plunge", precipice_plunge::map::source(31)),
        ("remedy rush", remedy_rush::map::source()),
        ("volcanic venture", volcanic_venture::map::source()),
    ] {
        let map = built(&source);
        for subsector in &map.subsectors {
            let segs = &map.segs[subsector.first_seg as usize..][..subsector.seg_count as usize];
            assert!(segs.iter().all(|seg| seg.front_sector == subsector.sector), "{name}");
        }
        let uncut: usize = map.lines.iter().map(|line| 1 + usize::from(line.back.is_some())).sum();
        assert!(map.segs.len() < uncut * 3 / 2, "{name}: {} segs from {uncut}", map.segs.len());
        let text = hasard_engine::map::udmf::write(&source);
        let again = hasard_engine::map::udmf::read(text.as_bytes()).expect("our own text");
        assert_eq!(again, source, "{name}");
        // Every thing stands in the world and is something.
        for thing in &map.things {
            assert!(
                map.is_inside(thing.x, thing.y),
                "{name}: thing {} at ({}, {})",
                thing.kind,
                thing.x,
                thing.y
            );
            assert!(
                ActorKind::from_editor_number(thing.kind).is_some(),
                "{name}: thing {}",
                thing.kind
            );
        }
    }
}

#[test]
fn walls_of_tile_maps_are_in_pieces_of_a_tile() {
    for source in [
        armament_burden::map::source(1),
        armament_burden::map::source(2),
        precipice_plunge::map::source(31),
    ] {
        let map = built(&source);
        let walls = map.lines.iter().filter(|line| line.back_sector.is_none());
        assert!(walls.into_iter().all(|wall| wall.dx.abs() + wall.dy.abs() == Fixed::from_int(64)));
    }
}

#[test]
fn every_texture_that_a_map_or_its_rules_name_is_painted() {
    let assets = Assets::embedded();
    assert!(assets.graphics.contains_key(&TextureName::new("RSKY1")), "the sky is no texture");
    for id in EnvId::all() {
        for (rules, hard) in [
            (RuleSet::Paper, false),
            (RuleSet::Paper, true),
            (RuleSet::Released, false),
            (RuleSet::Released, true),
        ] {
            let (source, beyond) = map_source(id, rules, hard);
            let walls = source.sides.iter().flat_map(|side| [side.top, side.middle, side.bottom]);
            let flats = source
                .sectors
                .iter()
                .flat_map(|sector| [sector.floor_texture, sector.ceiling_texture]);
            let mut lacking: Vec<TextureName> = walls
                .chain(flats)
                .chain(beyond.iter().map(|name| TextureName::new(name)))
                .filter(|name| {
                    name.is_some()
                        && *name != TextureName::new("F_SKY1")
                        && !assets.textures.contains_key(name)
                })
                .collect();
            lacking.sort_unstable();
            lacking.dedup();
            assert!(lacking.is_empty(), "{id} {rules:?} hard {hard}: nobody painted {lacking:?}");
        }
    }
}

#[test]
fn every_wall_that_can_be_seen_has_a_texture() {
    let sky = TextureName::new("F_SKY1");
    for id in EnvId::all() {
        let (source, _) = map_source(id, RuleSet::Paper, false);
        for line in &source.lines {
            let front = &source.sides[line.front];
            let Some(back) = line.back.map(|back| &source.sides[back]) else {
                assert!(
                    front.middle.is_some(),
                    "{id}: a bare wall from {:?}",
                    source.vertices[line.v1]
                );
                continue;
            };
            for (side, beyond) in [(front, back), (back, front)] {
                let (near, far) = (&source.sectors[side.sector], &source.sectors[beyond.sector]);
                let at = source.vertices[line.v1];
                assert!(
                    near.floor >= far.floor || side.bottom.is_some(),
                    "{id}: a bare step from {at:?}"
                );
                let open_sky = near.ceiling_texture == sky && far.ceiling_texture == sky;
                assert!(
                    near.ceiling <= far.ceiling || open_sky || side.top.is_some(),
                    "{id}: a bare lintel from {at:?}"
                );
            }
        }
    }
}
