//! The squares of rockets' trails on the frame, between the sprites: the farthest first.

use crate::math::Fixed;
use crate::render::scene::prepared::Scene;
use crate::render::sprites::sprite::Extent;
use crate::render::view::camera::Camera;
use crate::render::view::light::{Light, ONE_TABLE_DISTANCE};
use crate::render::view::line::INVERSE_BITS;
use crate::render::view::tables::View;
use crate::world::{Shed, Square, World};

/// Squares nearer than this, in 16.16 map units, are not drawn: the largest that were seen are as
/// near.
const NEAREST: i64 = 2 << 16;

/// What 16.16 has more than 4096ths, and 1 over a 4096th in 16.16.
const FINE: u32 = 4;
const INVERSE_UNIT: i64 = 1 << 28;

/// Nearness brightens squares as if they were half as far away as they are.
const ONE_TABLE: i64 = 2 * ONE_TABLE_DISTANCE;

/// The squares of a frame.
#[derive(Debug, Default)]
pub(crate) struct Particles {
    /// What the squares that are still to be drawn cover, the nearest first.
    pub spots: Vec<Particle>,
    pub trails: Vec<ParticleTrail>,
    /// Scratch.
    left: Vec<Shed>,
}

/// A trail's squares together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ParticleTrail {
    /// Of their columns, the first and one past the last.
    pub columns: [u16; 2],
    /// Of the farthest.
    pub distance: i64,
    /// DrawSegs may hide some of them.
    pub hidden: bool,
}

/// What a square covers of the frame.
#[derive(Clone, Copy, Default, Debug)]
pub(crate) struct Particle {
    pub distance: i64,
    pub columns: [u16; 2],
    pub rows: [i16; 2],
    /// Its middle, 16.16.
    pub place: [Fixed; 3],
    pub trail: u16,
    pub colour: u8,
    pub opacity: u8,
}

impl Particles {
    /// Works out what squares cover if nothing hides them.
    pub fn collect(&mut self, scene: &Scene, view: &View, camera: &Camera, world: &World) {
        self.trails.clear();
        self.spots.clear();
        for trail in world.trails.iter().filter(|trail| !trail.tics(world.tic).is_empty()) {
            let light = Light::new(camera, i32::from(world.sector(trail.sector).light));
            self.left.clear();
            trail.list(world.tic, &mut self.left);
            let first = self.spots.len();
            let (mut end, number) = (first, self.trails.len() as u16);
            self.spots.resize(first + self.left.len(), Particle::default());
            for shed in &self.left {
                // Which are in view is unpredictable: all are written, and those counted.
                let (spot, is_seen) =
                    spot(scene, view, camera, light, number, &trail.square(shed, world.tic));
                self.spots[end] = spot;
                end += usize::from(is_seen);
            }
            self.spots.truncate(end);
            self.trails.push(ParticleTrail::of(&self.spots[first..]));
        }
        self.spots.sort_unstable_by_key(|spot| spot.distance);
    }
}

impl ParticleTrail {
    fn of(spots: &[Particle]) -> ParticleTrail {
        let nothing = ParticleTrail { columns: [u16::MAX, 0], distance: 0, hidden: true };
        spots.iter().fold(nothing, |all, spot| ParticleTrail {
            columns: [all.columns[0].min(spot.columns[0]), all.columns[1].max(spot.columns[1])],
            distance: all.distance.max(spot.distance),
            ..all
        })
    }
}

/// The inverse of a distance.
pub(crate) fn inverse(distance: i64) -> i64 {
    (1 << (INVERSE_BITS + 16)) / distance
}

impl Particle {
    /// What decides what hides it.
    pub fn extent(&self) -> Extent {
        let ([x, y, height], [first, end]) = (self.place, self.columns.map(usize::from));
        Extent {
            inverse: inverse(self.distance),
            x: i64::from(x.0),
            y: i64::from(y.0),
            top: height,
            bottom: height,
            first,
            end,
        }
    }
}

