//! Hostile maps: none may panic, hang or take memory without bound.

use super::{
    Map, MapBuilder, MapError, MapSource, SourceLine, SourceSide, SourceVertex, Style, udmf,
};
use crate::math::{Fixed, Rng};
use crate::mutation::{iterations, mutated};
use crate::wad::{self, Wad};
use std::time::{Duration, Instant};

const STYLE: Style = Style {
    floor: 0,
    ceiling: 128,
    light: 200,
    floor_texture: "FLAT5",
    ceiling_texture: "F_SKY1",
    wall: "STONE",
    step: "STEP",
    lintel: "STONE",
    special: 0,
    tag: 0,
};

/// A small map with everything that the format has.
fn sample() -> MapSource {
    let mut builder = MapBuilder::new();
    builder.rectangle(STYLE, 0, 0, 512, 384);
    builder.polygon(Style { floor: 24, tag: 7, ..STYLE }, &[(64, 64), (200, 90), (120, 220)]);
    builder.solid(&[(300, 300), (340, 300), (340, 340), (300, 340)]);
    builder.mark(
        super::Mark { middle: Some("BARS"), blocking: true, ..Default::default() },
        &[(256, 0), (256, 384)],
    );
    builder.thing(1, 32.5, 32.0, 90).thing(2014, 400.0, 200.0, 0);
    builder.finish().unwrap()
}

/// Uses a map in the ways that could trip over its numbers.
fn probe(map: &Map) {
    for i in 0..64 {
        let (x, y) = (Fixed::from_int(i * 37 % 700 - 50), Fixed::from_int(i * 61 % 500 - 50));
        let block = map.blockmap.lines_in(map.blockmap.column_of(x), map.blockmap.row_of(y));
        std::hint::black_box((map.sector_at(x, y), map.is_inside(x, y), block));
    }
}

#[test]
fn mutated_udmf_never_panics() {
    let text = udmf::write(&sample());
    let mut rng = Rng::new(0xF0);
    let (mut read, mut built) = (0, 0);
    for _ in 0..iterations(3_000) {
        let bytes = mutated(&mut rng, text.as_bytes());
        let Ok(source) = udmf::read(&bytes) else { continue };
        read += 1;
        if let Ok(map) = Map::build(&source, "mutated", &[]) {
            built += 1;
            probe(&map);
        }
        let again = udmf::write(&source);
        assert_eq!(udmf::read(again.as_bytes()).map(|source| udmf::write(&source)), Ok(again));
    }
    assert!(
        read > 50 && built > 20,
        "the mutations must not all be caught at once: {read} read, {built} built"
    );
}

#[test]
fn mutated_wads_never_panic() {
    let bytes = wad::write_map("MAP01", &sample());
    let mut rng = Rng::new(0xF1);
    let mut read = 0;
    for _ in 0..iterations(3_000) {
        let bytes = mutated(&mut rng, &bytes);
        if let Ok(wad) = Wad::read(&bytes) {
            read += 1;
            assert!(wad.lumps.iter().all(|lump| lump.bytes.len() <= bytes.len()));
            let _either_way = wad.map_text("MAP01").map(udmf::read);
        }
    }
    assert!(read > 50);
}

/// The samples in `attacks/`, each of which once broke a limit or tries to.
#[test]
fn attacks_are_turned_away() {
    let mut names: Vec<_> =
        std::fs::read_dir("attacks").unwrap().map(|entry| entry.unwrap().path()).collect();
    names.sort();
    assert!(names.len() >= 8);
    for path in names {
        let bytes = std::fs::read(&path).unwrap();
        let started = Instant::now();
        let is_text = path.extension().is_some_and(|extension| extension == "udmf");
        let accepted = if is_text {
            udmf::read(&bytes).is_ok_and(|source| Map::build(&source, "attack", &[]).is_ok())
        } else {
            let map = Wad::read(&bytes).is_ok_and(|wad| wad.map_text("MAP01").is_ok());
            map || crate::assets::Assets::from_iwad(&bytes).is_ok()
        };
        assert!(!accepted, "{} is let in", path.display());
        assert!(
            started.elapsed() < Duration::from_secs(5),
            "{} took {:?}",
            path.display(),
            started.elapsed()
        );
    }
}

/// A closed outline through the points, rock outside.
fn outline(points: impl Iterator<Item = (f64, f64)>) -> MapSource {
    let mut source = MapSource { sectors: sample().sectors[..1].to_vec(), ..MapSource::default() };
    source.vertices = points.map(|(x, y)| SourceVertex { x, y }).collect();
    let count = source.vertices.len();
    for i in 0..count {
        source.sides.push(SourceSide::default());
        source.lines.push(SourceLine {
            v1: i,
            v2: (i + 1) % count,
            front: i,
            ..SourceLine::default()
        });
    }
    source
}

/// A convex, clockwise ring of four parabolas: exact where a circle from the table of sines would
/// have dents.
fn circle(count: usize) -> impl Iterator<Item = (f64, f64)> {
    (0..count).map(move |i| {
        let t = 4.0 * i as f64 / count as f64;
        let (u, v) = (t.fract(), t.fract() * (1.0 - t.fract()));
        match t as u32 {
            0 => (16e3 * u - 8e3, 8e3 + 6400.0 * v),
            1 => (8e3 + 6400.0 * v, 8e3 - 16e3 * u),
            2 => (8e3 - 16e3 * u, -8e3 - 6400.0 * v),
            _ => (-8e3 - 6400.0 * v, 16e3 * u - 8e3),
        }
    })
}

fn assert_quick(name: &str, source: &MapSource) -> Result<Map, MapError> {
    let started = Instant::now();
    let result = Map::build(source, name, &[]);
    assert!(started.elapsed() < Duration::from_secs(20), "{name} took {:?}", started.elapsed());
    result
}

#[test]
fn maps_made_to_be_slow_are_built_or_refused_in_time() {
    // Convex: one leaf that every wall must prove. Seen from outside: a tree as deep as there are
    // walls.
    let room = assert_quick("round room", &outline(circle(30_000)));
    assert!(
        matches!(room, Err(MapError::TooComplex { .. })),
        "a map of 30,000 walls in one leaf was built"
    );
    let small = assert_quick("small round room", &outline(circle(400)))
        .unwrap_or_else(|error| panic!("small round room: {error}"));
    assert_eq!(small.subsectors.len(), 1);

    let mut pillar =
        outline([(-15e3, -15e3), (-15e3, 15e3), (15e3, 15e3), (15e3, -15e3)].into_iter());
    let inside: Vec<(f64, f64)> = circle(20_000).collect();
    let base = pillar.vertices.len();
    pillar.vertices.extend(inside.iter().map(|&(x, y)| SourceVertex { x, y }));
    for i in 0..inside.len() {
        let front = pillar.sides.len();
        pillar.sides.push(SourceSide::default());
        let (v1, v2) = (base + (i + 1) % inside.len(), base + i);
        pillar.lines.push(SourceLine { v1, v2, front, ..SourceLine::default() });
    }
    let _either_way = assert_quick("round pillar", &pillar);

    // Spikes across the world: every line crosses hundreds of blocks and every other.
    let spikes = (0..20_000).map(|i| {
        let along = f64::from(i) * 1.5 - 15e3;
        if i % 2 == 0 { (along, -16e3) } else { (-along, 16e3) }
    });
    let _either_way = assert_quick("spikes", &outline(spikes));
}
