//! Trails of rockets: small squares that a rocket sheds as it flies, which drift, fade and go.
//! Nothing in the world minds them: only pictures show them.
//!
//! A trail is where and when a rocket flew; no square is kept. Where each is, and whether it is
//! still there, follows from what chance gave it: draws of our own that take nothing from the
//! world's randomness, or those that ViZDoom is known to have made. What is drawn, and
//! what follows from it, was measured there (docs/results/pixels.md) and is the same here.

use crate::map::SectorId;
use crate::math::{Angle, Fixed, Rng};
use crate::world::parts::actor::ActorId;
use crate::world::tables::kinds::ActorKind;
use crate::world::tables::states::OPAQUE;
use std::ops::Range;
use std::sync::Arc;

/// Squares that a rocket sheds in a tic, the first of them yellow.
pub const SQUARES: u32 = 7;

/// Fewest tics that a square is seen; any up to 31 more are as likely.
const SHORTEST_LIFE: u32 = 3;

/// Most tics that a square is seen.
pub(in crate::world) const LONGEST_LIFE: u32 = SHORTEST_LIFE + 31;

// What chance gives is whole numbers below 256; a part of each of them is, 16.16:

/// Of what puts grey squares above the trail, up to 4 map units; yellow ones begin on it.
const UP: i32 = 1 << 10;
/// Of the drift along each axis, map units a tic, 128 being none.
const DRIFT: i32 = 1 << 4;
/// Of what is added to that drift, map units a tic and tic, 128 being nothing.
const PULL: i32 = 1 << 2;
/// Of the drift to either side of the way, a 200th of a map unit a tic, 128 being none.
const ASIDE: i32 = (1 << 16) / 200;

/// How fast grey squares rise at first and yellow ones sink, and what a tic adds to that, map units
/// a tic, 16.16.
const RISE: [i32; 2] = [(1 << 16) / 80, (1 << 16) / 40];
const SINK: [i32; 2] = [(1 << 16) / 36, (1 << 16) / 20];

/// Where a rocket flew, straight on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Trail {
    /// The rocket.
    pub rocket: ActorId,
    /// The trail's point after the first tic of flight: twice the rocket's radius behind it, at two
    /// thirds of its height. East, north and up.
    point: [Fixed; 3],
    /// The rocket's velocity, map units a tic.
    velocity: [Fixed; 3],
    /// Cosine and sine of its way over the map.
    way: [Fixed; 2],
    /// The first tic of flight.
    pub begun: u32,
    /// One past the last, [`Trail::FLYING`] until it is known; in the tic in which it bursts, a
    /// rocket sheds nothing.
    pub ended: u32,
    /// Where the rocket was thrown: squares are lit by its light.
    pub sector: SectorId,
    chance: Chance,
}

/// What decides about the squares of a trail.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Chance {
    /// Draws of our own that hang on a number.
    Own(u64),
    /// The draws of each tic of flight, the yellow square's first.
    Given(Arc<[[Lots; SQUARES as usize]]>),
}

/// What chance gives a square.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lots {
    /// Tics that it is seen, less the fewest; its lowest five bits count.
    pub life: u8,
    /// A grey one is dark.
    pub dark: bool,
    /// Its drift east, north and up at first.
    pub drift: [u8; 3],
    /// What every tic adds to that.
    pub pull: [u8; 3],
    /// How far back on the tic's way it appears, in 256ths of it.
    pub back: u8,
    /// How far above; of grey ones.
    pub up: u8,
    /// Its drift to either side of the way.
    pub aside: u8,
}

impl Lots {
    /// What a tic's squares get of ViZDoom's draws, which it makes in this order, the
    /// yellow square first.
    pub fn of_tic(mut draw: impl FnMut() -> u8) -> [Lots; SQUARES as usize] {
        std::array::from_fn(|index| {
            let (is_grey, life) = (index > 0, draw());
            let [drift, pull] = [(); 2].map(|()| [(); 3].map(|()| draw()));
            let (back, up, aside) = (draw(), if is_grey { draw() } else { 0 }, draw());
            Lots { life, dark: is_grey && draw() & 7 == 0, drift, pull, back, up, aside }
        })
    }

    /// From two random numbers, of the first of which all eight bits count.
    #[inline(always)]
    fn of(lot: u8, draw: u64) -> Lots {
        let [east, north, height, back, up, aside, rise, pull] = draw.to_le_bytes();
        let pull = [pull << 4 | 8, pull & 0xF0 | 8, rise];
        Lots { life: lot, dark: lot >> 5 == 0, drift: [east, north, height], pull, back, up, aside }
    }
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
    is_yellow: bool,
    lots: Lots,
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

impl Trail {
    /// The end of a trail whose rocket still flies.
    pub const FLYING: u32 = u32::MAX;

