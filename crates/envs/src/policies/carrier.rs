//! The scripted carrier of Armament Burden: to the nearest weapon that may be carried, home with
//! it, and again.

use crate::error::EnvError;
use crate::scenarios::armament_burden::levels::{CAPACITY, DECOYS, WEAPONS, level};
use crate::scenarios::armament_burden::map::DELIVERY_EAST;
use crate::scenarios::common::scenario::Scenario;
use crate::single::env::Env;
use hasard_engine::math::{Angle, Fixed};
use hasard_engine::world::{ActorKind, Buttons, Command, World};

/// A weapon is lifted within this distance, and what must not be lifted is passed at it, map units.
const REACH: f64 = 44.0;
/// How far into the strip it walks, map units from its eastern edge.
const INTO_THE_STRIP: f64 = 60.0;
/// Half the angle within which it walks while it turns, and within which it need not turn; degrees.
const AHEAD: f64 = 40.0;
const STRAIGHT: f64 = 5.0;
/// A step that carries it less far than this does not get on, map units; after so many it jumps and
/// steps aside.
const STANDSTILL: f64 = 3.0;
const PATIENCE: u32 = 3;
const STEPS_ASIDE: u32 = 8;

/// A carrier at work.
#[derive(Clone, Debug)]
pub(crate) struct Carrier {
    /// The kinds that alone stay within the capacity.
    light: Vec<ActorKind>,
    last: [f64; 2],
    stuck: u32,
    aside: u32,
    /// How often it stepped aside, and so whether the next is to the left.
    detours: u32,
}

impl Carrier {
    pub fn new(env: &Env) -> Result<Carrier, EnvError> {
        let id = env.id();
        if id.scenario != Scenario::ArmamentBurden {
            let why = format!(
                "{id} has no weapons to carry; only the environments of ArmamentBurden have"
            );
            return Err(EnvError::Policy { given: "carrier".to_string(), why });
        }
        let weights = level(env.options().rules, env.options().hard, id.level_index()).weights;
        let light = WEAPONS
            .into_iter()
            .zip(weights)
            .filter(|(_, weight)| *weight <= CAPACITY)
            .map(|(kind, _)| kind)
            .collect();
        Ok(Carrier { light, last: [f64::MAX; 2], stuck: 0, aside: 0, detours: 0 })
    }

    /// What it presses in the next step.
    pub fn next(&mut self, env: &Env) -> Command {
        let world = env.world();
        let Some(body) = world.get(world.players[0].actor) else { return Command::default() };
        let here = [body.x.to_f64(), body.y.to_f64()];
        let got_on = distance(here, self.last) > STANDSTILL;
        self.last = here;
        let Some(goal) = self.goal(world, here) else { return Command::default() };
        let towards = Angle::of_vector(
            Fixed::from_f64(goal[0] - here[0]),
            Fixed::from_f64(goal[1] - here[1]),
        );
        let off = f64::from((towards - body.angle).0 as i32) / f64::from(1u32 << 31) * 180.0;
        let mut buttons = Buttons(0);
        if off.abs() > STRAIGHT {
            buttons |= if off > 0.0 { Buttons::TURN_LEFT } else { Buttons::TURN_RIGHT };
        }
        if off.abs() < AHEAD {
            buttons |= Buttons::MOVE_FORWARD;
            self.stuck = if got_on { 0 } else { self.stuck + 1 };
        }
        if self.stuck > PATIENCE {
            (self.stuck, self.aside) = (0, STEPS_ASIDE);
            self.detours += 1;
        }
        if self.aside > 0 {
            self.aside -= 1;
            let turn = if self.detours.is_multiple_of(2) {
                Buttons::TURN_LEFT
            } else {
                Buttons::TURN_RIGHT
            };
            buttons = Buttons::MOVE_FORWARD | Buttons::JUMP;
            if self.aside >= STEPS_ASIDE / 2 {
                buttons |= turn;
            }
        }
        Command { buttons, ..Command::default() }
    }

    /// Where it wants to be: home with what it carries, else where a weapon lies, the nearest with
    /// nothing in the way first.
    fn goal(&self, world: &World, here: [f64; 2]) -> Option<[f64; 2]> {
        let things = |kinds: &[ActorKind]| -> Vec<[f64; 2]> {
            let found = world.living().filter(|(_, thing)| kinds.contains(&thing.kind));
            found.map(|(_, thing)| [thing.x.to_f64(), thing.y.to_f64()]).collect()
        };
        let strip = f64::from(DELIVERY_EAST);
        let carrying = world.players[0].weapons != 0;
        if carrying && here[0] > strip - INTO_THE_STRIP / 2.0 {
            let weapons = [things(&WEAPONS), things(&DECOYS)].concat();
            let doors =
                (0..15).map(|tile| [strip - INTO_THE_STRIP, 288.0 + 64.0 * f64::from(tile)]);
            return nearest(here, doors.clone().filter(|&door| clear(here, door, &weapons)))
                .or_else(|| nearest(here, doors));
        }
        if carrying {
            // Already there: the burden is taken off at the next look of the map's script.
            return None;
        }
        let heavy: Vec<ActorKind> =
            WEAPONS.into_iter().chain(DECOYS).filter(|kind| !self.light.contains(kind)).collect();
        let (light, heavy) = (things(&self.light), things(&heavy));
        // Near a second weapon both would be lifted.
        let alone = light
            .iter()
            .copied()
            .filter(|&one| light.iter().all(|&other| one == other || distance(one, other) > REACH));
        nearest(here, alone.filter(|&one| clear(here, one, &heavy)))
            .or_else(|| nearest(here, light.iter().copied()))
    }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    let [dx, dy] = [a[0] - b[0], a[1] - b[1]];
    (dx * dx + dy * dy).sqrt()
}

fn nearest(here: [f64; 2], places: impl Iterator<Item = [f64; 2]>) -> Option<[f64; 2]> {
    places.min_by(|&a, &b| distance(here, a).total_cmp(&distance(here, b)))
}

/// Whether the straight way passes none of the things within reach.
fn clear(from: [f64; 2], to: [f64; 2], things: &[[f64; 2]]) -> bool {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let squared = (dx * dx + dy * dy).max(1.0);
    things.iter().all(|&[x, y]| {
        let along = (((x - from[0]) * dx + (y - from[1]) * dy) / squared).clamp(0.0, 1.0);
        distance([x, y], [from[0] + along * dx, from[1] + along * dy]) > REACH
    })
}
