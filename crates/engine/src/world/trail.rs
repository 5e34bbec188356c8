//! Trails of rockets: small squares that a rocket sheds as it flies, which drift, fade and go. Nothing in the world minds them:
//! only pictures show them.
//!
//! A trail is where and when a rocket flew; no square is kept. Where each is, and whether it is still there, follows from its
//! number, by draws of its own that take nothing from the world's randomness. Where the published engine's squares are is
//! told by nothing; how many, how they look and how they move was measured there (docs/results/pixels.md) and is the same here.

use super::{ActorId, ActorKind, OPAQUE, Phase, World};
use crate::map::SectorId;
use crate::math::{Angle, Fixed, Rng};
use std::ops::Range;

/// Squares that a rocket sheds in a tic, the first of them yellow.
pub const SQUARES: u32 = 7;

/// Fewest tics that a square is seen; any up to 31 more are as likely.
const SHORTEST_LIFE: u32 = 3;

/// Most tics that a square is seen.
const LONGEST_LIFE: u32 = SHORTEST_LIFE + 31;

/// Grey squares appear up to so much above the trail, map units; yellow ones on it.
const SPREAD: Fixed = Fixed::from_int(4);

/// Fastest drift to either side of the way, map units a tic. Of grey squares all speeds are as likely; of yellow ones, the mean of
/// two draws, slow ones are likelier.
const DRIFT: Fixed = Fixed::ONE.scale(6, 10);

/// Fastest drift along the way and up at first, and what a tic's rise or fall has more or less than others' at most, map units a tic.
/// Differences of two draws: slow ones are likelier.
const SLOW_DRIFT: Fixed = Fixed::ONE.scale(1, 20);
const RISE_SPREAD: Fixed = Fixed::ONE.scale(1, 90);

/// What a tic adds to the rise of grey squares and to that of yellow ones, map units a tic.
const RISES: [Fixed; 2] = [Fixed::ONE.scale(252, 10_000), Fixed::ONE.scale(-508, 10_000)];

/// Where a rocket flew, straight on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Trail {
    /// The rocket.
    pub rocket: ActorId,
    /// The trail's point after the first tic of flight: twice the rocket's radius behind it, at two thirds of its height. East, north
    /// and up.
    point: [Fixed; 3],
    /// The rocket's velocity, map units a tic.
    velocity: [Fixed; 3],
    /// Cosine and sine of its way over the map.
    way: [Fixed; 2],
    /// The first tic of flight.
    pub begun: u32,
    /// One past the last, [`Trail::FLYING`] until it is known; in the tic in which it bursts, a rocket sheds nothing.
    pub ended: u32,
    /// Where the rocket was thrown: squares are lit by its light.
    pub sector: SectorId,
    /// What the draws hang on.
    key: u64,
}

/// What colour a square has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shade {
    /// Light grey: seven of eight grey ones.
    Light,
    /// Dark grey.
    Dark,
    /// Yellow.
    Yellow,
}

/// A square that is left of a trail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shed {
    /// The tic of flight in which it appeared.
    pub tic: u32,
    /// Tics that it is seen.
    life: u8,
    shade: Shade,
    /// What all else follows from.
    draw: u64,
}

/// A square as it is in a tic; it always faces the eye.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Square {
    /// Its middle: east, north and up, map units.
    pub place: [Fixed; 3],
    /// Half its side, map units.
    pub half: Fixed,
    /// Its colour.
    pub shade: Shade,
    /// How much of it hides what is behind, in parts of [`OPAQUE`].
    pub opacity: u8,
}

impl World {
    /// A rocket that was just thrown begins its trail, if rockets have any here.
    pub(super) fn begin_trail(&mut self, slot: usize) {
        if !self.rockets_shed || self.actors[slot].phase == Phase::Death {
            return;
        }
        let tic = self.tic;
        self.trails.retain(|trail| trail.ended.saturating_add(LONGEST_LIFE) > tic);
        let rocket = &self.actors[slot];
        let velocity = [rocket.vx, rocket.vy, rocket.vz];
        let place = [rocket.x + rocket.vx, rocket.y + rocket.vy, rocket.z + rocket.vz];
        // Told apart by what the world has drawn so far, which goes on as if nobody had looked.
        let key = Rng::for_lane(self.rng.state(), u64::from(tic)).state();
        let trail = Trail::new(self.id_of(slot), place, velocity, tic, rocket.sector, key);
        self.trails.push(trail);
    }

    /// The rocket of a slot, or whatever is in it, flies no more.
    pub(super) fn end_trail(&mut self, slot: usize) {
        let (id, tic) = (self.id_of(slot), self.tic);
        if let Some(trail) = self.trails.iter_mut().find(|trail| trail.rocket == id && trail.ended == Trail::FLYING) {
            trail.ended = tic;
        }
    }
}

impl Trail {
    /// The end of a trail whose rocket still flies.
    pub const FLYING: u32 = u32::MAX;

