//! The built map held against its definition: brute force over the lines instead of tree and
//! blockmap.
//!
//! Long because each structure of a built map has its own brute-force twin.

use super::{
    Line, Map, MapBuilder, MapError, MapSource, Node, SectorId, SourceLine, SourceSector, Style,
    Subsector, Vertex,
};
use crate::math::{Fixed, Rng};

const ROOM: Style = Style {
    floor: 0,
    ceiling: 128,
    light: 200,
    floor_texture: "FLAT5",
    ceiling_texture: "FLAT5",
    wall: "STONE",
    step: "STEP",
    lintel: "STONE",
    special: 0,
    tag: 0,
};

/// Rooms, pillars and patches at random: convex and star-shaped, crossing each other at any angle.
fn random_source(seed: u64, shapes: i32) -> MapSource {
    let mut rng = Rng::new(seed);
    let mut builder = MapBuilder::new();
    builder.rectangle(ROOM, -700, -500, 900, 800);
    for shape in 0..shapes {
        let (x, y) = (rng.between(-800, 900), rng.between(-600, 800));
        let corners: Vec<(i32, i32)> = (0..rng.between(3, 9))
            .map(|corner| {
                let angle = crate::math::Angle((corner as u32).wrapping_mul(0x1c00_0000));
                let radius = rng.between(20, 260);
                (x + (angle.cos() * radius).floor(), y + (angle.sin() * radius).floor())
            })
            .collect();
        if rng.below(4) == 0 {
            builder.solid(&corners);
        } else {
            builder.polygon(Style { floor: 8 * shape, tag: rng.between(0, 3), ..ROOM }, &corners);
        }
    }
    builder.finish().expect("random shapes come together")
}

/// The sector around a point by counting the lines that a ray to the east crosses, or none in the
/// void; no answer closer than `margin` units to a line, where rounding may decide.
fn sector_by_rays(map: &Map, x: f64, y: f64, margin: f64) -> Option<Option<SectorId>> {
    let mut crossings = vec![0; map.sectors.len()];
    for line in &map.lines {
        let (x1, y1, x2, y2) =
            (line.v1.x.to_f64(), line.v1.y.to_f64(), line.v2.x.to_f64(), line.v2.y.to_f64());
        let along =
            ((x - x1) * (x2 - x1) + (y - y1) * (y2 - y1)) / ((x2 - x1).powi(2) + (y2 - y1).powi(2));
        let t = along.clamp(0.0, 1.0);
        if (x - x1 - t * (x2 - x1)).hypot(y - y1 - t * (y2 - y1)) < margin {
            return None;
        }
        if (y1 > y) != (y2 > y) && x1 + (y - y1) * (x2 - x1) / (y2 - y1) > x {
            crossings[line.front_sector.0 as usize] += 1;
            if let Some(back) = line.back_sector {
                crossings[back.0 as usize] += 1;
            }
        }
    }
    let inside: Vec<usize> = (0..crossings.len()).filter(|&s| crossings[s] % 2 == 1).collect();
    assert!(inside.len() <= 1, "({x}, {y}) is in sectors {inside:?}");
    Some(inside.first().map(|&s| SectorId(s as u32)))
}

#[test]
fn points_on_a_line_between_north_and_south_belong_to_the_south() {
    // The patch's northern and southern lines run opposite ways.
    let mut builder = MapBuilder::new();
    builder.rectangle(ROOM, -256, -256, 256, 256);
    builder.rectangle(Style { floor: 8, ..ROOM }, -64, -64, 64, 64);
    let map = Map::build(&builder.finish().unwrap(), "patch", &[]).unwrap();
    for x in -63..64 {
        let floor = |y| {
            map.sectors[map.sector_at(Fixed::from_int(x), Fixed::from_int(y)).0 as usize]
                .floor
                .floor()
        };
        assert_eq!([65, 64, 63, -63, -64, -65].map(floor), [0, 8, 8, 8, 0, 0], "at {x}");
    }
}

fn check_points(map: &Map, step: i32) -> usize {
    let mut checked = 0;
    for x in (-1100..1200).step_by(step as usize) {
        for y in (-900..1100).step_by(step as usize) {
            let (x, y) = (f64::from(x) + 0.37, f64::from(y) + 0.61);
            let Some(sector) = sector_by_rays(map, x, y, 0.05) else { continue };
            let (fixed_x, fixed_y) = (Fixed::from_f64(x), Fixed::from_f64(y));
            assert_eq!(
                map.is_inside(fixed_x, fixed_y),
                sector.is_some(),
                "at ({x}, {y}) of {}",
                map.name
            );
            if let Some(sector) = sector {
                assert_eq!(
                    map.sector_at(fixed_x, fixed_y),
                    sector,
                    "at ({x}, {y}) of {}",
                    map.name
                );
                checked += 1;
            }
        }
    }
    checked
}

