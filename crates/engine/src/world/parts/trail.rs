//! Trails of rockets: small squares that a rocket sheds as it flies, which drift, fade and go.
//! Nothing in the world minds them: only pictures show them.
//!
//! A trail is where and when a rocket flew; no square is kept. Where each is, and whether it is
//! still there, follows from what chance gave it: draws of our own that take nothing from the
//! world's randomness, or those that the published engine is known to have made. What is drawn, and
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
    Told(Arc<[[Lots; SQUARES as usize]]>),
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
    /// What a tic's squares get of the published engine's draws, which it makes in this order, the
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
            Chance::Told(lots) => {
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
            // A stream of draws for each tic: the first number tells of every square how long it
            // lives and its shade.
            let mut draws = Rng::from_state(
                key.wrapping_add(u64::from(tic).wrapping_mul(0xD1B5_4A32_D192_ED03)),
            );
            let (first, age) = (draws.next_u64().to_le_bytes(), now - 1 - tic);
            for (index, &lot) in first[..SQUARES as usize].iter().enumerate() {
                let shed =
                    Shed { tic, is_yellow: index == 0, lots: Lots::of(lot, draws.next_u64()) };
                // Which are left cannot be foretold: all are written, and those counted.
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
mod tests {
    use super::*;
    use crate::map::stone_room;
    use crate::world::state::world::World;
    use crate::world::tables::states::Phase;

    /// A world in which a player far from the eastern wall throws a rocket at it, a number of tics
    /// after.
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
            seen.extend(
                left.iter().map(|shed| (world.tic - 1 - shed.tic, trail.square(shed, world.tic))),
            );
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
        // Measured: seven a tic, one of them yellow, an eighth of the others dark; all lives from 3
        // to 34 tics as often.
        let all: i32 = count.iter().sum();
        assert!((all - worlds * 259 / 2).abs() < worlds * 4, "{all} in {worlds} worlds");
        assert!((all - count[Shade::Yellow as usize] * 7).abs() < all / 10, "{count:?}");
        assert!(
            (all - count[Shade::Yellow as usize] - count[Shade::Dark as usize] * 8).abs()
                < all / 10,
            "{count:?}"
        );
        assert!(ages[..3].iter().all(|&age| age == worlds * SQUARES as i32), "{ages:?}");
        for (age, &number) in ages.iter().enumerate().skip(3) {
            let left = 7 * worlds * (LONGEST_LIFE as i32 - age as i32) / 32;
            assert!((number - left).abs() <= 12 + left / 5, "{number} of age {age}, not {left}");
        }
    }

    #[test]
    fn squares_appear_behind_the_rocket_and_drift_as_measured() {
        let (mut aside, mut rises) = (Vec::new(), Vec::new());
        let worlds = [40, 75, 110, 145].map(|tics| flight(true, tics));
        for (world, (age, square)) in worlds
            .iter()
            .flat_map(|world| squares(world).into_iter().map(move |seen| (world, seen)))
        {
            let rocket = world.actors.iter().find(|actor| actor.kind == ActorKind::Rocket).unwrap();
            let [x, y, z] = square.place.map(Fixed::to_f64);
            let [behind, above] =
                [rocket.x.to_f64() - x - 20.0 * f64::from(age), z - rocket.z.to_f64()];
            assert!((16.0..=48.0).contains(&behind), "{behind} behind at age {age}");
            if age == 0 {
                assert_eq!((y, square.opacity), (0.0, OPAQUE));
                assert!(
                    (5.3..9.4).contains(&above) && (square.shade != Shade::Yellow || above < 5.4),
                    "{square:?}"
                );
            } else {
                aside.push(y / f64::from(age));
            }
            if age == 20 && square.shade != Shade::Yellow {
                rises.push(above - 7.3);
            }
        }
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let spread = (aside.iter().map(|v| v * v).sum::<f64>() / aside.len() as f64).sqrt();
        assert!(
            mean(&aside).abs() < 0.08 && (0.28..0.39).contains(&spread),
            "{} {spread}",
            mean(&aside)
        );
        assert!(rises.is_empty() || (1.0..9.0).contains(&mean(&rises)), "{rises:?}");
    }

    /// In a bare room, of a rocket that flew across the view 60 units ahead: the bytes that its
    /// second tic drew, and the first column and row, width and height at 1600x1200 of what each
    /// square covered then and in the next three tics.
    #[test]
    fn squares_are_where_the_published_engine_had_them() {
        const DRAWS: [u8; 75] = [
            107, 69, 202, 58, 173, 98, 51, 125, 178, // the yellow one's
            254, 12, 60, 20, 186, 203, 50, 178, 204, 112, 186, 63, 9, 197, 185, 152, 170, 168, 127,
            215, 72, 52, 156, //
            182, 39, 106, 33, 234, 26, 236, 234, 225, 202, 0, 0, 240, 60, 229, 233, 177, 86, 111,
            243, 22, 199, 95, 103, //
            185, 88, 12, 88, 48, 255, 105, 89, 247, 18, 58, 137, 170, 183, 37, 211, 70, 134, 236,
        ];
        const SEEN: [&[[u16; 4]]; 7] = [
            &[[1353, 590, 7, 9], [1355, 591, 7, 9], [1357, 592, 7, 9], [1359, 595, 7, 9]],
            &[[1406, 537, 10, 13], [1406, 537, 10, 13], [1406, 537, 10, 13], [1405, 537, 10, 13]],
            &[[1353, 534, 10, 13], [1351, 534, 10, 13], [1348, 534, 10, 13], [1345, 533, 10, 13]],
            &[[1467, 530, 10, 13], [1472, 529, 10, 13], [1478, 528, 10, 13], [1483, 527, 11, 13]],
            &[[1311, 560, 10, 13], [1315, 560, 10, 13], [1320, 559, 10, 14]],
            &[[1271, 524, 10, 13], [1270, 524, 10, 13], [1270, 524, 10, 12], [1269, 523, 10, 12]],
            &[[1441, 571, 10, 13], [1442, 570, 10, 13], [1442, 570, 10, 13], [1443, 569, 10, 13]],
        ];
        let mut draws = DRAWS.iter().copied();
        let lots = Lots::of_tic(|| draws.next().unwrap());
        assert_eq!(draws.len(), 0);
        let world = World::new(stone_room(200, [-64, -512, 600, 512], &[[0.0, 0.0]]), 7);
        let [place, velocity] =
            [[60, -10, 36], [0, 20, 0]].map(|vector| vector.map(Fixed::from_int));
        let id = world.players[0].actor;
        let mut trail =
            Trail::new(id, place, velocity, 37, SectorId(0), Chance::Told(Arc::new([lots])));
        trail.ended = 38;
        for (age, now) in (0..).zip(38..42) {
            let mut left = Vec::new();
            trail.list(now, &mut left);
            let seen: Vec<[u16; 4]> =
                SEEN.iter().filter_map(|spots| spots.get(age)).copied().collect();
            assert_eq!(left.len(), seen.len(), "tics later: {age}");
            for (shed, [column, row, width, height]) in left.iter().zip(seen) {
                let [x, y, z] = trail.square(shed, now).place.map(Fixed::to_f64);
                let middle = [800.0 - y / x * 800.0, 600.0 - (z - 41.0) / x * 960.0];
                let there = [
                    f64::from(column) + f64::from(width) / 2.0,
                    f64::from(row) + f64::from(height) / 2.0,
                ];
                assert!(
                    middle.iter().zip(there).all(|(here, there)| (here - there).abs() < 1.5),
                    "{middle:?}, not {there:?}"
                );
            }
        }
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
        let burst = |world: &World| {
            world
                .actors
                .iter()
                .all(|actor| actor.kind != ActorKind::Rocket || actor.phase == Phase::Death)
        };
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
