//! Trails of rockets: small squares that a rocket sheds as it flies, which drift, fade and go. Nothing in the world minds them:
//! only pictures show them.
//!
//! A trail is where and when a rocket flew; no square is kept. Where each is, and whether it is still there, follows from its
//! number, by draws of its own that take nothing from the world's randomness. Where the published engine's squares are is
//! told by nothing; how many, how they look and how they move was measured there (docs/results/pixels.md) and is the same here.

use super::{ActorId, OPAQUE, Phase, World};
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

/// A 15th of the fastest drift along each axis, a twelfth of a map unit a tic, and of what a tic adds to it at most, a hundredth.
/// Both are differences of two draws from 0 to 15: slow ones are more frequent.
const DRIFT: i32 = Fixed::ONE.scale(1, 12 * 15).0;
const DRIFT_GAIN: i32 = Fixed::ONE.scale(1, 100 * 15).0;

/// What a tic adds to the rise of grey squares and to that of yellow ones, map units a tic.
const RISES: [Fixed; 2] = [Fixed::ONE.scale(252, 10_000), Fixed::ONE.scale(-508, 10_000)];

/// The end of a trail whose rocket still flies.
const FLYING: u32 = u32::MAX;

/// Where a rocket flew, straight on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Trail {
    /// The rocket.
    pub rocket: ActorId,
    /// The trail's point after the first tic of flight: behind the rocket, at two thirds of its height. East, north and up.
    pub point: [Fixed; 3],
    /// The rocket's velocity, map units a tic.
    pub velocity: [Fixed; 3],
    /// The first tic of flight.
    pub begun: u32,
    /// One past the last; in the tic in which it bursts, a rocket sheds nothing.
    ended: u32,
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
        let (way, behind) = (Angle::of_vector(rocket.vx, rocket.vy), rocket.radius * 2);
        let velocity = [rocket.vx, rocket.vy, rocket.vz];
        let start = [rocket.x - behind * way.cos(), rocket.y - behind * way.sin(), rocket.z + rocket.height.scale(2, 3)];
        self.trails.push(Trail {
            rocket: self.id_of(slot),
            point: [0, 1, 2].map(|axis| start[axis] + velocity[axis]),
            velocity,
            begun: tic,
            ended: FLYING,
            sector: rocket.sector,
            // Told apart by what the world has drawn so far, which goes on as if nobody had looked.
            key: Rng::for_lane(self.rng.state(), u64::from(tic)).state(),
        });
    }

    /// The rocket of a slot, or whatever is in it, flies no more.
    pub(super) fn end_trail(&mut self, slot: usize) {
        let (id, tic) = (self.id_of(slot), self.tic);
        if let Some(trail) = self.trails.iter_mut().find(|trail| trail.rocket == id && trail.ended == FLYING) {
            trail.ended = tic;
        }
    }
}

impl Trail {
    /// The tics of flight of which squares may be left when `now` tics are over.
    #[must_use]
    pub fn tics(&self, now: u32) -> Range<u32> {
        self.begun.max(now.saturating_sub(LONGEST_LIFE))..self.ended.min(now)
    }

    /// The squares of those shed in a tic of flight that are left when `now` tics are over.
    #[inline]
    pub fn squares(&self, tic: u32, now: u32) -> impl Iterator<Item = Square> {
        // A stream of draws for each tic: the first number tells of every square how long it lives and its shade.
        let mut draws = Rng::from_state(self.key.wrapping_add(u64::from(tic).wrapping_mul(0xD1B5_4A32_D192_ED03)));
        let (mut lots, age) = (draws.next_u64(), now - 1 - tic);
        (0..SQUARES).filter_map(move |index| {
            let (life, shade) = (SHORTEST_LIFE + (lots & 31) as u32, lots >> 5 & 7);
            lots >>= 8;
            let draw = draws.next_u64();
            (age < life).then(|| {
                let shade = match shade {
                    _ if index == 0 => Shade::Yellow,
                    0 => Shade::Dark,
                    _ => Shade::Light,
                };
                self.square(tic, age, life, shade, draw)
            })
        })
    }

    /// A square of an age in tics, by a draw.
    #[inline]
    fn square(&self, tic: u32, age: u32, life: u32, shade: Shade, mut draw: u64) -> Square {
        let mut take = |bits: u32| {
            let taken = (draw & ((1 << bits) - 1)) as i32;
            draw >>= bits;
            taken
        };
        let yellow = shade == Shade::Yellow;
        // Anywhere on the way of its tic, in 128ths, and at most as far above it as squares spread, in 64ths.
        let from_first = (i64::from(tic - self.begun) << 7) - i64::from(take(7));
        let above = take(6) * (SPREAD.0 >> 6);
        let mut difference = || take(4) - take(4);
        let age = age as i32;
        let mut place = [0, 1, 2].map(|axis| {
            let (drift, gain) = (difference() * DRIFT, difference() * DRIFT_GAIN);
            let along = Fixed((i64::from(self.velocity[axis].0) * from_first >> 7) as i32);
            self.point[axis] + along + Fixed(drift * age + gain * age * age / 2)
        });
        place[2] = place[2] + Fixed(if yellow { 0 } else { above } + RISES[usize::from(yellow)].0 * age * age / 2);
        // Evenly to nothing, in steps of a 256th, and shown to a 64th.
        let opacity = ((256 - 255 / life as i32 * age) >> 2) as u8;
        let half = Fixed::ONE.scale(if yellow { 2 } else { 3 }, 8);
        Square { place, half, shade, opacity: opacity * (OPAQUE / 64) }
    }
}
