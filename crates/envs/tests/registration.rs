//! A scenario written in Rust is checked when it is registered, and refused in one line.

use hasard_engine::map::{Map, MapSource};
use hasard_envs::scenarios::{AnyRules, ScenarioSpec, Setting, Task};
use hasard_envs::{Controls, CostTerm, Env, EnvError, EnvOptions, Scenario};

/// A built-in task with other buttons.
#[derive(Debug)]
struct WithButtons(&'static [&'static [&'static str]]);

impl Task for WithButtons {
    fn controls(&self, _setting: Setting) -> Controls {
        Controls { simplified: self.0, full_moves: true, full_speed: true }
    }

    fn map(&self, setting: Setting) -> MapSource {
        Scenario::EXAMPLE.task.map(setting)
    }

    fn rules(&self, setting: Setting, map: &Map) -> Result<AnyRules, EnvError> {
        Scenario::EXAMPLE.task.rules(setting, map)
    }
}

static RIGHT: WithButtons = WithButtons(&[&["JUMP"]]);
static UNKNOWN: WithButtons = WithButtons(&[&["JUMP"], &["FLY"]]);
static NONE: WithButtons = WithButtons(&[&["JUMP"], &[]]);

const TERM: CostTerm = CostTerm { name: "greed", counted: true };

const fn spec(name: &'static str, task: &'static WithButtons) -> ScenarioSpec {
    ScenarioSpec {
        cost_terms: &[TERM],
        textures: Scenario::EXAMPLE.spec().textures,
        ..ScenarioSpec::of(name, "Test", "A test.", task)
    }
}

#[test]
fn what_cannot_be_played_is_refused() {
    static SPECS: [(ScenarioSpec, &str); 6] = [
        (spec("RemedyRush", &RIGHT), "another than those of the benchmark"),
        (spec("two words", &RIGHT), "1 to 40 letters and digits"),
        (spec("FlyingTest", &UNKNOWN), "cannot be FLY;"),
        (spec("EmptyTest", &NONE), "an empty group"),
        (ScenarioSpec { cost_terms: &[TERM, TERM], ..spec("TwiceTest", &RIGHT) }, "greed twice"),
        (ScenarioSpec { cost_terms: &[TERM; 5], ..spec("ManyTest", &RIGHT) }, "5 terms"),
    ];
    for (spec, words) in &SPECS {
        let error = Scenario::register(spec).unwrap_err().to_string();
        assert!(error.contains(words) && error.lines().count() == 1, "{}: {error}", spec.name);
        let known = Scenario::every().iter().any(|known| known.title == "Test");
        assert!(!known, "{} is registered all the same", spec.name);
    }
    static SPEC: ScenarioSpec = spec("RightTest", &RIGHT);
    Scenario::register(&SPEC).unwrap();
    let env = Env::new("RightTestLevel2-v0", &EnvOptions::default()).unwrap();
    assert_eq!(env.action_space().names(), "JUMP");
}