/// Twice the area of the triangle over `a -> b` and `p`, in 2^-32 square units: positive on the
/// left.
fn cross(a: Vertex, b: Vertex, p: Vertex) -> i128 {
    let wide = |v: Fixed| i128::from(v.0);
    (wide(b.x) - wide(a.x)) * (wide(p.y) - wide(a.y))
        - (wide(p.x) - wide(a.x)) * (wide(b.y) - wide(a.y))
}

fn length(a: Vertex, b: Vertex) -> f64 {
    (b.x.to_f64() - a.x.to_f64()).hypot(b.y.to_f64() - a.y.to_f64())
}

/// How far `p` is to the left of the infinite line, map units.
fn left_of(line: &Line, p: Vertex) -> f64 {
    cross(line.v1, line.v2, p) as f64 / 65536.0 / 65536.0 / length(line.v1, line.v2)
}

fn check_tree(map: &Map) {
    let mut reached = vec![0; map.subsectors.len()];
    let mut stack: Vec<u32> = vec![match map.nodes.len() {
        0 => Node::SUBSECTOR,
        count => count as u32 - 1,
    }];
    while let Some(child) = stack.pop() {
        if child & Node::SUBSECTOR != 0 {
            reached[(child & !Node::SUBSECTOR) as usize] += 1;
        } else {
            stack.extend(map.nodes[child as usize].children);
        }
    }
    assert!(
        reached.iter().all(|&times| times == 1),
        "every subsector is reached once: {reached:?}"
    );

    let mut covered = vec![[0.0f64; 2]; map.lines.len()];
    for &Subsector { sector, first_seg, seg_count } in &map.subsectors {
        let segs = &map.segs[first_seg as usize..(first_seg + seg_count) as usize];
        assert!(!segs.is_empty());
        for seg in segs {
            let line = &map.lines[seg.line as usize];
            let back = seg.side != line.front;
            assert_eq!(seg.front_sector, sector, "a subsector is of one sector");
            assert_eq!(map.sides[seg.side.0 as usize].sector, sector);
            assert_eq!(
                seg.back_sector,
                if back { Some(line.front_sector) } else { line.back_sector }
            );
            let start = if back { line.v2 } else { line.v1 };
            assert!((seg.offset.to_f64() - length(start, seg.v1)).abs() < 0.001);
            covered[seg.line as usize][usize::from(back)] += length(seg.v1, seg.v2);
            // Convex: no seg reaches behind another's line.
            for other in segs {
                for v in [other.v1, other.v2] {
                    let left = left_of(line, v);
                    let behind = if back { -left } else { left };
                    assert!(
                        behind < 0.001,
                        "seg of line {} reaches {behind} behind line {}",
                        other.line,
                        seg.line
                    );
                }
            }
            // On its line, and the same way along.
            for v in [seg.v1, seg.v2] {
                assert!(left_of(line, v).abs() < 0.001);
            }
            let (from, to) = if back { (seg.v2, seg.v1) } else { (seg.v1, seg.v2) };
            assert!(length(line.v1, from) < length(line.v1, to));
        }
    }
    for (i, line) in map.lines.iter().enumerate() {
        let whole = length(line.v1, line.v2);
        assert!((covered[i][0] - whole).abs() < 0.01, "the front of line {i} is drawn whole");
        let back = if line.back.is_some() { whole } else { 0.0 };
        assert!((covered[i][1] - back).abs() < 0.01, "the back of line {i} is drawn whole");
    }
}

/// Every point of every line must be found in the block under it.
fn check_blockmap(map: &Map) {
    let blockmap = &map.blockmap;
    for (i, line) in map.lines.iter().enumerate() {
        let steps = (length(line.v1, line.v2) / 3.0).ceil() as i32;
        for step in 0..=steps {
            let x = line.v1.x + line.dx.scale(step, steps);
            let y = line.v1.y + line.dy.scale(step, steps);
            let block = blockmap.lines_in(blockmap.column_of(x), blockmap.row_of(y));
            assert!(
                block.contains(&(i as u32)),
                "line {i} is missing from the block of ({x}, {y})"
            );
        }
    }
    for row in 0..blockmap.rows {
        for column in 0..blockmap.columns {
            let block = blockmap.lines_in(column, row);
            assert!(block.is_sorted_by(|a, b| a < b), "a line is listed once a block");
            for &line in block {
                let bounds = map.lines[line as usize].bounds.map(Fixed::to_f64);
                let west = blockmap.origin_x.to_f64() + f64::from(column) * 128.0;
                let south = blockmap.origin_y.to_f64() + f64::from(row) * 128.0;
                assert!(
                    bounds[0] <= west + 128.0 && bounds[1] >= west,
                    "line {line} is far from its block"
                );
                assert!(
                    bounds[2] <= south + 128.0 && bounds[3] >= south,
                    "line {line} is far from its block"
                );
            }
        }
    }
}