/// What a square covers if nothing hides it, and whether that is anything: whole columns from that
/// of its left edge to that before its right one, and whole rows, that of its lower edge too.
#[inline(always)]
fn spot(
    scene: &Scene,
    view: &View,
    camera: &Camera,
    light: Light,
    trail: u16,
    square: &Square,
) -> (Particle, bool) {
    let [left, right] = camera.edges(i64::from(square.place[0].0), i64::from(square.place[1].0));
    let (away, across) = ((left + right) >> 1, (left - right) >> 1);
    let distance = away.max(NEAREST);
    let beside = across.abs() > distance + i64::from(square.half.0);
    // ViZDoom takes distances to 4096ths of a unit, and cuts their inverse to 65536ths: columns and
    // rows of a unit follow from that, so that what is far away is drawn nearer to the middle.
    let inverse = INVERSE_UNIT / (distance >> FINE);
    let width = i64::from(view.base_width);
    let half = i64::from(square.half.0);
    let column = |edge: i64| {
        (((width << 16) + (((edge >> FINE) * width * inverse) >> (16 - FINE))) >> 17)
            .clamp(0, width)
    };
    let columns =
        [across - half, across + half].map(|edge| view.first_column[column(edge) as usize]);
    let rows_a_unit = (view.focal_y * inverse) >> 16;
    let above = i64::from(square.place[2].0) - camera.z;
    let row = |edge: i64| (camera.horizon - ((edge * rows_a_unit) >> 16)) >> 16;
    let frame_row =
        |row: i64| view.first_row[row.clamp(0, i64::from(view.base_view_rows)) as usize];
    let rows = [frame_row(row(above + half)), frame_row(row(above - half) + 1)];
    // Learners' frames leave out every fifth column and two rows of five.
    let is_seen = (away >= NEAREST) & !beside & (columns[0] < columns[1]) & (rows[0] < rows[1]);
    let table = light.table(ONE_TABLE * inverse);
    let colour = scene.assets.light_tables[table][usize::from(scene.shades[square.shade as usize])];
    let spot = Particle {
        distance,
        columns,
        rows,
        place: square.place,
        trail,
        colour,
        opacity: square.opacity,
    };
    (spot, is_seen)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::Assets;
    use crate::map::stone_room;
    use crate::math::Angle;
    use crate::render::buffers::request::Buffers;
    use crate::render::renderer::Renderer;
    use crate::render::scene::prepared::Scene;
    use crate::render::scratch::FrameScratch;
    use crate::render::view::size::FrameSize;
    use crate::render::view::tables::View;
    use crate::simd::Simd;
    use crate::world::{ActorKind, Chance, Trail};
    use std::sync::Arc;

    const SIZES: [FrameSize; 3] =
        [FrameSize::LEARNER, FrameSize::CLASSIC, FrameSize { width: 640, height: 480 }];

    /// A room whose eastern wall the player sidedefs, and a trail northwards at a distance; its
    /// squares are of all ages.
    fn world(east: i32) -> World {
        let mut world = World::new(stone_room(255, [-64, -512, 256, 512], &[[0.0, 0.0]]), 1);
        let id = world.players[0].actor;
        world.get_mut(id).unwrap().angle = Angle::EAST;
        (world.players[0].view_z, world.players[0].sprites) = (Fixed::from_int(41), [None; 2]);
        world.tic = 50;
        let place = [Fixed::from_int(east), Fixed::from_int(-320), Fixed::from_int(36)];
        let velocity = [Fixed::ZERO, Fixed::from_int(20), Fixed::ZERO];
        let sector = world.map.sector_at(Fixed::ZERO, Fixed::ZERO);
        world.trails.push(Trail::new(id, place, velocity, 18, sector, Chance::Own(5)));
        world
    }

    struct Shot {
        rgb: Vec<u8>,
        rest: (Vec<u8>, Vec<u16>),
    }

    fn shoot(world: &World, size: FrameSize, simd: Simd) -> Shot {
        let mut scratch = FrameScratch::default();
        let scene = Arc::new(Scene::new(&world.map, Assets::embedded()));
        let mut renderer = Renderer::new(scene, Arc::new(View::new(size).unwrap()));
        renderer.set_simd(simd);
        renderer.render(&mut scratch, world, 0, Buffers { depth: true, labels: true });
        let mut rgb = vec![0; size.pixels() * 3];
        renderer.write_rgb_hwc(&mut rgb);
        Shot { rgb, rest: (renderer.depth().to_vec(), renderer.classes().to_vec()) }
    }

    fn changed(with: &Shot, without: &Shot) -> usize {
        with.rgb.chunks_exact(3).zip(without.rgb.chunks_exact(3)).filter(|(a, b)| a != b).count()
    }

    fn without_trails(world: &World) -> World {
        let mut bare = world.clone();
        bare.trails.clear();
        bare
    }

    #[test]
    fn squares_show_in_colours_alone_and_the_same_by_all_instructions() {
        let world = world(128);
        for size in SIZES {
            let (plain, bare) = (
                shoot(&world, size, Simd::PLAIN),
                shoot(&without_trails(&world), size, Simd::PLAIN),
            );
            let pixels = changed(&plain, &bare);
            // About 60 are in view, 0.75 units wide and high, and a row more; of a learner's
            // frame's 160 columns and 120 rows fewer are kept.
            let is_reduced = size == FrameSize::LEARNER;
            let side = 0.75 * if is_reduced { 160.0 } else { f64::from(size.width) } / 2.0 / 128.0;
            let mean = 60.0 * side * (1.2 * side + 1.0) * if is_reduced { 0.8 * 0.6 } else { 1.0 };
            let expected = (mean / 2.0) as usize..(mean * 2.0) as usize;
            assert!(expected.contains(&pixels), "{pixels} pixels, not {expected:?}, at {size:?}");
            assert_eq!(plain.rest, bare.rest, "depth and labels say nothing of squares");
            for simd in Simd::available() {
                assert!(shoot(&world, size, simd).rgb == plain.rgb, "{simd:?}");
            }
            assert!(shoot(&world.clone(), size, Simd::PLAIN).rgb == plain.rgb);
        }
    }

    #[test]
    fn walls_hide_squares() {
        let world = world(300);
        for size in SIZES {
            let [with, without] =
                [&world, &without_trails(&world)].map(|world| shoot(world, size, Simd::PLAIN));
            assert_eq!(changed(&with, &without), 0, "behind the eastern wall");
        }
    }

    #[test]
    fn sprites_before_squares_hide_them_and_those_behind_do_not() {
        let mut world = world(128);
        let size = SIZES[2];
        let seen = |world: &World| {
            changed(
                &shoot(world, size, Simd::PLAIN),
                &shoot(&without_trails(world), size, Simd::PLAIN),
            )
        };
        let alone = seen(&world);
        let id = world.spawn(ActorKind::BigTree, Fixed::from_int(200), Fixed::ZERO, Fixed::ZERO);
        // Where a square has the colour of what is behind it, it changes nothing.
        assert!(seen(&world).abs_diff(alone) <= alone / 10, "a tree behind them");
        world.get_mut(id).unwrap().x = Fixed::from_int(40);
        assert!(
            seen(&world) < alone * 9 / 10,
            "{} of {alone} past a tree before them",
            seen(&world)
        );
    }

    #[test]
    fn the_nearest_squares_are_drawn_last() {
        let mut world = world(128);
        let sector = world.map.sector_at(Fixed::ZERO, Fixed::ZERO);
        for (start, speed) in [(40, 20), (240, -20)] {
            let place = [start, 30, 36].map(Fixed::from_int);
            let velocity = [speed, 0, 0].map(Fixed::from_int);
            world.trails.push(Trail::new(
                world.players[0].actor,
                place,
                velocity,
                40,
                sector,
                Chance::Own(5),
            ));
        }
        let scene = Scene::new(&world.map, Assets::embedded());
        let (view, mut seen) = (View::new(SIZES[2]).unwrap(), Particles::default());
        let horizon = i64::from(view.base_view_rows) << 15;
        let camera = Camera { forward: [1 << 16, 0], z: 41 << 16, horizon, ..Camera::default() };
        seen.collect(&scene, &view, &camera, &world);
        assert!(
            seen.spots.is_sorted_by_key(|spot| spot.distance) && seen.spots.len() > 100,
            "{}",
            seen.spots.len()
        );
        for number in 0..3 {
            let own = || seen.spots.iter().filter(|spot| spot.trail == number);
            assert_eq!(
                own().map(|spot| spot.distance).max(),
                Some(seen.trails[usize::from(number)].distance)
            );
            assert!(own().all(|spot| spot.distance == i64::from(spot.place[0].0)));
        }
    }
}
