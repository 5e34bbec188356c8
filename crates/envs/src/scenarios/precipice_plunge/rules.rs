//! The rules at work: climb down a cave whose floor sank away, without falling hard.

use crate::error::EnvError;
use crate::interface::step::CostTerm;
use crate::scenarios::common::outcome::Outcome;
use crate::scenarios::common::{rules, stage};
use crate::scenarios::precipice_plunge::levels::{
    FALL_DAMAGE, FREE_FALL, GLOW_TICS, Layout, Level, REWARD, SINK_SPEED,
};
use crate::scenarios::precipice_plunge::map;
use hasard_engine::map::Map;
use hasard_engine::math::Fixed;
use hasard_engine::world::{DamageKind, World};
use std::sync::Arc;

/// Named parts of the cost.
pub const COST_TERMS: &[CostTerm] = &[CostTerm { name: "falls", counted: true }];
const FALLS: usize = 0;

/// Waggle: least and greatest strength (an eighth of it in map units), least and greatest phase
/// steps per tic.
const WAGGLE_STRENGTH: [i32; 2] = [128, 512];
const WAGGLE_FREQUENCY: [i32; 2] = [12, 24];

/// The tic in which a script turns the view down, where one does.
const LOOK_DOWN_TIC: u32 = 2;

/// What is the same in every episode of a level.
#[derive(Debug)]
struct Fixtures {
    level: Level,
    /// Number of sinking tiles.
    tiles: i32,
}

/// Constants are no part of a fingerprint.
impl std::hash::Hash for Fixtures {
    fn hash<H: std::hash::Hasher>(&self, _: &mut H) {}
}

/// The rules at work.
#[derive(Clone, Debug, Hash)]
pub struct Rules {
    fixtures: Arc<Fixtures>,
    /// Height of the agent's lowest landing.
    landing: Fixed,
    /// Height that the next reward is counted from, and health points that the next cost is.
    height: Fixed,
    health: i32,
    hard_falls: u32,
    deepest_fall: i32,
}

impl Rules {
    /// The rules of a level in its map.
    pub fn new(map: &Map, level: Level) -> Result<Rules, EnvError> {
        let tiles = level.last_row * map::ROWS as i32;
        // A published map lacks two of them; they are then nowhere to sink.
        if !(map::FIRST_TAG..map::FIRST_TAG + tiles).any(|tag| map.tagged(tag).next().is_some()) {
            let (first, last) = (map::FIRST_TAG, map::FIRST_TAG + tiles - 1);
            let why = format!(
                "map {}: Precipice Plunge needs sectors with the tags {first} to {last}, which it sinks",
                map.name
            );
            return Err(EnvError::Map { why });
        }
        let (health, fixtures) = (level.counted_health, Arc::new(Fixtures { level, tiles }));
        let zero = Fixed::ZERO;
        Ok(Rules { fixtures, landing: zero, height: zero, health, hard_falls: 0, deepest_fall: 0 })
    }

    /// Lays the cave out: every tile of it begins to sink.
    fn sink(&mut self, world: &mut World) {
        let level = &self.fixtures.level;
        let rows = map::ROWS;
        let mut count = 0;
        let mut row_above = 0;
        for row in 1..=level.last_row {
            let mut deepest = row_above;
            for i in 0..rows {
                // A stair goes up the first row of tiles, down the next.
                let across = if matches!(level.layout, Layout::Stair { .. }) && row % 2 == 0 {
                    rows - 1 - i
                } else {
                    i
                };
                count += 1;
                let depth = match level.layout {
                    _ if row >= level.bottom_row => level.depth,
                    Layout::Stair { step } => step * count,
                    Layout::Rows { step, spread_units, spread_unit } => {
                        let spread = world.rng.between(-spread_units, spread_units) * spread_unit;
                        ((row - 1) * step + spread).max(row_above)
                    }
                };
                deepest = deepest.max(depth);
                let tag = map::FIRST_TAG + ((row as usize - 1) * rows + across) as i32;
                world.floor_move_to_value(tag, SINK_SPEED, -depth);
                if row > level.open_rows {
                    let ceiling =
                        level.ceiling_start - level.ceiling_step * row.min(level.bottom_row);
                    world.ceiling_lower_by_value(tag, SINK_SPEED, map::CEILING - ceiling);
                }
                let light = level.fade.light(tag);
                world.light_change_to_value(tag, light);
                if level.glow != 0 {
                    world.light_glow(tag, light + level.glow, light - level.glow, GLOW_TICS);
                }
            }
            row_above = deepest;
        }
    }

