//! The authored maps held against the facts of their worlds.

use super::{armament_burden, collateral_damage, precipice_plunge, volcanic_venture};
use hasard_engine::map::{Map, MapSource};
use hasard_engine::math::Fixed;

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
    let raised = (0..15 * 15).filter(|i| floor_at(&one, 32 + i % 15 * 64, 288 + i / 15 * 64) == 16).count();
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
    for (x, y, floor) in [(176, -336, 24), (224, -288, 32), (-96, 448, 32), (-224, -416, 24), (176, 560, 24)] {
        assert_eq!(floor_at(&map, x, y), floor, "crate at ({x}, {y})");
    }
    assert_eq!(floor_at(&map, 100, -500), 0);
    assert_eq!(map.sectors.len(), 4, "room, lamp patch, and crates of two heights");
}

#[test]
fn walls_of_tile_maps_are_in_pieces_of_a_tile() {
    for source in [armament_burden::map::source(1), armament_burden::map::source(2), precipice_plunge::map::source(31)] {
        let map = built(&source);
        let walls = map.lines.iter().filter(|line| line.back_sector.is_none());
        assert!(walls.into_iter().all(|wall| wall.dx.abs() + wall.dy.abs() == Fixed::from_int(64)));
    }
}
