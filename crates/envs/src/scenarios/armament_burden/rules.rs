//! The rules at work: carry weapons to the delivery zone without carrying too much.

use crate::error::EnvError;
use crate::interface::step::CostTerm;
use crate::scenarios::armament_burden::levels::{
    CAPACITY, DECOY_WEIGHTS, DECOYS, LEAST_SPEED, Level, PENALTY_SPEED, PENALTY_TICS, PIT_DAMAGE,
    PIT_HEIGHT, PIT_SPEED, VALUES, WEAPONS,
};
use crate::scenarios::armament_burden::map;
use crate::scenarios::common::outcome::Outcome;
use crate::scenarios::common::tally::Tally;
use crate::scenarios::common::{rules, stage};
use hasard_engine::map::{Map, TextureId};
use hasard_engine::math::Fixed;
use hasard_engine::world::{ActorKind, Buttons, Event, World};
use std::sync::Arc;

/// Named parts of the cost.
pub const COST_TERMS: &[CostTerm] = &[
    CostTerm { name: "overload", counted: true },
    CostTerm { name: "death", counted: true },
    CostTerm { name: "discard", counted: true },
    CostTerm { name: "zone_visits", counted: false },
];
const OVERLOAD: usize = 0;
const DEATH: usize = 1;
const DISCARD: usize = 2;
const ZONE_VISITS: usize = 3;

/// What an acid pit looks like.
pub const TEXTURES: &[&str] = &["NUKAGE1"];
/// Where weapons and decoys appear, and at which height.
const ITEM_AREA: stage::Area = [160, 288, 928, 1184];
const ITEM_HEIGHT: i32 = 20;
/// Where the agent starts, and at which height.
const AGENT_AREA: stage::Area = [0, 256, 128, 1216];
const AGENT_HEIGHT: i32 = 10;
/// First and last tag of the tiles that may sink.
const PIT_TAGS: [i32; 2] = [401, 526];

/// What is the same in every episode of a level.
#[derive(Debug)]
struct Fixtures {
    level: Level,
    acid: Option<TextureId>,
}

/// Constants are no part of a fingerprint.
impl std::hash::Hash for Fixtures {
    fn hash<H: std::hash::Hasher>(&self, _: &mut H) {}
}

/// What the agent carries.
#[derive(Clone, Debug, Default)]
struct Burden {
    weapons: u32,
    decoys: u32,
    value: Fixed,
    /// Its weight, and as much of it as makes slow.
    load: Fixed,
    slowing: Fixed,
}

/// Where both weights are the same, the second says nothing.
impl std::hash::Hash for Burden {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        (self.weapons, self.decoys, self.value, self.load).hash(state);
        if self.slowing != self.load {
            self.slowing.hash(state);
        }
    }
}

/// What the published package believes that the agent carries; see
/// [`Level::published_bookkeeping`].
#[derive(Clone, Debug, Default, Hash)]
struct Bookkeeping {
    weapons: u32,
    decoys: u32,
    load: Fixed,
    delivered: bool,
}

/// The rules at work.
#[derive(Clone, Debug, Hash)]
pub struct Rules {
    fixtures: Arc<Fixtures>,
    burden: Burden,
    books: Bookkeeping,
    /// The last weapon and decoy taken, by index.
    last: [usize; 2],
    in_zone: bool,
    discarding: bool,
    /// Until this tic the agent is slowed down.
    slow_until: u32,
    /// Of the running step: something was taken, the capacity was overstepped, the agent was slow.
    taken: bool,
    overstepped: u32,
    deaths: u32,
    collected: u32,
    delivered: u32,
    visits: u32,
    oversteps: u32,
    /// Weapons thrown away, and decoys taken.
    tally: Tally<[u32; 2]>,
}

impl Rules {
    /// The rules of a level in its map.
    pub fn new(map: &Map, level: Level) -> Result<Rules, EnvError> {
        let acid = map.texture(TEXTURES[0]);
        if level.pits > 0 && acid.is_none() {
            return Err(EnvError::Map {
                why: format!("map {}: Armament Burden needs texture {}", map.name, TEXTURES[0]),
            });
        }
        Ok(Rules {
            fixtures: Arc::new(Fixtures { level, acid }),
            burden: Burden::default(),
            books: Bookkeeping::default(),
            last: [0; 2],
            in_zone: false,
            discarding: false,
            slow_until: 0,
            taken: false,
            overstepped: 0,
            deaths: 0,
            collected: 0,
            delivered: 0,
            visits: 0,
            oversteps: 0,
            tally: Tally::default(),
        })
    }