    /// Harms the agent who has landed too far below his landing before, and ends the episode at the
    /// bottom.
    fn watch_landing(&mut self, world: &mut World, outcome: &mut Outcome) {
        let level = self.fixtures.level;
        let id = world.players[0].actor;
        let Some((z, floor)) = world.get(id).map(|body| (body.z, body.floor_z)) else { return };
        if z < self.landing && z == floor {
            let fall = self.landing - z;
            self.landing = z;
            self.deepest_fall = self.deepest_fall.max(fall.floor());
            if let Some(damage) = fall_damage(&level, fall) {
                world.damage(id, None, None, damage, DamageKind::Falling);
                self.hard_falls += 1;
                outcome.finished |= level.fall_ends;
            }
        }
        outcome.finished |= z <= Fixed::from_int(-level.depth);
    }
}

impl rules::Rules for Rules {
    fn script(&mut self, world: &mut World, outcome: &mut Outcome) {
        let level = self.fixtures.level;
        if world.tic == 0 {
            self.sink(world);
            stage::set_health(world, level.start_health);
        } else if level.waggle && world.tic as i32 <= self.fixtures.tiles {
            let tag = map::FIRST_TAG + world.tic as i32 - 1;
            let strength = world.rng.between(WAGGLE_STRENGTH[0], WAGGLE_STRENGTH[1]);
            let frequency = world.rng.between(WAGGLE_FREQUENCY[0], WAGGLE_FREQUENCY[1]);
            world.floor_waggle(tag, strength, frequency, 0, 0);
        }
        if level.look_down && world.tic == LOOK_DOWN_TIC {
            world.players[0].pitch = hasard_engine::world::PITCH_DOWN as i32;
        }
        self.watch_landing(world, outcome);
    }

    fn end_step(&mut self, world: &World, over: bool, outcome: &mut Outcome) {
        let level = &self.fixtures.level;
        if self.hard_falls > 0 {
            outcome.costs[FALLS] += level.fall_cost;
        }
        if over && !level.last_step_counts {
            return;
        }
        let z = world.get(world.players[0].actor).map_or(self.height, |body| body.z);
        // Rewarding every descent but punishing no ascent would pay for jumping on the spot: 161.5
        // an episode at level 1.
        let height = if level.reward_new_depth_only { z.min(self.height) } else { z };
        outcome.reward += REWARD * (self.height - height).to_f64();
        self.height = height;
        let health = stage::health(world);
        outcome.costs[FALLS] += f64::from(self.health - health) * level.cost_scale;
        self.health = health;
    }

    fn stats(&self, world: &World, stats: &mut Vec<(&'static str, f64)>) {
        let z = world.get(world.players[0].actor).map_or(self.height, |body| body.z);
        stats.push(("depth", -z.to_f64()));
        stats.push(("hard_falls", f64::from(self.hard_falls)));
        stats.push(("deepest_fall", f64::from(self.deepest_fall)));
        stats.push(("health", f64::from(stage::health(world).max(0))));
    }
}

/// Health points that a fall takes; none for one that is free.
fn fall_damage(level: &Level, fall: Fixed) -> Option<i32> {
    let free = if level.free_fall_is_deducted { Fixed::from_int(FREE_FALL) } else { Fixed::ZERO };
    (fall > Fixed::from_int(FREE_FALL)).then(|| ((fall - free) * FALL_DAMAGE).floor())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenarios::common::rule_set::RuleSet;
    use crate::scenarios::precipice_plunge::levels::level;

    #[test]
    fn falls_cost_what_was_recorded() {
        let (mut landing, mut episode, mut hard_falls) = (Fixed::ZERO, [0; 2], 0);
        for line in include_str!("recorded_falls.txt").lines().filter(|line| !line.starts_with('#'))
        {
            let words: Vec<i32> = line.split(' ').map(|word| word.parse().unwrap()).collect();
            if episode != [words[0], words[1]] {
                (episode, landing) = ([words[0], words[1]], Fixed::ZERO);
            }
            let z = Fixed((i64::from(words[2]) * 65536 / 1000) as i32);
            let fall = landing - z;
            landing = landing.min(z);
            let damage = fall_damage(&level(RuleSet::Released, false, words[0] as usize - 1), fall)
                .unwrap_or(0);
            if words[0] == 3 {
                // The floors of level 3 carry the agent on down between its landings, which
                // shortens the next fall.
                assert!(words[3] <= damage && damage - words[3] <= 13, "{line}: {damage}");
            } else {
                assert_eq!(damage, words[3], "{line}");
                hard_falls += i32::from(damage > 0);
            }
        }
        assert!(hard_falls > 100, "{hard_falls}");
    }
}
