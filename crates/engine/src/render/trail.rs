//! The squares of rockets' trails on the frame, between the sprites.
//!
//! The squares of one tic are drawn together: they lie within a tic's way of each other, and a rocket flies straight, so that a
//! trail is sorted by distance as it is by time.

use super::camera::Camera;
use super::light::{Light, ONE_TABLE_DISTANCE};
use super::masked::Masked;
use super::scene::Scene;
use super::sprite::Extent;
use super::view::View;
use super::wall::INVERSE_BITS;
use crate::math::Fixed;
use crate::world::{Shed, Square, Trail, World};
use std::ops::Range;

/// Colours of the squares by their [`Shade`](crate::world::Shade): the entries of Freedoom's palette that the published engine shows.
pub(super) const SHADES: [[u8; 3]; 3] = [[171; 3], [87; 3], [255, 255, 0]];

/// Squares nearer than this, in 16.16 map units, are not drawn: the largest that were seen are as near.
const NEAREST: i64 = 2 << 16;

/// What 16.16 has more than 4096ths, and 1 over a 4096th in 16.16.
const FINE: u32 = 4;
const INVERSE_UNIT: i64 = 1 << 28;

/// Nearness brightens squares as if they were half as far away as they are.
const ONE_TABLE: i64 = 2 * ONE_TABLE_DISTANCE;

/// The trails of a frame.
#[derive(Debug, Default)]
pub(super) struct SeenTrails {
    list: Vec<SeenTrail>,
    /// What their squares cover, trail after trail and tic after tic.
    spots: Vec<Spot>,
    /// Scratch.
    left: Vec<Shed>,
}

/// A trail of which some squares are still to be drawn.
#[derive(Clone, Debug)]
struct SeenTrail {
    trail: Trail,
    /// The spots that are left.
    spots: Range<usize>,
    /// Distance of the middle of the trail's way in its first tic, and what a tic adds, 16.16.
    distance: i64,
    step: i64,
    /// Silhouettes may hide some of it.
    hidden: bool,
}

/// What a square covers of the frame.
#[derive(Clone, Copy, Default, Debug)]
struct Spot {
    tic: u32,
    columns: [u16; 2],
    rows: [i16; 2],
    /// Of its middle.
    height: Fixed,
    colour: u8,
    opacity: u8,
}

impl SeenTrails {
    /// Works out what squares cover if nothing hides them.
    pub fn collect(&mut self, scene: &Scene, view: &View, camera: &Camera, world: &World) {
        self.list.clear();
        self.spots.clear();
        for trail in world.trails.iter().filter(|trail| !trail.tics(world.tic).is_empty()) {
            let light = Light::new(camera, i32::from(world.sector(trail.sector).light));
            self.left.clear();
            trail.list(world.tic, &mut self.left);
            let first = self.spots.len();
            let mut end = first;
            self.spots.resize(first + self.left.len(), Spot::default());
            for shed in &self.left {
                // Which are in view cannot be foretold: all are written, and those counted.
                let (spot, is_seen) = spot(scene, view, camera, light, shed.tic, &trail.square(shed, world.tic));
                self.spots[end] = spot;
                end += usize::from(is_seen);
            }
            self.spots.truncate(end);
            self.list.push(SeenTrail::new(camera, trail, first..end));
        }
    }
}

impl SeenTrail {
    fn new(camera: &Camera, trail: &Trail, spots: Range<usize>) -> SeenTrail {
        let forward = |tic: u32| {
            let [x, y, _] = trail.middle(tic);
            camera.edges(i64::from(x.0), i64::from(y.0)).iter().sum::<i64>() / 2
        };
        let distance = forward(trail.begun);
        let step = forward(trail.begun + 1) - distance;
        SeenTrail { trail: trail.clone(), spots, distance, step, hidden: true }
    }

    /// Distance of the squares of a tic.
    fn away(&self, tic: u32) -> i64 {
        self.distance + i64::from(tic - self.trail.begun) * self.step
    }

    /// The spots of the farthest tic that is left, if it is farther away than a distance; they are left no more.
    fn next_beyond(&mut self, spots: &[Spot], distance: i64) -> Option<Range<usize>> {
        let Range { start, end } = self.spots;
        let (outwards, left) = (self.step > 0, &spots[start..end]);
        let tic = if outwards { left.last()? } else { left.first()? }.tic;
        if self.away(tic) <= distance {
            return None;
        }
        let next = if outwards {
            end - left.iter().rev().take_while(|spot| spot.tic == tic).count()..end
        } else {
            start..start + left.iter().take_while(|spot| spot.tic == tic).count()
        };
        self.spots = if outwards { start..next.start } else { next.end..end };
        Some(next)
    }

