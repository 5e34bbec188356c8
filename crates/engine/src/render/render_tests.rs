//! Tests of whole frames.
//!
//! Long because every kind of frame is compared here with every family of vectors.

use super::*;
use crate::assets::Assets;
use crate::map::{Map, MapBuilder, Mark, Style, TileGrid};
use crate::math::{Angle, Fixed, Rng};
use crate::simd::Simd;
use crate::world::{ActorKind, Weapon, World};
use std::sync::{Arc, OnceLock};

pub(super) const STYLE: Style = Style {
    floor: 0,
    ceiling: 250,
    light: 210,
    floor_texture: "LAVA1",
    ceiling_texture: "FLAT5_5",
    wall: "A-BROK28",
    step: "AQF052",
    lintel: "AQF052",
    special: 0,
    tag: 0,
};

pub(super) fn assets() -> Arc<Assets> {
    static ASSETS: OnceLock<Arc<Assets>> = OnceLock::new();
    ASSETS.get_or_init(Assets::embedded).clone()
}

/// A yard under the sky with steps, a gallery, a pillar, a slanted wall, a fence and a pit.
fn yard() -> (Arc<Map>, Arc<Scene>) {
    static YARD: OnceLock<(Arc<Map>, Arc<Scene>)> = OnceLock::new();
    YARD.get_or_init(|| {
        let mut builder = MapBuilder::new();
        let tile = |column: usize, row: usize| Style {
            floor: ((column * 7 + row * 5) % 6) as i32 * 8,
            tag: 100 + (row * 8 + column) as i32,
            ..STYLE
        };
        builder.rectangle(Style { ceiling_texture: "F_SKY1", ..STYLE }, -600, -300, 1700, 1500);
        TileGrid::new((0, 0), 128, 8, 8, tile).paint(&mut builder);
        builder.rectangle(
            Style { ceiling: 96, light: 120, floor_texture: "FLOOR0_5", ..STYLE },
            1100,
            100,
            1500,
            700,
        );
        builder.rectangle(
            Style { floor: -64, ceiling_texture: "F_SKY1", light: 0, ..STYLE },
            -500,
            0,
            -200,
            300,
        );
        builder.solid(&[(-300, 900), (-200, 800), (-100, 900), (-200, 1000)]);
        let fence = Mark {
            middle: Some("AQF052"),
            blocking: true,
            lower_unpegged: true,
            ..Mark::default()
        };
        builder.mark(fence, &[(-500, 600), (-100, 600)]);
        let map = Arc::new(Map::build(&builder.finish().unwrap(), "yard", &[]).unwrap());
        let scene = Arc::new(Scene::new(&map, assets()));
        (map, scene)
    })
    .clone()
}

fn yard_world() -> World {
    let mut world = World::new(yard().0, 3);
    world.add_player(Fixed::ZERO, Fixed::ZERO, Angle::EAST);
    let mut rng = Rng::new(11);
    let kinds: Vec<ActorKind> =
        ActorKind::all().filter(|&kind| kind != ActorKind::Player).collect();
    for kind in kinds.into_iter().chain([ActorKind::ArmorBonus; 100]) {
        let (x, y) =
            (Fixed::from_int(rng.between(-590, 1690)), Fixed::from_int(rng.between(-290, 1490)));
        let id = world.spawn(kind, x, y, Fixed::ZERO);
        let actor = world.get_mut(id).unwrap();
        (actor.z, actor.angle) = (actor.floor_z, Angle(rng.next_u64() as u32));
    }
    world
}

fn look(world: &mut World, x: Fixed, y: Fixed, angle: Angle, pitch: i32) {
    let id = world.players[0].actor;
    let sector = world.map.sector_at(x, y);
    let floor = world.sector(sector).floor;
    let body = world.get_mut(id).unwrap();
    (body.x, body.y, body.z, body.angle, body.sector) = (x, y, floor, angle, sector);
    (world.players[0].view_z, world.players[0].pitch) = (floor + Fixed::from_int(41), pitch);
}

