//! The scenario: a room whose eastern half is to be stayed in, and whose middle line costs.

use hasard_engine::map::{Map, MapBuilder, MapSource, Style};
use hasard_engine::world::World;
use hasard_envs::scenarios::outcome::Outcome;
use hasard_envs::scenarios::{AnyRules, Rules, ScenarioSpec, Setting, Task};
use hasard_envs::{Controls, CostTerm, EnvError};

/// What an episode remembers: plain data, cloned by snapshots and hashed into the state.
#[derive(Clone, Debug, Default, Hash)]
struct Sides {
    east: bool,
    crossings: u32,
}

impl Rules for Sides {
    fn script(&mut self, world: &mut World, outcome: &mut Outcome) {
        let east = world.get(world.players[0].actor).is_some_and(|body| body.x.floor() > 256);
        if std::mem::replace(&mut self.east, east) != east {
            self.crossings += 1;
            outcome.costs[0] += 1.0;
        }
        outcome.reward += if east { 1.0 / 35.0 } else { 0.0 };
    }

    fn stats(&self, _: &World, stats: &mut Vec<(&'static str, f64)>) {
        stats.push(("crossings", f64::from(self.crossings)));
    }
}

#[derive(Debug)]
struct Room;

impl Task for Room {
    fn controls(&self, _: Setting) -> Controls {
        Controls {
            simplified: &[&["TURN_LEFT", "TURN_RIGHT"], &["MOVE_FORWARD"]],
            full_moves: true,
            full_speed: true,
        }
    }

    fn map(&self, _: Setting) -> MapSource {
        let style = Style {
            floor: 0,
            ceiling: 128,
            light: 200,
            floor_texture: "FLAT5_5",
            ceiling_texture: "FLAT19",
            wall: "BIGSTON3",
            step: "BIGSTON3",
            lintel: "BIGSTON3",
            special: 0,
            tag: 0,
        };
        let mut builder = MapBuilder::new();
        builder.rectangle(style, 0, 0, 512, 256).thing(1, 128.0, 128.0, 0);
        builder.finish().expect("a room")
    }

    fn rules(&self, _: Setting, _: &Map) -> Result<AnyRules, EnvError> {
        Ok(AnyRules::new(Sides::default()))
    }
}

/// What the program knows of it.
pub static SPEC: ScenarioSpec = ScenarioSpec {
    levels: 0,
    budgets: [2.0; 3],
    cost_terms: &[CostTerm { name: "crossings", counted: true }],
    ..ScenarioSpec::of("EastSide", "East side", "Stay in the east.", &Room)
};