    /// What decides what hides some spots that are as far away as those of a tic.
    fn extent(&self, spots: &[Spot], tic: u32) -> Extent {
        let [x, y, _] = self.trail.middle(tic).map(|part| i64::from(part.0));
        let inverse = (1 << (INVERSE_BITS + 16)) / self.away(tic).max(NEAREST);
        let bounds = spots.iter().fold((u16::MAX, 0, Fixed(i32::MIN), Fixed(i32::MAX)), |(first, end, top, bottom), spot| {
            (first.min(spot.columns[0]), end.max(spot.columns[1]), top.max(spot.height), bottom.min(spot.height))
        });
        let (first, end, top, bottom) = bounds;
        Extent { inverse, x, y, top, bottom, first: usize::from(first), end: usize::from(end) }
    }
}

impl Masked<'_> {
    /// Finds the trails of which silhouettes may hide something: nothing is before most.
    pub fn meet_trails(&mut self) {
        let SeenTrails { list, spots, .. } = &mut *self.trails;
        for seen in list {
            let spots = &spots[seen.spots.clone()];
            if let [first, .., last] = spots {
                let farthest = if seen.step > 0 { last.tic } else { first.tic };
                let extent = seen.extent(spots, farthest);
                seen.hidden = self.silhouettes.meet(self.simd, extent.first, extent.end, extent.inverse) > 0;
            }
        }
    }

    /// Draws the squares that are farther away than a distance, 16.16, and were not drawn yet. Depth and labels tell nothing of them.
    pub fn squares_beyond<const DEPTH: bool, const CLASS: bool>(&mut self, distance: i64) {
        for index in 0..self.trails.list.len() {
            while let Some(spots) = self.trails.list[index].next_beyond(&self.trails.spots, distance) {
                self.squares::<DEPTH, CLASS>(index, spots);
            }
        }
    }

    /// Draws the squares that a rocket shed in a tic.
    fn squares<const DEPTH: bool, const CLASS: bool>(&mut self, index: usize, spots: Range<usize>) {
        let seen = &self.trails.list[index];
        if !seen.hidden {
            spots.for_each(|spot| self.cover(spot, |_, rows| rows));
            return;
        }
        let extent = seen.extent(&self.trails.spots[spots.clone()], self.trails.spots[spots.start].tic);
        self.columns.open(0..self.view.view_rows as i16, (extent.first..extent.end).map(|_| 0));
        self.narrow::<DEPTH, CLASS>(&extent);
        let columns = std::mem::take(self.columns);
        let open = |column: usize, [top, bottom]: [i16; 2]| {
            let own = column - extent.first;
            [top.max(columns.tops[own]), bottom.min(columns.bottoms[own])]
        };
        spots.for_each(|spot| self.cover(spot, open));
        *self.columns = columns;
    }

    /// Mixes the colour of a spot into the rows that `open` leaves of each of its columns.
    #[inline]
    fn cover(&mut self, spot: usize, open: impl Fn(usize, [i16; 2]) -> [i16; 2]) {
        let (width, spot) = (self.frame.width, self.trails.spots[spot]);
        for column in usize::from(spot.columns[0])..usize::from(spot.columns[1]) {
            let [top, bottom] = open(column, spot.rows);
            for row in top..bottom {
                let pixel = &mut self.frame.colour[row as usize * width + column];
                *pixel = self.scene.blend.over(spot.colour, *pixel, spot.opacity);
            }
        }
    }
}