#[test]
fn random_maps_are_built_right() {
    for seed in 0..12 {
        let source = random_source(seed, 3 + 4 * seed as i32);
        let map = Map::build(&source, &format!("seed {seed}"), &[]).expect("a closed map");
        check_tree(&map);
        check_blockmap(&map);
        assert!(check_points(&map, 13) > 5_000);
    }
}

#[test]
fn a_single_room_is_one_subsector() {
    let mut builder = MapBuilder::new();
    builder.rectangle(ROOM, 0, 0, 256, 128);
    let map = Map::build(&builder.finish().unwrap(), "room", &["LAVA1"]).unwrap();
    assert_eq!((map.lines.len(), map.subsectors.len(), map.nodes.len()), (4, 1, 0));
    assert_eq!(map.sectors[0].bounds.map(Fixed::floor), [0, 256, 0, 128]);
    assert_eq!(map.textures[map.texture("LAVA1").unwrap().0 as usize].as_str(), "LAVA1");
    assert_eq!(map.texture("ABSENT"), None);
    check_tree(&map);
}

/// Shade changes the light of what is under it and nothing else, and what is painted later covers
/// it.
#[test]
fn shade_keeps_what_it_falls_on() {
    let mut builder = MapBuilder::new();
    builder.rectangle(ROOM, 0, 0, 256, 256).rectangle(
        Style { floor: 16, tag: 5, ..ROOM },
        128,
        0,
        256,
        256,
    );
    builder
        .shade(96, &[(64, 64), (192, 64), (192, 192), (64, 192)])
        .shade(200, &[(0, 0), (32, 0), (32, 32)]);
    builder.rectangle(Style { floor: 24, ..ROOM }, 96, 96, 112, 112);
    let map = Map::build(&builder.finish().unwrap(), "shaded", &[]).unwrap();
    let at = |x, y| {
        let sector = &map.sectors[map.sector_at(Fixed::from_int(x), Fixed::from_int(y)).0 as usize];
        (sector.floor.floor(), sector.light, sector.tag)
    };
    assert_eq!(
        [at(10, 100), at(70, 70), at(150, 70), at(200, 70)],
        [(0, 200, 0), (0, 96, 0), (16, 96, 5), (16, 200, 5)]
    );
    assert_eq!(at(100, 100), (24, 200, 0));
    assert_eq!(map.sectors.len(), 5, "shade of the same light adds none");
    check_tree(&map);
}

#[test]
fn building_twice_gives_the_same() {
    let source = random_source(3, 30);
    let once = format!("{:?}", Map::build(&source, "m", &[]).unwrap());
    assert_eq!(once, format!("{:?}", Map::build(&source.clone(), "m", &[]).unwrap()));
}

#[test]
fn cuts_are_few_and_the_tree_is_shallow() {
    for seed in 0..6 {
        let map = Map::build(&random_source(seed, 40), "m", &[]).unwrap();
        let uncut: usize = map.lines.iter().map(|line| 1 + usize::from(line.back.is_some())).sum();
        let depth = depth_of(&map);
        let ideal = (map.subsectors.len() as f64).log2();
        assert!(map.segs.len() < uncut * 2, "{} segs from {uncut}", map.segs.len());
        assert!(
            f64::from(depth) < 2.5 * ideal,
            "depth {depth} for {} subsectors",
            map.subsectors.len()
        );
    }
}

fn depth_of(map: &Map) -> u32 {
    let mut deepest = 0;
    let mut stack = vec![(map.nodes.len() as u32 - 1, 1)];
    while let Some((child, depth)) = stack.pop() {
        deepest = deepest.max(depth);
        if child & Node::SUBSECTOR == 0 {
            stack.extend(map.nodes[child as usize].children.map(|child| (child, depth + 1)));
        }
    }
    deepest
}