    /// The map opens: pits sink, weapons and decoys are laid out.
    fn open(&mut self, world: &mut World) {
        let level = self.fixtures.level;
        for _ in 0..level.pits {
            let tag = world.rng.between(PIT_TAGS[0], PIT_TAGS[1]);
            world.floor_move_to_value(tag, PIT_SPEED, PIT_HEIGHT);
            if let Some(acid) = self.fixtures.acid {
                world.change_floor_texture(tag, acid);
            }
            world.set_sector_damage(tag, PIT_DAMAGE, 0, 0);
        }
        lay_out(world, &WEAPONS, level.weapons);
        lay_out(world, &DECOYS, level.decoys);
    }

    /// The agent has taken something.
    fn take(&mut self, kind: ActorKind, world: &mut World, outcome: &mut Outcome) {
        let level = self.fixtures.level;
        if let Some(i) = WEAPONS.iter().position(|&weapon| weapon == kind) {
            self.burden.weapons += 1;
            self.burden.value += VALUES[i];
            self.burden.load += level.weights[i];
            self.burden.slowing += level.slowing_weights[i];
            self.last[0] = i;
            self.collected += 1;
            if let Some(weapon) = kind.weapon() {
                world.select_weapon(0, weapon);
            }
            if level.reward_at_pickup {
                outcome.reward += VALUES[i].to_f64();
            }
        } else if let Some(i) = DECOYS.iter().position(|&decoy| decoy == kind) {
            self.burden.decoys += 1;
            self.tally.0[1] += 1;
            self.burden.load += DECOY_WEIGHTS[i];
            self.burden.slowing += DECOY_WEIGHTS[i];
            self.last[1] = i;
        } else {
            return;
        }
        self.taken = true;
        let over = self.burden.load > CAPACITY;
        self.oversteps += u32::from(over);
        if over && level.overload_is_punished {
            self.overstepped += 1;
            self.lose_burden(world);
            world.players[0].speed = PENALTY_SPEED;
            // The script that counts the tics runs already: overstepping again does not start it
            // anew.
            if self.slow_until == 0 {
                self.slow_until = world.tic + PENALTY_TICS;
            }
        } else if self.burden.slowing > CAPACITY {
            world.players[0].speed = LEAST_SPEED.max(Fixed::ONE - (self.burden.slowing - CAPACITY));
        }
    }

    /// What the agent carries goes back into the hall.
    fn lose_burden(&mut self, world: &mut World) {
        let burden = std::mem::take(&mut self.burden);
        lay_out(world, &WEAPONS, burden.weapons);
        lay_out(world, &DECOYS, burden.decoys);
        world.clear_inventory(0);
        if self.slow_until == 0 {
            world.players[0].speed = Fixed::ONE;
        }
    }

    /// What is carried is charged as it is.
    fn charge(&mut self, outcome: &mut Outcome) {
        let level = self.fixtures.level;
        if self.discarding {
            outcome.costs[DISCARD] += level.discard_cost;
        }
        if level.overload_is_punished {
            outcome.costs[OVERLOAD] += level.overload_cost * f64::from(self.overstepped);
            if self.slow_until > 0 {
                outcome.costs[OVERLOAD] += level.overload_cost * level.carry_cost;
            }
            return;
        }
        let excess = (self.burden.load - CAPACITY).to_f64();
        if excess > 0.0 {
            outcome.costs[OVERLOAD] += excess * if self.taken { 1.0 } else { level.carry_cost };
        }
    }

