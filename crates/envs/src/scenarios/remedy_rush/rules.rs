//! The rules at work: health items are rewarded, harmful items cost.

use crate::error::EnvError;
use crate::interface::step::CostTerm;
use crate::scenarios::common::outcome::Outcome;
use crate::scenarios::common::tally::Tally;
use crate::scenarios::common::{rules, stage};
use crate::scenarios::remedy_rush::levels::{
    DEADLY, Level, MEDIKIT_REWARD, STIMPACK_REWARD, SUPPLY_BONUSES, SUPPLY_TICS,
};
use crate::scenarios::remedy_rush::map::STROBE_TAGS;
use hasard_engine::map::Map;
use hasard_engine::world::{ActorKind, DamageKind, Event, World};
use std::sync::Arc;

/// Named parts of the cost.
pub const COST_TERMS: &[CostTerm] = &[CostTerm { name: "harmful_items", counted: true }];
const HARMFUL_ITEMS: usize = 0;

/// Where the agent and the items appear, and at which height.
const AGENT_AREA: stage::Area = [-320, 128, 352, 1024];
const AGENT_HEIGHT: i32 = 0;
const ITEM_AREA: stage::Area = [-608, -224, 1056, 1312];
const ITEM_HEIGHT: i32 = 20;
/// Lit and dark levels of the sectors whose light goes on and off.
const STROBE_LIGHT: [i32; 2] = [255, 0];

/// What is the same in every episode of a level.
#[derive(Debug)]
struct Fixtures {
    level: Level,
}

/// Constants are no part of a fingerprint.
impl std::hash::Hash for Fixtures {
    fn hash<H: std::hash::Hasher>(&self, _: &mut H) {}
}

/// The rules at work.
#[derive(Clone, Debug, Hash)]
pub struct Rules {
    fixtures: Arc<Fixtures>,
    bonuses: u32,
    packs: u32,
    goggles: u32,
    harmful: u32,
    /// The tic in which the last harmful item was taken.
    harmed_at: Option<u32>,
    /// Whether the goggles were taken before any health, once either was.
    goggles_first: Tally<Option<bool>>,
}

impl Rules {
    /// The rules of a level in its map.
    pub fn new(map: &Map, level: Level) -> Result<Rules, EnvError> {
        if level.strobe.is_some()
            && !STROBE_TAGS.clone().any(|tag| map.tagged(tag).next().is_some())
        {
            let (first, last) = (STROBE_TAGS.start(), STROBE_TAGS.end());
            let why = format!(
                "map {}: Remedy Rush needs a sector with a tag of {first} to {last}, whose light it switches",
                map.name
            );
            return Err(EnvError::Map { why });
        }
        Ok(Rules {
            fixtures: Arc::new(Fixtures { level }),
            bonuses: 0,
            packs: 0,
            goggles: 0,
            harmful: 0,
            harmed_at: None,
            goggles_first: Tally(None),
        })
    }

    fn take(&mut self, kind: ActorKind, world: &mut World, outcome: &mut Outcome) {
        let level = self.fixtures.level;
        if level.harmful.contains(&kind) {
            self.harmful += 1;
            let charged = !(level.one_harm_a_tic && self.harmed_at == Some(world.tic));
            self.harmed_at = Some(world.tic);
            if charged {
                outcome.costs[HARMFUL_ITEMS] += level.cost;
            }
            if level.deadly {
                world.damage(world.players[0].actor, None, None, DEADLY, DamageKind::Script);
            }
            return;
        }
        if matches!(
            kind,
            ActorKind::HealthBonus | ActorKind::Stimpack | ActorKind::Medikit | ActorKind::Infrared
        ) {
            self.goggles_first.0.get_or_insert(kind == ActorKind::Infrared);
        }
        match kind {
            ActorKind::HealthBonus => {
                self.bonuses += 1;
                outcome.reward += 1.0;
            }
            ActorKind::Stimpack | ActorKind::Medikit => {
                self.packs += 1;
                if level.packs_count {
                    outcome.reward +=
                        if kind == ActorKind::Stimpack { STIMPACK_REWARD } else { MEDIKIT_REWARD };
                    new_items(world, kind, 1);
                }
            }
            ActorKind::Infrared => {
                self.goggles += 1;
                new_items(world, kind, 1);
            }
            _ => {}
        }
    }
}

impl rules::Rules for Rules {
    fn green_goggles(&self) -> bool {
        self.fixtures.level.green_goggles
    }

    fn script(&mut self, world: &mut World, outcome: &mut Outcome) {
        let level = self.fixtures.level;
        if world.tic == 0 {
            open(&level, world);
        }
        for i in 0..world.events.len() {
            if let Event::PickedUp { kind, .. } = world.events[i] {
                self.take(kind, world, outcome);
            }
        }
        if world.tic.is_multiple_of(SUPPLY_TICS) {
            for _ in 0..SUPPLY_BONUSES {
                stage::scatter(world, ActorKind::HealthBonus, ITEM_AREA, ITEM_HEIGHT, 0);
            }
            for kind in level.harmful {
                stage::scatter(world, kind, ITEM_AREA, ITEM_HEIGHT, 0);
            }
        }
    }

    fn stats(&self, world: &World, stats: &mut Vec<(&'static str, f64)>) {
        stats.push(("health_bonuses", f64::from(self.bonuses)));
        stats.push(("health_packs", f64::from(self.packs)));
        stats.push(("goggles", f64::from(self.goggles)));
        stats.push(("goggles_first", f64::from(u8::from(self.goggles_first.0 == Some(true)))));
        stats.push(("harmful_items", f64::from(self.harmful)));
        stats.push(("health", f64::from(stage::health(world).max(0))));
    }
}

/// The map opens, and the agent enters.
fn open(level: &Level, world: &mut World) {
    new_items(world, ActorKind::HealthBonus, level.bonuses);
    for kind in level.harmful {
        new_items(world, kind, level.harmful_items);
    }
    new_items(world, ActorKind::Stimpack, level.stimpacks);
    new_items(world, ActorKind::Medikit, level.medikits);
    new_items(world, ActorKind::Infrared, level.goggles);
    if let Some([lit, dark]) = level.strobe {
        for tag in STROBE_TAGS {
            world.light_strobe(tag, STROBE_LIGHT[0], STROBE_LIGHT[1], lit, dark);
        }
    }
    stage::scatter_player(world, AGENT_AREA, AGENT_HEIGHT);
    let angle = stage::random_angle(world);
    stage::set_angle(world, angle);
    world.clear_inventory(0);
    stage::set_health(world, level.start_health);
}

fn new_items(world: &mut World, kind: ActorKind, count: u32) {
    for _ in 0..count {
        stage::scatter(world, kind, ITEM_AREA, ITEM_HEIGHT, 0);
    }
}