/// Anywhere in or about the yard, every third time exactly on a line, at any pitch and with any
/// flash.
fn look_anywhere(world: &mut World, rng: &mut Rng) {
    let (mut x, mut y) =
        (Fixed(rng.between(-800 << 16, 1900 << 16)), Fixed(rng.between(-500 << 16, 1700 << 16)));
    if rng.below(3) == 0 {
        let line = world.map.lines[rng.below(world.map.lines.len() as u32) as usize].clone();
        (x, y) = match rng.below(3) {
            0 => (line.v1.x, line.v1.y),
            1 => (line.v1.x + line.dx / 2, line.v1.y + line.dy / 2),
            _ => (line.v1.x + line.dx / 3 + Fixed(1), line.v1.y + line.dy / 3),
        };
    }
    let angle =
        if rng.below(4) == 0 { Angle(rng.below(8) << 29) } else { Angle(rng.next_u64() as u32) };
    let pitch = if rng.below(2) == 0 {
        0
    } else {
        Angle::from_degrees(f64::from(rng.between(-32, 56))).0 as i32
    };
    look(world, x, y, angle, pitch);
    let player = &mut world.players[0];
    player.view_z += Fixed(rng.between(-(20 << 16), 60 << 16));
    player.extra_light = rng.below(3) as u8;
    player.damage_count = rng.below(101) as u8;
    player.bonus_count = rng.below(7) as u8;
    player.infrared_tics = rng.below(300);
    player.armor = rng.between(0, 300);
    player.ammo = [0; 4].map(|_| rng.between(0, 400));
    world.tic = rng.below(5000);
}

fn renderer(width: u16, height: u16) -> Renderer {
    Renderer::new(yard().1, Arc::new(View::new(FrameSize { width, height }).unwrap()))
}

const ALL: Buffers = Buffers { depth: true, labels: true };

#[test]
fn every_family_of_instructions_draws_the_same_bits() {
    let mut scratch = FrameScratch::default();
    let (mut world, mut rng) = (yard_world(), Rng::new(33));
    for (width, height, frames) in
        [(128, 72, 200), (160, 120, 60), (100, 48, 60), (640, 480, 10), (1001, 700, 3)]
    {
        let mut plain = renderer(width, height);
        plain.set_simd(Simd::PLAIN);
        for frame in 0..frames {
            look_anywhere(&mut world, &mut rng);
            let buffers = [Buffers::default(), ALL][frame % 2];
            plain.render(&mut scratch, &world, 0, buffers);
            for simd in Simd::available() {
                let mut other = renderer(width, height);
                other.set_simd(simd);
                other.render(&mut scratch, &world, 0, buffers);
                assert!(
                    plain.indices() == other.indices(),
                    "colour of frame {frame}, {width}x{height}, {simd:?}"
                );
                if buffers.depth {
                    assert!(
                        plain.depth() == other.depth(),
                        "depth of frame {frame}, {width}x{height}, {simd:?}"
                    );
                    assert!(
                        plain.classes() == other.classes(),
                        "classes of frame {frame}, {width}x{height}, {simd:?}"
                    );
                    assert_eq!(plain.labels(), other.labels(), "{simd:?}");
                }
            }
        }
    }
}

#[test]
fn what_does_not_stay_is_drawn_as_what_does() {
    let mut scratch = FrameScratch::default();
    let (mut world, mut rng) = (yard_world(), Rng::new(34));
    let sizes = [(128, 72), (160, 120), (128, 72), (100, 48)];
    let mut pairs = sizes.map(|(width, height)| [renderer(width, height), renderer(width, height)]);
    for frame in 0..60 {
        look_anywhere(&mut world, &mut rng);
        for ([keeps, passes], _) in pairs.iter_mut().zip(sizes) {
            let buffers =
                [Buffers::default(), ALL, Buffers { depth: true, labels: false }][frame % 3];
            keeps.render(&mut scratch, &world, 0, buffers);
            let mut written = 0;
            passes.render_then(&mut scratch, &world, 0, buffers, |passes| {
                assert!(
                    passes.indices() == keeps.indices() && passes.palette() == keeps.palette(),
                    "frame {frame}"
                );
                if buffers.depth {
                    assert!(passes.depth() == keeps.depth(), "depth of frame {frame}");
                }
                if buffers.labels {
                    assert!(
                        passes.classes() == keeps.classes() && passes.labels() == keeps.labels(),
                        "frame {frame}"
                    );
                }
                written += 1;
            });
            assert_eq!(written, 1);
            assert!(passes.indices().is_empty(), "it does not stay");
        }
    }
}