/// A room, as a source that tests spoil.
fn square() -> MapSource {
    let mut builder = MapBuilder::new();
    builder.rectangle(ROOM, 0, 0, 256, 128).thing(1, 32.0, 32.0, 0);
    builder.finish().unwrap()
}

#[test]
fn faults_are_named() {
    let fault = |spoil: &dyn Fn(&mut MapSource)| {
        let mut source = square();
        spoil(&mut source);
        Map::build(&source, "spoiled", &[]).expect_err("a fault")
    };
    assert!(matches!(fault(&|m| m.lines.clear()), MapError::Missing { what: "linedefs" }));
    assert!(matches!(
        fault(&|m| m.lines[2].v2 = 9),
        MapError::Index { element: "linedef", index: 2, field: "v2", .. }
    ));
    assert!(matches!(
        fault(&|m| m.sides[1].sector = 7),
        MapError::Index { element: "sidedef", index: 1, .. }
    ));
    let dots = fault(&|m| m.lines.iter_mut().for_each(|line| line.v2 = line.v1));
    assert!(matches!(dots, MapError::Missing { what: "linedef with a length" }));
    assert!(matches!(fault(&|m| m.lines.truncate(3)), MapError::Unclosed { sector: 0, .. }));
    assert!(matches!(
        fault(&|m| m.vertices[0].x = f64::NAN),
        MapError::Range { element: "vertex", field: "x", .. }
    ));
    assert!(matches!(fault(&|m| m.vertices[0].y = -1e300), MapError::Range { .. }));
    assert!(matches!(
        fault(&|m| m.sectors[0].floor = i32::MIN),
        MapError::Range { field: "heightfloor", .. }
    ));
    assert!(matches!(fault(&|m| m.sides[0].offset_x = f64::INFINITY), MapError::Range { .. }));
    assert!(matches!(
        fault(&|m| m.things[0].x = 20_000.0),
        MapError::Range { element: "thing", .. }
    ));
    let crowd = fault(&|m| m.things = vec![m.things[0]; 70_000]);
    assert!(matches!(crowd, MapError::TooMany { what: "things", .. }));
}

/// What editors and packers leave behind, and other loaders take.
#[test]
fn untidy_maps_are_built_as_if_they_were_tidy() {
    let plain = Map::build(&square(), "plain", &[]).unwrap();
    let mut source = square();
    source.lines.iter_mut().for_each(|line| line.front = 0);
    let shared = Map::build(&source, "shared", &[]).unwrap();
    let fronts: std::collections::BTreeSet<u32> =
        shared.lines.iter().map(|line| line.front.0).collect();
    assert_eq!(fronts.len(), shared.lines.len(), "every line has a side of its own");
    assert!(
        shared
            .lines
            .iter()
            .all(|line| shared.sides[line.front.0 as usize].middle == plain.sides[0].middle)
    );
    check_tree(&shared);

    let mut source = square();
    source.lines.insert(2, SourceLine { v1: 1, v2: 1, front: 0, ..SourceLine::default() });
    source.sectors.push(SourceSector { tag: 9, ..source.sectors[0].clone() });
    source.sides.push(source.sides[0].clone());
    source.vertices.push(source.vertices[0]);
    let map = Map::build(&source, "left-overs", &[]).unwrap();
    assert_eq!((map.lines.len(), map.segs.len()), (plain.lines.len(), plain.segs.len()));
    assert_eq!(map.tagged(9).count(), 0, "a sector that no line faces has no place");
    assert!(map.sectors[1].lines.is_empty());
    check_tree(&map);
}

#[test]
fn searches_that_begin_at_a_cell_end_as_from_the_root() {
    for seed in 0..20 {
        let map = Map::build(&random_source(seed, 30), "random", &[]).unwrap();
        let root = map.nodes.len() as u32 - 1;
        let mut rng = Rng::new(seed);
        for round in 0..4000 {
            let (mut x, mut y) = (
                Fixed(rng.between(-1100 << 16, 1100 << 16)),
                Fixed(rng.between(-900 << 16, 1000 << 16)),
            );
            if round % 3 == 0 {
                // On a corner or a hair beside it.
                let vertex = &map.vertices[rng.below(map.vertices.len() as u32) as usize];
                (x, y) =
                    (vertex.x + Fixed(rng.between(-1, 1)), vertex.y + Fixed(rng.between(-1, 1)));
            }
            assert!(
                std::ptr::eq(map.subsector_at(x, y), map.subsector_below(root, x, y)),
                "map {seed} at {x:?}, {y:?}"
            );
        }
    }
}