    /// The trail of a rocket that is at `place` after its first tic of flight, `begun`, and goes on by `velocity` a tic; lit as
    /// `sector` is, with squares that hang on `key`.
    #[must_use]
    pub fn new(rocket: ActorId, place: [Fixed; 3], velocity: [Fixed; 3], begun: u32, sector: SectorId, key: u64) -> Trail {
        let ([x, y, z], way, kind) = (place, Angle::of_vector(velocity[0], velocity[1]), ActorKind::Rocket);
        let (way, behind) = ([way.cos(), way.sin()], kind.radius() * 2);
        let point = [x - behind * way[0], y - behind * way[1], z + kind.height().scale(2, 3)];
        Trail { rocket, point, velocity, way, begun, ended: Trail::FLYING, sector, key }
    }

    /// The middle of the way on which the squares of a tic of flight appeared: east, north and up.
    #[must_use]
    pub fn middle(&self, tic: u32) -> [Fixed; 3] {
        [0, 1, 2].map(|axis| self.point[axis] + Fixed(self.way_in(axis, (i64::from(tic - self.begun) << 7) - 64)))
    }

    /// How far the rocket goes along an axis in so many 128ths of a tic.
    #[inline(always)]
    fn way_in(&self, axis: usize, parts: i64) -> i32 {
        ((i64::from(self.velocity[axis].0) * parts) >> 7) as i32
    }

    /// The tics of flight of which squares may be left when `now` tics are over.
    #[must_use]
    pub fn tics(&self, now: u32) -> Range<u32> {
        self.begun.max(now.saturating_sub(LONGEST_LIFE))..self.ended.min(now)
    }

    /// Adds the squares that are left when `now` tics are over to a list, the oldest first.
    pub fn list(&self, now: u32, left: &mut Vec<Shed>) {
        let (tics, mut count) = (self.tics(now), left.len());
        left.resize(count + SQUARES as usize * tics.len(), Shed { tic: 0, life: 0, shade: Shade::Light, draw: 0 });
        for tic in tics {
            // A stream of draws for each tic: the first number tells of every square how long it lives and its shade.
            let mut draws = Rng::from_state(self.key.wrapping_add(u64::from(tic).wrapping_mul(0xD1B5_4A32_D192_ED03)));
            let (mut lots, age) = (draws.next_u64(), now - 1 - tic);
            for index in 0..SQUARES {
                let (draw, life, lot) = (draws.next_u64(), SHORTEST_LIFE + (lots & 31) as u32, lots >> 5 & 7);
                lots >>= 8;
                let grey = if lot == 0 { Shade::Dark } else { Shade::Light };
                let shade = if index == 0 { Shade::Yellow } else { grey };
                // Which are left cannot be foretold: all are written, and those counted.
                left[count] = Shed { tic, life: life as u8, shade, draw };
                count += usize::from(age < life);
            }
        }
        left.truncate(count);
    }

    /// Where a square is when `now` tics are over.
    #[inline(always)]
    #[must_use]
    pub fn square(&self, &Shed { tic, life, shade, draw }: &Shed, now: u32) -> Square {
        let (age, life) = ((now - 1 - tic) as i32, i32::from(life));
        let lot = |from: u32, bits: u32| (draw >> from & ((1 << bits) - 1)) as i32;
        let difference = |from: u32| lot(from, 4) - lot(from + 4, 4);
        let yellow = shade == Shade::Yellow;
        // Anywhere on the way of its tic, in 128ths, and above it up to the whole spread, in 64ths.
        let parts = (i64::from(tic - self.begun) << 7) - i64::from(lot(0, 7));
        let above = if yellow { 0 } else { lot(7, 6) * (SPREAD.0 >> 6) };
        let sideways = if yellow { lot(13, 8) + lot(21, 8) - 255 } else { 2 * lot(13, 8) - 255 } * (DRIFT.0 / 255) * age;
        let onwards = difference(29) * (SLOW_DRIFT.0 / 15) * age;
        let rise = RISES[usize::from(yellow)].0 + difference(37) * (RISE_SPREAD.0 / 15);
        let up = difference(45) * (SLOW_DRIFT.0 / 15) * age + rise * age * age / 2;
        let part = |of: i32, unit: Fixed| ((i64::from(of) * i64::from(unit.0)) >> 16) as i32;
        let [cos, sin] = self.way;
        let place = [
            self.point[0] + Fixed(self.way_in(0, parts) + part(onwards, cos) - part(sideways, sin)),
            self.point[1] + Fixed(self.way_in(1, parts) + part(onwards, sin) + part(sideways, cos)),
            self.point[2] + Fixed(self.way_in(2, parts) + above + up),
        ];
        // Evenly to nothing, in steps of a 256th, and shown to a 64th.
        let opacity = ((256 - FADES[life as usize] * age) >> 2) as u8 * (OPAQUE / 64);
        let half = if yellow { Fixed::ONE.scale(1, 4) } else { Fixed::ONE.scale(3, 8) };
        Square { place, half, shade, opacity }
    }
}