#[test]
fn flashes_come_and_go() {
    let mut scratch = FrameScratch::default();
    let mut world = yard_world();
    look(&mut world, Fixed::ZERO, Fixed::ZERO, Angle::EAST, 0);
    let mut lasting = renderer(100, 48);
    for (damage, bonus) in [(0, 0), (40, 0), (0, 0), (0, 5), (40, 5), (40, 0), (0, 0), (0, 5)] {
        (world.players[0].damage_count, world.players[0].bonus_count) = (damage, bonus);
        let mut afresh = renderer(100, 48);
        let written = [&mut lasting, &mut afresh].map(|renderer| {
            renderer.render(&mut scratch, &world, 0, Buffers::default());
            let mut out = vec![0; 100 * 48 * 3];
            renderer.write_rgb_hwc(&mut out);
            (out, *renderer.palette())
        });
        assert!(written[0] == written[1], "after others: damage {damage}, bonus {bonus}");
        let untinted = written[0].1 == yard().1.assets.palette;
        assert_eq!(untinted, (damage, bonus) == (0, 0), "damage {damage}, bonus {bonus}");
    }
}

#[test]
fn the_learners_frame_is_the_reduction_of_the_classic_one() {
    let mut scratch = FrameScratch::default();
    let (mut world, mut rng) = (yard_world(), Rng::new(21));
    let (mut small, mut large) = (renderer(128, 72), renderer(160, 120));
    for frame in 0..300 {
        look_anywhere(&mut world, &mut rng);
        small.render(&mut scratch, &world, 0, ALL);
        large.render(&mut scratch, &world, 0, ALL);
        for y in 0..72 {
            for x in 0..128 {
                let (at, from) = (y * 128 + x, (y * 5 / 3) * 160 + x * 5 / 4);
                assert_eq!(
                    small.indices()[at],
                    large.indices()[from],
                    "colour at {x}, {y} of frame {frame}"
                );
                assert_eq!(
                    small.depth()[at],
                    large.depth()[from],
                    "depth at {x}, {y} of frame {frame}"
                );
                let kind =
                    |renderer: &Renderer, class: u16| match class.checked_sub(class::FIRST_ACTOR) {
                        Some(index) => Err(renderer.labels()[usize::from(index)].actor),
                        None => Ok(class),
                    };
                let (a, b) =
                    (kind(&small, small.classes()[at]), kind(&large, large.classes()[from]));
                assert_eq!(a, b, "class at {x}, {y} of frame {frame}");
            }
        }
        assert_eq!(small.palette(), large.palette());
    }
}

#[test]
fn buffers_do_not_change_the_colours() {
    let mut scratch = FrameScratch::default();
    let (mut world, mut rng) = (yard_world(), Rng::new(22));
    let (mut with, mut without) = (renderer(160, 120), renderer(160, 120));
    for _ in 0..60 {
        look_anywhere(&mut world, &mut rng);
        with.render(&mut scratch, &world, 0, ALL);
        for buffers in [
            Buffers::default(),
            Buffers { depth: true, labels: false },
            Buffers { depth: false, labels: true },
        ] {
            without.render(&mut scratch, &world, 0, buffers);
            assert_eq!(with.indices(), without.indices());
            assert!(!buffers.depth || with.depth() == without.depth());
            assert!(
                !buffers.labels
                    || (with.classes() == without.classes() && with.labels() == without.labels())
            );
        }
    }
}

/// ViZDoom draws the sky under goggles as without; everything else is then of one light.
#[test]
fn goggles_leave_the_sky_as_it_is() {
    let mut scratch = FrameScratch::default();
    let (mut world, mut renderer) = (yard_world(), renderer(160, 120));
    look(&mut world, Fixed::from_int(-550), Fixed::from_int(-250), Angle::EAST, 0);
    renderer.render(&mut scratch, &world, 0, ALL);
    let (bare, classes) = (renderer.indices().to_vec(), renderer.classes().to_vec());
    world.players[0].infrared_tics = 1000;
    renderer.render(&mut scratch, &world, 0, ALL);
    let changed = |sky: bool| {
        (0..bare.len())
            .filter(|&at| (classes[at] == class::SKY) == sky && bare[at] != renderer.indices()[at])
            .count()
    };
    assert!(classes.contains(&class::SKY));
    assert_eq!(changed(true), 0);
    assert!(changed(false) > 1000);
}

