//! What a person needs to know before playing: what to do, what to avoid, which keys there are.

use hasard_envs::scenarios::Guide;
use hasard_envs::{ActionSpace, Scenario};

/// What the scenario of an environment asks; `None` of a task that is not part of hasard.
#[must_use]
pub fn task(env: &str) -> Option<Guide> {
    let scenario = env.split("Level").next().unwrap_or_default();
    Scenario::ALL.into_iter().find(|known| known.name == scenario)?.guide
}

/// Keys, the buttons that each presses, and what comes of it.
const KEYS: [(&str, &[&str], &str); 12] = [
    ("W", &["MOVE_FORWARD"], "forward"),
    ("S", &["MOVE_BACKWARD"], "back"),
    ("A D", &["MOVE_LEFT", "MOVE_RIGHT"], "sideways"),
    ("left right", &["TURN_LEFT", "TURN_RIGHT"], "turn"),
    ("up down", &["LOOK_UP", "LOOK_DOWN"], "look up and down"),
    ("Space", &["JUMP"], "jump"),
    ("Shift", &["SPEED"], "run"),
    ("Ctrl, left button", &["ATTACK"], "fire"),
    ("E, right button", &["USE"], "use"),
    ("C", &["CROUCH"], "crouch"),
    ("Q, wheel", &["SELECT_NEXT_WEAPON", "SELECT_PREV_WEAPON"], "change weapon"),
    ("T", &["TURN180"], "turn round"),
];

const ALWAYS: [(&str, &str); 6] = [
    ("Enter", "begin, go on, next episode"),
    ("P", "pause"),
    ("R", "the same episode again"),
    ("N", "next episode"),
    ("H", "these keys"),
    ("Esc", "free the mouse; quit"),
];

/// The keys that do something in an action space, and what each does.
#[must_use]
pub fn keys(space: &ActionSpace) -> Vec<(&'static str, &'static str)> {
    let has = |name: &str| {
        space.groups.iter().any(|group| group.buttons.iter().any(|(known, _)| *known == name))
    };
    let turns = !space.deltas.is_empty() || has("TURN_LEFT");
    KEYS.iter()
        .filter(|(_, buttons, _)| buttons.iter().any(|name| has(name)))
        .map(|(key, _, what)| (*key, *what))
        .chain(turns.then_some(("mouse", "turn and look, once the window was clicked")))
        .chain(ALWAYS)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use hasard_envs::{Env, EnvId, EnvOptions};

    #[test]
    fn every_scenario_says_what_to_do_and_the_page_says_the_same() {
        let page = include_str!("../../serve/src/pages/tasks.js");
        for id in EnvId::every() {
            let task = task(&id.to_string()).unwrap();
            assert!(page.contains(task.collect) && page.contains(task.avoid), "{id}");
            assert!(page.contains(&format!("'{}', {}]", task.avoid, task.seed)), "{id}");
        }
        assert_eq!(task("my_task.toml"), None);
    }

    #[test]
    fn keys_are_those_of_the_action_space() {
        let space = |full| {
            let options = EnvOptions { full_actions: full, ..EnvOptions::default() };
            Env::new("RemedyRushLevel1-v0", &options).unwrap().action_space().clone()
        };
        let named = |space: &ActionSpace, key: &str| keys(space).iter().any(|(one, _)| *one == key);
        assert!(named(&space(false), "W") && !named(&space(false), "Ctrl, left button"));
        assert!(named(&space(true), "Ctrl, left button") && named(&space(true), "mouse"));
    }
}