    /// The trail of a rocket that is at `place` after its first tic of flight, `begun`, and goes on
    /// by `velocity` a tic; lit as `sector` is.
    #[must_use]
    pub fn new(
        rocket: ActorId,
        place: [Fixed; 3],
        velocity: [Fixed; 3],
        begun: u32,
        sector: SectorId,
        chance: Chance,
    ) -> Trail {
        let ([x, y, z], way, kind) =
            (place, Angle::of_slope(velocity[0], velocity[1]), ActorKind::Rocket);
        let (way, behind) = ([way.cos(), way.sin()], kind.radius() * 2);
        let point = [x - behind * way[0], y - behind * way[1], z + kind.height().scale(2, 3)];
        Trail { rocket, point, velocity, way, begun, ended: Trail::FLYING, sector, chance }
    }

    /// How far the rocket goes along an axis in so many 256ths of a tic.
    #[inline(always)]
    fn way_in(&self, axis: usize, parts: i64) -> i32 {
        ((i64::from(self.velocity[axis].0) * parts) >> 8) as i32
    }

    /// The tics of flight of which squares may be left when `now` tics are over.
    #[must_use]
    pub fn tics(&self, now: u32) -> Range<u32> {
        self.begun.max(now.saturating_sub(LONGEST_LIFE))..self.ended.min(now)
    }

    /// Adds the squares that are left when `now` tics are over to a list, the oldest first.
    pub fn list(&self, now: u32, left: &mut Vec<Shed>) {
        match &self.chance {
            Chance::Own(key) => self.list_own(*key, now, left),
            Chance::Given(lots) => {
                let tics = self.tics(now);
                for (tic, lots) in
                    tics.clone().zip(lots.iter().skip((tics.start - self.begun) as usize))
                {
                    let shed = (0..).zip(lots).map(|(index, &lots)| Shed {
                        tic,
                        is_yellow: index == 0,
                        lots,
                    });
                    left.extend(shed.filter(|shed| now - 1 - tic < shed.life()));
                }
            }
        }
    }

    fn list_own(&self, key: u64, now: u32, left: &mut Vec<Shed>) {
        let (tics, mut count) = (self.tics(now), left.len());
        left.resize(
            count + SQUARES as usize * tics.len(),
            Shed { tic: 0, is_yellow: false, lots: Lots::of(0, 0) },
        );
        for tic in tics {
            // A stream of draws for each tic: the first number says how long each square lives
            // and its shade.
            let mut draws = Rng::from_state(
                key.wrapping_add(u64::from(tic).wrapping_mul(0xD1B5_4A32_D192_ED03)),
            );
            let (first, age) = (draws.next_u64().to_le_bytes(), now - 1 - tic);
            for (index, &lot) in first[..SQUARES as usize].iter().enumerate() {
                let shed =
                    Shed { tic, is_yellow: index == 0, lots: Lots::of(lot, draws.next_u64()) };
                // Which are left cannot be predicted: all are written, and those counted.
                left[count] = shed;
                count += usize::from(age < shed.life());
            }
        }
        left.truncate(count);
    }

    /// Where a square is when `now` tics are over.
    #[inline(always)]
    #[must_use]
    pub fn square(&self, shed: &Shed, now: u32) -> Square {
        let &Shed { tic, is_yellow, lots } = shed;
        let age = (now - 1 - tic) as i32;
        let parts = (i64::from(tic - self.begun) << 8) - i64::from(lots.back);
        // What was added in the first tic has moved it in all but that one, and so on.
        let (middle, added) = (|lot: u8| i32::from(lot) - 128, age * (age - 1) / 2);
        let drift = |axis: usize| {
            middle(lots.drift[axis]) * DRIFT * age + middle(lots.pull[axis]) * PULL * added
        };
        let aside = middle(lots.aside) * ASIDE * age;
        let part = |of: i32, unit: Fixed| ((i64::from(of) * i64::from(unit.0)) >> 16) as i32;
        let up = if is_yellow {
            -SINK[0] * age - SINK[1] * added
        } else {
            i32::from(lots.up) * UP + RISE[0] * age + RISE[1] * added
        };
        let [cos, sin] = self.way;
        let place = [
            self.point[0] + Fixed(self.way_in(0, parts) + drift(0) - part(aside, sin)),
            self.point[1] + Fixed(self.way_in(1, parts) + drift(1) + part(aside, cos)),
            self.point[2] + Fixed(self.way_in(2, parts) + drift(2) + up),
        ];
        // Evenly to nothing, in steps of a 256th, and shown to a 64th.
        let opacity = ((256 - FADES[shed.life() as usize] * age) >> 2) as u8 * (OPAQUE / 64);
        let half = if is_yellow { Fixed::ONE.scale(1, 4) } else { Fixed::ONE.scale(3, 8) };
        Square { place, half, shade: shed.shade(), opacity }
    }
}

impl Shed {
    /// Tics that it is seen.
    #[inline(always)]
    fn life(&self) -> u32 {
        SHORTEST_LIFE + u32::from(self.lots.life & 31)
    }

    #[inline(always)]
    fn shade(&self) -> Shade {
        match (self.is_yellow, self.lots.dark) {
            (true, _) => Shade::Yellow,
            (false, true) => Shade::Dark,
            (false, false) => Shade::Light,
        }
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
mod tests;