#[test]
fn a_used_renderer_draws_as_a_new_one() {
    let mut scratch = FrameScratch::default();
    let (mut world, mut rng) = (yard_world(), Rng::new(23));
    let sizes = [(128, 72), (64, 48), (320, 240), (641, 480)];
    let mut renderers = sizes.map(|(width, height)| renderer(width, height));
    for frame in 0..120 {
        look_anywhere(&mut world, &mut rng);
        let id = world.players[0].actor;
        world.get_mut(id).unwrap().health = rng.between(1, 1200);
        let player = &mut world.players[0];
        player.weapons = rng.below(1 << 9) as u16;
        player.keys = rng.below(4) as u8;
        player.weapon = [None, Some(Weapon::Pistol), Some(Weapon::Bfg9000)][rng.below(3) as usize];
        let ((width, height), used) = (sizes[frame % 4], &mut renderers[frame % 4]);
        used.render(&mut scratch, &world, 0, ALL);
        let mut new = renderer(width, height);
        new.render(&mut scratch, &world, 0, ALL);
        assert_eq!(used.indices(), new.indices());
        assert_eq!(
            (used.depth(), used.classes(), used.palette()),
            (new.depth(), new.classes(), new.palette())
        );
    }
}

#[test]
fn every_size_draws_from_anywhere() {
    let mut scratch = FrameScratch::default();
    let (mut world, mut rng) = (yard_world(), Rng::new(24));
    let extremes = [
        (64, 48),
        (1920, 1080),
        (64, 1080),
        (1920, 48),
        (128, 72),
        (320, 240),
        (1280, 1024),
        (65, 49),
    ];
    let sizes = (0..40)
        .map(|_| (rng.between(64, 400) as u16, rng.between(48, 300) as u16))
        .collect::<Vec<_>>();
    for (width, height) in extremes.into_iter().chain(sizes) {
        let mut renderer = renderer(width, height);
        for _ in 0..12 {
            look_anywhere(&mut world, &mut rng);
            renderer.render(&mut scratch, &world, 0, ALL);
        }
    }
}

/// A closed room around the origin, its walls `half` away.
fn room(half: i32) -> (World, Renderer) {
    let mut builder = MapBuilder::new();
    builder.rectangle(STYLE, -half, -half, half, half);
    let map = Arc::new(Map::build(&builder.finish().unwrap(), "room", &[]).unwrap());
    let mut world = World::new(map.clone(), 1);
    world.add_player(Fixed::ZERO, Fixed::ZERO, Angle::EAST);
    let scene = Arc::new(Scene::new(&map, assets()));
    let renderer = Renderer::new(scene, Arc::new(View::new(FrameSize::CLASSIC).unwrap()));
    (world, renderer)
}

#[test]
fn depth_is_the_distance_forward() {
    let mut scratch = FrameScratch::default();
    for half in [40, 256, 756, 1500] {
        let (mut world, mut renderer) = room(half);
        look(&mut world, Fixed::ZERO, Fixed::ZERO, Angle::EAST, 0);
        renderer.render(&mut scratch, &world, 0, ALL);
        let depth = |x: usize, y: usize| i32::from(renderer.depth()[y * 160 + x]);
        // The wall ahead is equally far in every column.
        let wall = half * 10 / 73;
        assert_eq!([depth(1, 48), depth(80, 48), depth(158, 48)], [wall; 3], "wall at {half}");
        // The floor 41 below the eye: row 90 is 40.5 rows below the horizon, 96 rows are one unit
        // of slope.
        if half > 256 {
            assert_eq!(depth(80, 90), (41.0 * 96.0 / 40.5 / 7.3) as i32);
        }
        assert_eq!(depth(80, 110), 0, "the status bar has no depth");
    }
}

#[test]
fn published_depth_ends_early_except_on_floors() {
    let mut scratch = FrameScratch::default();
    let (mut world, mut renderer) = room(2000);
    look(&mut world, Fixed::ZERO, Fixed::ZERO, Angle::EAST, 0);
    renderer.set_options(RenderOptions { published_depth: true, ..RenderOptions::default() });
    renderer.render(&mut scratch, &world, 0, ALL);
    assert_eq!(renderer.depth()[48 * 160 + 80], 63);
    assert!(renderer.depth()[54 * 160 + 80] > 63, "floor");
}

#[test]
fn no_pixel_of_a_closed_room_is_missed() {
    let mut scratch = FrameScratch::default();
    // A hole would show as a pixel that is not of the wall's, floor's or ceiling's class at its
    // proper place; the buffers start as far wall, so depth shows it: no wall of this room is
    // farther than its diagonal.
    let (mut world, mut renderer) = room(300);
    let mut rng = Rng::new(31);
    for _ in 0..500 {
        let (x, y) =
            (Fixed(rng.between(-280 << 16, 280 << 16)), Fixed(rng.between(-280 << 16, 280 << 16)));
        look(&mut world, x, y, Angle(rng.next_u64() as u32), rng.between(-380, 660) << 20);
        renderer.render(&mut scratch, &world, 0, ALL);
        let farthest = renderer.depth()[..160 * 100].iter().max().copied().unwrap_or(0);
        assert!(i32::from(farthest) <= 850 * 10 / 73, "a hole as far as {farthest}");
    }
}

