//! Time of one frame: `cargo bench -p hasard-engine`.
//!
//! The level is like that of Volcanic Venture: 289 tiles, two in five of them raised, seen from
//! random places inside.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use hasard_engine::assets::Assets;
use hasard_engine::map::{Map, MapBuilder, SectorId, Style, TileGrid};
use hasard_engine::math::{Angle, Fixed, Rng};
use hasard_engine::render::{Buffers, FrameScratch, FrameSize, Renderer, Scene, View};
use hasard_engine::world::{ActorKind, World};
use std::hint::black_box;
use std::sync::Arc;

/// Half the view's downward pitch in the level that the bench is like, degrees.
const PITCH: f64 = 16.5;

fn level() -> World {
    let style = |column: usize, row: usize| Style {
        floor: 0,
        ceiling: 250,
        light: 210,
        floor_texture: "LAVA1",
        ceiling_texture: "FLAT5_5",
        wall: "A-BROK28",
        step: "AQF052",
        lintel: "AQF052",
        special: 0,
        tag: (100 + row * 17 + column) as i32,
    };
    let mut builder = MapBuilder::new();
    TileGrid::new((0, 64), 128, 17, 17, style).paint(&mut builder);
    let map = Map::build(&builder.finish().unwrap(), "level", &["FLOOR0_5"]).unwrap();
    let mut world = World::new(Arc::new(map), 1);
    let mut rng = Rng::new(3);
    let slab = world.map.texture("FLOOR0_5").unwrap();
    for sector in 0..world.sector_count() as u32 {
        if rng.below(5) < 2 {
            let sector = world.sector_mut(SectorId(sector));
            (sector.floor, sector.floor_texture) = (Fixed::from_int(16), slab);
        }
    }
    for _ in 0..30 {
        let (x, y) =
            (Fixed::from_int(rng.between(20, 2150)), Fixed::from_int(rng.between(84, 2220)));
        world.spawn(ActorKind::ArmorBonus, x, y, Fixed::from_int(20));
    }
    world.add_player(Fixed::from_int(1088), Fixed::from_int(1152), Angle::EAST);
    world
}

fn look_somewhere(world: &mut World, rng: &mut Rng) {
    let (x, y) = (Fixed::from_int(rng.between(20, 2150)), Fixed::from_int(rng.between(84, 2220)));
    let angle = Angle(rng.next_u64() as u32);
    let sector = world.map.sector_at(x, y);
    let floor = world.sector(sector).floor;
    let body = world.players[0].actor;
    if let Some(body) = world.get_mut(body) {
        (body.x, body.y, body.z, body.angle, body.sector) = (x, y, floor, angle, sector);
    }
    let player = &mut world.players[0];
    (player.view_z, player.pitch) =
        (floor + Fixed::from_int(41), Angle::from_degrees(PITCH).0 as i32);
}

fn frames(criterion: &mut Criterion) {
    let mut world = level();
    let scene = Arc::new(Scene::new(&world.map, Assets::embedded()));
    let mut group = criterion.benchmark_group("frame");
    for (width, height) in [(128, 72), (160, 120), (320, 240), (640, 480), (1920, 1080)] {
        let size = FrameSize { width, height };
        let mut renderer = Renderer::new(scene.clone(), Arc::new(View::new(size).unwrap()));
        let mut scratch = FrameScratch::default();
        let mut rgb = vec![0; size.pixels() * 3];
        for (name, buffers) in [
            ("colour", Buffers::default()),
            ("colour, depth and labels", Buffers { depth: true, labels: true }),
        ] {
            let mut rng = Rng::new(9);
            group.bench_function(BenchmarkId::new(name, size), |bencher| {
                bencher.iter_batched(
                    || {
                        look_somewhere(&mut world, &mut rng);
                        world.clone()
                    },
                    |world| {
                        renderer.render(&mut scratch, black_box(&world), 0, buffers);
                        world
                    },
                    criterion::BatchSize::SmallInput,
                );
            });
        }
        group.bench_function(BenchmarkId::new("to RGB rows", size), |bencher| {
            bencher.iter(|| renderer.write_rgb_hwc(black_box(&mut rgb)));
        });
        group.bench_function(BenchmarkId::new("to RGB planes", size), |bencher| {
            bencher.iter(|| renderer.write_rgb_chw(black_box(&mut rgb)));
        });
    }
}

criterion_group!(benches, frames);
criterion_main!(benches);