/// What a square covers if nothing hides it, and whether that is anything: whole columns from that of its left edge to that before
/// its right one, and whole rows, that of its lower edge too.
#[inline(always)]
fn spot(scene: &Scene, view: &View, camera: &Camera, light: Light, tic: u32, square: &Square) -> (Spot, bool) {
    let [left, right] = camera.edges(i64::from(square.place[0].0), i64::from(square.place[1].0));
    let (away, across) = ((left + right) >> 1, (left - right) >> 1);
    let distance = away.max(NEAREST);
    let beside = across.abs() > distance + i64::from(square.half.0);
    // The published engine takes distances to 4096ths of a unit, and cuts their inverse to 65536ths: columns and rows of a unit follow
    // from that, so that what is far away is drawn nearer to the middle.
    let inverse = INVERSE_UNIT / (distance >> FINE);
    let width = i64::from(view.base_width);
    let half = i64::from(square.half.0);
    let column = |edge: i64| (((width << 16) + (((edge >> FINE) * width * inverse) >> (16 - FINE))) >> 17).clamp(0, width);
    let columns = [across - half, across + half].map(|edge| view.first_column[column(edge) as usize]);
    let rows_a_unit = (view.focal_y * inverse) >> 16;
    let above = i64::from(square.place[2].0) - camera.z;
    let row = |edge: i64| (camera.horizon - ((edge * rows_a_unit) >> 16)) >> 16;
    let frame_row = |row: i64| view.first_row[row.clamp(0, i64::from(view.base_view_rows)) as usize];
    let rows = [frame_row(row(above + half)), frame_row(row(above - half) + 1)];
    // Learners' frames leave out every fifth column and two rows of five.
    let is_seen = (away >= NEAREST) & !beside & (columns[0] < columns[1]) & (rows[0] < rows[1]);
    let table = light.table(ONE_TABLE * inverse);
    let colour = scene.assets.light_tables[table][usize::from(scene.shades[square.shade as usize])];
    (Spot { tic, columns, rows, height: square.place[2], colour, opacity: square.opacity }, is_seen)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::Assets;
    use crate::map::stone_room;
    use crate::math::Angle;
    use crate::render::{Buffers, FrameSize, Renderer, Scene, View};
    use crate::simd::Simd;
    use crate::world::{ActorKind, Chance};
    use std::sync::Arc;

    const SIZES: [FrameSize; 3] = [FrameSize::LEARNER, FrameSize::CLASSIC, FrameSize { width: 640, height: 480 }];

    /// A room whose eastern wall the player faces, and a trail northwards at a distance; its squares are of all ages.
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
        let scene = Arc::new(Scene::new(&world.map, Assets::embedded()));
        let mut renderer = Renderer::new(scene, Arc::new(View::new(size).unwrap()));
        renderer.set_simd(simd);
        renderer.render(world, 0, Buffers { depth: true, labels: true });
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
            let (plain, bare) = (shoot(&world, size, Simd::PLAIN), shoot(&without_trails(&world), size, Simd::PLAIN));
            let pixels = changed(&plain, &bare);
            // About 60 are in view, 0.75 units wide and high, and a row more.
            let side = 0.75 * f64::from(size.width) / 2.0 / 128.0;
            let expected =
                if size.width < 640 { 20..140 } else { (40.0 * side * side) as usize..(160.0 * (side + 1.0).powi(2)) as usize };
            assert!(expected.contains(&pixels), "{pixels} pixels, not {expected:?}, at {size:?}");
            assert_eq!(plain.rest, bare.rest, "depth and labels tell nothing of squares");
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
            let [with, without] = [&world, &without_trails(&world)].map(|world| shoot(world, size, Simd::PLAIN));
            assert_eq!(changed(&with, &without), 0, "behind the eastern wall");
        }
    }

    #[test]
    fn sprites_before_squares_hide_them_and_those_behind_do_not() {
        let mut world = world(128);
        let size = SIZES[2];
        let seen = |world: &World| changed(&shoot(world, size, Simd::PLAIN), &shoot(&without_trails(world), size, Simd::PLAIN));
        let alone = seen(&world);
        let id = world.spawn(ActorKind::BigTree, Fixed::from_int(200), Fixed::ZERO, Fixed::ZERO);
        // Where a square has the colour of what is behind it, it changes nothing.
        assert!(seen(&world).abs_diff(alone) <= alone / 10, "a tree behind them");
        world.get_mut(id).unwrap().x = Fixed::from_int(40);
        assert!(seen(&world) < alone * 9 / 10, "{} of {alone} past a tree before them", seen(&world));
    }

    #[test]
    fn what_flies_towards_the_eye_is_drawn_far_to_near_too() {
        let world = world(128);
        let sector = world.map.sector_at(Fixed::ZERO, Fixed::ZERO);
        let trail = |start: i32, speed: i32| {
            let place = [start, 30, 36].map(Fixed::from_int);
            Trail::new(world.players[0].actor, place, [speed, 0, 0].map(Fixed::from_int), 40, sector, Chance::Own(5))
        };
        let trails = [trail(40, 20), trail(240, -20)];
        for trail in trails {
            let mut left = Vec::new();
            trail.list(world.tic, &mut left);
            let spots: Vec<Spot> = left.iter().map(|shed| Spot { tic: shed.tic, ..Spot::default() }).collect();
            let mut seen = SeenTrail::new(&Camera { forward: [1 << 16, 0], ..Camera::default() }, &trail, 0..spots.len());
            let (mut last, mut tics, mut count) = (i64::MAX, 0, 0);
            while let Some(next) = seen.next_beyond(&spots, i64::MIN) {
                let tic = spots[next.start].tic;
                assert!(spots[next.clone()].iter().all(|spot| spot.tic == tic));
                let away = i64::from(trail.middle(tic)[0].0);
                assert!(away < last);
                (last, tics, count) = (away, tics + 1, count + next.len());
            }
            assert_eq!((tics, count), (10, spots.len()));
        }
    }
}