#[test]
fn labels_agree_with_the_class_buffer() {
    let mut scratch = FrameScratch::default();
    let (mut world, mut rng) = (yard_world(), Rng::new(25));
    let mut renderer = renderer(160, 120);
    let mut labelled = 0;
    for _ in 0..100 {
        look_anywhere(&mut world, &mut rng);
        renderer.render(&mut scratch, &world, 0, ALL);
        for (i, label) in renderer.labels().iter().enumerate() {
            assert_eq!(usize::from(label.class - class::FIRST_ACTOR), i);
            let actor = world.get(label.actor).unwrap();
            assert_eq!(actor.kind, label.kind);
            assert_ne!(label.actor, world.players[0].actor, "nobody sees itself");
            labelled += 1;
        }
        for (at, &class) in renderer.classes().iter().enumerate() {
            let (x, y) = ((at % 160) as u16, (at / 160) as u16);
            assert_eq!(class == class::STATUS_BAR, y >= 100);
            let Some(index) = class.checked_sub(class::FIRST_ACTOR) else { continue };
            let label = renderer.labels()[usize::from(index)];
            assert!(
                (label.x..label.x + label.width).contains(&x)
                    && (label.y..label.y + label.height).contains(&y)
            );
        }
    }
    assert!(labelled > 300, "the test sees actors: {labelled}");
}

#[test]
fn an_actor_behind_a_wall_is_not_seen() {
    let mut scratch = FrameScratch::default();
    let mut builder = MapBuilder::new();
    builder.rectangle(STYLE, -500, -500, 500, 500);
    builder.solid(&[(100, -60), (140, -60), (140, 60), (100, 60)]);
    let map = Arc::new(Map::build(&builder.finish().unwrap(), "pillar", &[]).unwrap());
    let scene = Arc::new(Scene::new(&map, assets()));
    let mut renderer = Renderer::new(scene, Arc::new(View::new(FrameSize::CLASSIC).unwrap()));
    let mut world = World::new(map, 1);
    world.add_player(Fixed::ZERO, Fixed::ZERO, Angle::EAST);
    let mut seen_at = |y: i32| {
        let id = world.spawn(
            ActorKind::ArmorBonus,
            Fixed::from_int(300),
            Fixed::from_int(y),
            Fixed::ZERO,
        );
        look(&mut world, Fixed::ZERO, Fixed::ZERO, Angle::EAST, 0);
        renderer.render(&mut scratch, &world, 0, ALL);
        world.remove(id);
        renderer.labels().len()
    };
    // From the origin the pillar's near edge hides everything up to 180 aside at a distance of 300.
    assert_eq!(
        [seen_at(0), seen_at(150), seen_at(-150), seen_at(200), seen_at(-200)],
        [0, 0, 0, 1, 1]
    );
}

#[test]
fn conversions_agree_with_one_another() {
    let mut scratch = FrameScratch::default();
    let mut world = yard_world();
    let mut renderer = renderer(128, 72);
    look(&mut world, Fixed::from_int(-550), Fixed::from_int(-250), Angle::from_degrees(45.0), 0);
    renderer.render(&mut scratch, &world, 0, ALL);
    let pixels = 128 * 72;
    let (mut hwc, mut chw, mut grey) = (vec![0; pixels * 3], vec![0; pixels * 3], vec![0; pixels]);
    renderer.write_rgb_hwc(&mut hwc);
    renderer.write_rgb_chw(&mut chw);
    renderer.write_grey(&mut grey);
    for at in 0..pixels {
        let colour = renderer.palette()[usize::from(renderer.indices()[at])];
        assert_eq!(hwc[at * 3..at * 3 + 3], colour);
        assert_eq!([chw[at], chw[pixels + at], chw[2 * pixels + at]], colour);
        assert_eq!(grey[at], colour::palette::luminance(colour));
    }
    let colours = SegmentationColours::distinct();
    renderer.write_segmented_hwc(&colours, &mut hwc);
    renderer.write_segmented_chw(&colours, &mut chw);
    for at in 0..pixels {
        assert_eq!(hwc[at * 3..at * 3 + 3], [chw[at], chw[pixels + at], chw[2 * pixels + at]]);
    }
}
