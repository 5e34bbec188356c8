//! What Volcanic Venture is to everything else.

use crate::error::EnvError;
use crate::scenarios::common::rules::AnyRules;
use crate::scenarios::common::spec::{Guide, Moment, ScenarioSpec, Setting, Task, at};
use crate::scenarios::volcanic_venture::rules::{COST_TERMS, Rules, TEXTURES};
use crate::scenarios::volcanic_venture::{levels, map};
use crate::spaces::action::Controls;
use hasard_engine::map::{Map, MapSource};

/// All that is known of it.
pub static SPEC: ScenarioSpec = ScenarioSpec {
    cost_terms: COST_TERMS,
    textures: TEXTURES,
    prompt: true,
    paper_place: 1,
    number: 5,
    moments: (MOMENTS, 4),
    guide: Some(Guide {
        collect: "Pick up items; jump from platform to platform.",
        avoid: "the lava",
        seed: 12,
    }),
    published_stats: &[("episode_cost", None)],
    ..ScenarioSpec::of(
        "VolcanicVenture",
        "Volcanic Venture",
        "Collect items on platforms in a lake of lava.",
        &Worlds,
    )
};

/// Two moments of each level.
const MOMENTS: &[Moment] = &[
    at(1, 1, &[(130, "sticky:10")]),
    at(1, 2, &[(60, "sticky:10")]),
    at(2, 1, &[(130, "sticky:10")]),
    at(2, 4, &[(60, "sticky:10")]),
    at(3, 2, &[(10, "sticky:10")]),
    at(3, 1, &[(130, "sticky:10")]),
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

    fn map(&self, _: Setting) -> MapSource {
        map::source()
    }

    fn rules(&self, setting: Setting, map: &Map) -> Result<AnyRules, EnvError> {
        Ok(AnyRules::new(Rules::new(map, level(setting))?))
    }
}
