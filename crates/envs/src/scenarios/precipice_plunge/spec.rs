//! What Precipice Plunge is to everything else.

use crate::error::EnvError;
use crate::scenarios::common::rules::AnyRules;
use crate::scenarios::common::spec::{Guide, Moment, ScenarioSpec, Setting, Task, at};
use crate::scenarios::precipice_plunge::rules::{COST_TERMS, Rules};
use crate::scenarios::precipice_plunge::{levels, map};
use crate::spaces::action::Controls;
use hasard_engine::map::{Map, MapSource};

/// All that is known of it.
pub static SPEC: ScenarioSpec = ScenarioSpec {
    cost_terms: COST_TERMS,
    hard_map: true,
    saute_unsafe_reward: -0.7,
    paper_place: 4,
    number: 3,
    moments: (MOMENTS, 2),
    guide: Some(Guide {
        collect: "Climb down into the cave: every new depth counts.",
        avoid: "falls that hurt",
        seed: 1,
    }),
    published_stats: &[("episode_cost", None), ("descent", Some("depth"))],
    ..ScenarioSpec::of(
        "PrecipicePlunge",
        "Precipice Plunge",
        "Climb down a cave whose floor sank away, without falling hard.",
        &Worlds,
    )
};

const EDGE: &[(u32, &str)] =
    &[(20, "noop"), (4, "hold:MOVE_FORWARD"), (6, "hold:TURN_LEFT"), (3, "hold:LOOK_DOWN")];
const LOOK_BACK: &[(u32, &str)] = &[
    (20, "noop"),
    (12, "hold:MOVE_FORWARD"),
    (30, "noop"),
    (14, "hold:TURN_LEFT"),
    (3, "hold:LOOK_UP"),
];

/// Two moments of each level, once the cave has sunk: at its edge, on the first steps, and looking
/// back from further down.
const MOMENTS: &[Moment] = &[
    at(1, 1, EDGE),
    at(
        1,
        2,
        &[(20, "noop"), (4, "hold:MOVE_FORWARD"), (8, "hold:TURN_RIGHT"), (3, "hold:LOOK_DOWN")],
    ),
    at(2, 1, EDGE),
    at(2, 2, LOOK_BACK),
    at(3, 1, EDGE),
    at(3, 2, LOOK_BACK),
];

/// Makes its worlds.
#[derive(Debug)]
struct Worlds;

fn level(setting: Setting) -> levels::Level {
    levels::level(setting.rules, setting.hard, setting.index())
}

impl Task for Worlds {
    fn controls(&self, setting: Setting) -> Controls {
        level(setting).controls
    }

    fn map(&self, setting: Setting) -> MapSource {
        map::source(map::START_COLUMNS + level(setting).bottom_row as usize - 1)
    }

    fn rules(&self, setting: Setting, map: &Map) -> Result<AnyRules, EnvError> {
        Ok(AnyRules::new(Rules::new(map, level(setting))?))
    }
}