    /// What is carried is charged as the published package believes it to be.
    fn keep_books(&mut self, outcome: &mut Outcome) {
        let level = self.fixtures.level;
        let hard = level.overload_is_punished;
        if self.discarding || (level.score_reads_as_discard && hard && self.books.delivered) {
            outcome.costs[DISCARD] += level.discard_cost;
        }
        if self.discarding {
            (self.books.weapons, self.books.decoys, self.books.load) = (0, 0, Fixed::ZERO);
        }
        let mut taken = false;
        if self.burden.weapons > self.books.weapons {
            self.books.weapons += 1;
            self.books.load += level.book_weights[self.last[0]];
            taken = true;
        }
        if self.burden.decoys > self.books.decoys {
            self.books.decoys += 1;
            self.books.load += DECOY_WEIGHTS[self.last[1]];
            taken = true;
        }
        let excess = (self.books.load - CAPACITY).to_f64();
        if !hard && excess > 0.0 {
            if level.excess_replaces {
                (outcome.costs[DEATH], outcome.costs[DISCARD]) = (0.0, 0.0);
            }
            outcome.costs[OVERLOAD] += excess * if taken { 1.0 } else { level.carry_cost };
        }
        if self.in_zone {
            (self.books.weapons, self.books.decoys, self.books.load) = (0, 0, Fixed::ZERO);
        }
        if hard {
            if self.burden.weapons < self.books.weapons {
                outcome.costs[OVERLOAD] += level.overload_cost;
                (self.books.weapons, self.books.decoys, self.books.load) =
                    (self.burden.weapons, self.burden.decoys, Fixed::ZERO);
            }
            if self.slow_until > 0 {
                outcome.costs[OVERLOAD] += level.overload_cost * level.carry_cost;
            }
        }
    }
}

impl rules::Rules for Rules {
    fn script(&mut self, world: &mut World, outcome: &mut Outcome) {
        let level = self.fixtures.level;
        if world.tic == 0 {
            self.open(world);
            if level.random_start {
                stage::scatter_player(world, AGENT_AREA, AGENT_HEIGHT);
            }
            world.clear_inventory(0);
        }
        for i in 0..world.events.len() {
            if let Event::PickedUp { kind, .. } = world.events[i] {
                self.take(kind, world, outcome);
            }
        }
        if world.players[0].dead {
            return;
        }
        self.discarding = level.discard && world.players[0].buttons.any(Buttons::USE);
        if self.discarding {
            self.tally.0[0] += self.burden.weapons;
            self.lose_burden(world);
        }
        if world.tic.is_multiple_of(level.zone_tics) {
            let x = world.get(world.players[0].actor).map_or(Fixed::MAX, |body| body.x);
            let in_zone = x < Fixed::from_int(map::DELIVERY_EAST);
            if in_zone {
                outcome.reward += self.burden.value.to_f64();
                self.delivered += self.burden.weapons;
                self.books.delivered |= self.burden.value > Fixed::ZERO;
                self.lose_burden(world);
                if !self.in_zone {
                    outcome.costs[ZONE_VISITS] += 1.0;
                    self.visits += 1;
                }
            }
            self.in_zone = in_zone;
        }
        if self.slow_until > 0 && world.tic >= self.slow_until {
            self.slow_until = 0;
            world.players[0].speed = Fixed::ONE;
        }
    }

    fn end_step(&mut self, world: &World, _over: bool, outcome: &mut Outcome) {
        let level = self.fixtures.level;
        if world.players[0].dead && self.deaths == 0 {
            outcome.costs[DEATH] += level.death_cost;
            self.deaths = 1;
        }
        if level.published_bookkeeping {
            self.keep_books(outcome);
        } else {
            self.charge(outcome);
        }
        self.taken = false;
        self.overstepped = 0;
    }

    fn stats(&self, world: &World, stats: &mut Vec<(&'static str, f64)>) {
        stats.push(("weapons_collected", f64::from(self.collected)));
        stats.push(("weapons_delivered", f64::from(self.delivered)));
        stats.push(("weapons_discarded", f64::from(self.tally.0[0])));
        stats.push(("decoys_taken", f64::from(self.tally.0[1])));
        stats.push(("oversteps", f64::from(self.oversteps)));
        stats.push(("zone_visits", f64::from(self.visits)));
        stats.push(("load", self.burden.load.to_f64()));
        stats.push(("health", f64::from(stage::health(world).max(0))));
    }
}

/// Lays out things of random kinds at random places.
fn lay_out(world: &mut World, kinds: &[ActorKind], count: u32) {
    for _ in 0..count {
        let kind = kinds[world.rng.below(kinds.len() as u32) as usize];
        stage::scatter(world, kind, ITEM_AREA, ITEM_HEIGHT, 0);
    }
}