/// What a tic takes of a square's 256 parts, by the tics of its life.
const FADES: [i32; LONGEST_LIFE as usize + 1] = {
    let mut list = [255; LONGEST_LIFE as usize + 1];
    let mut life = 1;
    while life < list.len() {
        list[life] = 255 / life as i32;
        life += 1;
    }
    list
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::stone_room;

    /// A world in which a player far from the eastern wall throws a rocket at it, a number of tics after.
    fn flight(shed: bool, tics: u32) -> World {
        let mut world = World::new(stone_room(200, [-64, -256, 4000, 256], &[[0.0, 0.0]]), 7);
        world.rockets_shed = shed;
        world.throw_missile(0, ActorKind::Rocket);
        world.finish_tic();
        for _ in 0..tics {
            world.run_thinkers(&[]);
            world.finish_tic();
        }
        world
    }

    fn squares(world: &World) -> Vec<(u32, Square)> {
        let mut seen = Vec::new();
        for trail in &world.trails {
            let mut left = Vec::new();
            trail.list(world.tic, &mut left);
            seen.extend(left.iter().map(|shed| (world.tic - 1 - shed.tic, trail.square(shed, world.tic))));
        }
        seen
    }

    #[test]
    fn as_many_squares_fly_as_in_the_original_and_as_old() {
        let (mut count, mut worlds) = ([0; 3], 0);
        let mut ages = [0; LONGEST_LIFE as usize];
        for tics in 40..160 {
            let world = flight(true, tics);
            for (age, square) in squares(&world) {
                count[square.shade as usize] += 1;
                ages[age as usize] += 1;
            }
            worlds += 1;
        }
        // Measured: seven a tic, one of them yellow, an eighth of the others dark; all lives from 3 to 34 tics as often.
        let all: i32 = count.iter().sum();
        assert!((all - worlds * 259 / 2).abs() < worlds * 4, "{all} in {worlds} worlds");
        assert!((all - count[Shade::Yellow as usize] * 7).abs() < all / 10, "{count:?}");
        assert!((all - count[Shade::Yellow as usize] - count[Shade::Dark as usize] * 8).abs() < all / 10, "{count:?}");
        assert!(ages[..3].iter().all(|&age| age == worlds * SQUARES as i32), "{ages:?}");
        for (age, &number) in ages.iter().enumerate().skip(3) {
            let left = 7 * worlds * (LONGEST_LIFE as i32 - age as i32) / 32;
            assert!((number - left).abs() <= 12 + left / 5, "{number} of age {age}, not {left}");
        }
    }

    #[test]
    fn squares_appear_behind_the_rocket_and_drift_as_measured() {
        let world = flight(true, 100);
        let rocket = world.actors.iter().find(|actor| actor.kind == ActorKind::Rocket).unwrap();
        let (mut aside, mut rises) = (Vec::new(), Vec::new());
        for (age, square) in squares(&world) {
            let [x, y, z] = square.place.map(Fixed::to_f64);
            let [behind, above] = [rocket.x.to_f64() - x - 20.0 * f64::from(age), z - rocket.z.to_f64()];
            assert!((20.0..=44.0).contains(&behind), "{behind} behind at age {age}");
            if age == 0 {
                assert_eq!((y, square.opacity), (0.0, OPAQUE));
                assert!((5.3..9.4).contains(&above) && (square.shade != Shade::Yellow || above < 5.4), "{square:?}");
            } else {
                aside.push(y / f64::from(age));
            }
            if age == 20 && square.shade != Shade::Yellow {
                rises.push(above - 7.3);
            }
        }
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let spread = (aside.iter().map(|v| v * v).sum::<f64>() / aside.len() as f64).sqrt();
        assert!(mean(&aside).abs() < 0.08 && (0.28..0.39).contains(&spread), "{} {spread}", mean(&aside));
        assert!(rises.is_empty() || (1.0..9.0).contains(&mean(&rises)), "{rises:?}");
    }

    #[test]
    fn only_pictures_mind_them() {
        for tics in [0, 30, 150, 260] {
            let (with, without) = (flight(true, tics), flight(false, tics));
            assert_eq!((with.state_hash(), &with.rng), (without.state_hash(), &without.rng));
            assert!(without.trails.is_empty() && with.trails.len() == 1);
            assert_eq!(squares(&with.clone()), squares(&with));
        }
    }

    #[test]
    fn a_trail_ends_where_its_rocket_bursts_and_fades() {
        let burst =
            |world: &World| world.actors.iter().all(|actor| actor.kind != ActorKind::Rocket || actor.phase == Phase::Death);
        let mut world = flight(true, 0);
        for _ in 0..300 {
            if burst(&world) {
                break;
            }
            world.run_thinkers(&[]);
            world.finish_tic();
        }
        let ended = world.trails[0].ended;
        assert_eq!(ended, world.tic - 1);
        assert!(squares(&world).iter().all(|&(age, _)| age > 0) && !squares(&world).is_empty());
        world.tic += LONGEST_LIFE;
        assert!(squares(&world).is_empty());
        world.trails.retain(|trail| trail.ended.saturating_add(LONGEST_LIFE) > world.tic);
        assert!(world.trails.is_empty());
    }
}
