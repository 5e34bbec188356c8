//! Files that are read, refused and played.

use super::{check, register, template};
use crate::{Env, EnvOptions, FrameSize, RuleSet};

/// A world of a file, small to draw.
pub(super) fn env(text: &str, hard: bool) -> Env {
    let checked = check(text);
    assert!(checked.can_be_played(), "{:#?}", checked.mistakes);
    let scenario = register("test.toml", text).unwrap();
    let size = FrameSize { width: 64, height: 48 };
    let id = scenario.environments().next().unwrap().to_string();
    Env::new(&id, &EnvOptions { scenario: Some(scenario), hard, size, ..EnvOptions::default() })
        .unwrap()
}

pub(super) fn play(env: &mut Env, buttons: &str, steps: usize) {
    let command = crate::parse_command(buttons).unwrap();
    for _ in 0..steps {
        env.step_buttons(command);
    }
}

pub(super) fn stat(env: &Env, name: &str) -> f64 {
    env.stats()
        .into_iter()
        .find(|(known, _)| *known == name)
        .unwrap_or_else(|| panic!("no statistic {name}"))
        .1
}

/// A corridor to the north of the start, with lines of `[[spawn]]` and `[[when]]` added.
pub(super) fn corridor(rest: &str) -> String {
    format!(
        "[scenario]\nname = \"Corridor\"\ntics = 700\nactions = [[\"MOVE_FORWARD\"], [\"JUMP\"], [\"USE\"]]\n\
         [map]\nascii = \"\"\"\n#####\n#ggg#\n#...#\n#~~~#\n#...#\n#.@.#\n#####\"\"\"\n\
         [map.legend]\n\"~\" = {{ like = \".\", zone = \"lava\", damage = {{ points = 2, every = 4 }} }}\n\
         g = {{ like = \".\", zone = \"goal\" }}\n{rest}"
    )
}

#[test]
fn the_file_to_begin_with_has_nothing_to_mend_and_plays() {
    let text = template("Garden");
    assert_eq!(check(&text).mistakes, []);
    let mut env = env(&text, false);
    assert_eq!(env.id().to_string(), "Garden-v0");
    let items = env
        .world()
        .living()
        .filter(|(_, thing)| thing.kind == hasard_engine::world::ActorKind::HealthBonus)
        .count();
    assert_eq!(items, 12);
    play(&mut env, "MOVE_FORWARD", 40);
    assert_eq!(env.episode_steps(), 525);
}

#[test]
fn zones_floors_and_counters_do_what_the_file_says() {
    let text = corridor(
        "[[when]]\nevent = \"damage\"\nby = \"lava\"\ncost.lava = 1.0\ncount = \"burns\"\n\
         [[when]]\nevent = \"enter\"\nof = \"goal\"\nreward = 5.0\ncount = \"goals\"\n\
         [[when]]\nevent = \"counter\"\nof = \"goals\"\nreaches = 1\nend = \"goal\"\n\
         [[when]]\nevent = \"step\"\nreward = -0.25\n[hard]\nend_on = [\"lava\"]\n",
    );
    let mut soft = env(&text, false);
    play(&mut soft, "MOVE_FORWARD", 40);
    let episode = soft.episode();
    assert!(episode.terminated && !episode.truncated);
    // Two points at each hit.
    assert!(episode.cost > 0.0 && episode.cost == 2.0 * stat(&soft, "burns"), "{episode:?}");
    assert_eq!(episode.episode_return, 5.0 - 0.25 * f64::from(episode.length));
    assert_eq!(stat(&soft, "health"), 100.0 - episode.cost);
    // Under the hard constraint the lava ends it, before the goal.
    let mut hard = env(&text, true);
    play(&mut hard, "MOVE_FORWARD", 40);
    assert!(
        hard.episode().terminated
            && stat(&hard, "goals") == 0.0
            && hard.episode().length < episode.length
    );
}

#[test]
fn items_come_back_timers_run_and_conditions_hold() {
    let text = corridor(
        "[[spawn]]\nname = \"vial\"\nkind = \"HealthBonus\"\nin = [64, 64, 256, 192]\ncount = 3\nrespawn = 10\n\
         [[when]]\nevent = \"pickup\"\nof = \"vial\"\nreward = 1.0\ncount = { taken = 2 }\n\
         [[when]]\nevent = \"timer\"\nevery = 35\ncount = \"seconds\"\nif = { seconds = [0, 3] }\n\
         [[when]]\nevent = \"jump\"\ncount = \"jumps\"\n[[when]]\nevent = \"use\"\ncount = \"uses\"\n\
         [[when]]\nevent = \"start\"\nset = { uses = 10 }\n[[when]]\nevent = \"near\"\nof = \"vial\"\nwithin = 4000\nonce = true\n\
         count = \"seen\"\n",
    );
    let mut env = env(&text, false);
    play(&mut env, "JUMP", 60);
    play(&mut env, "USE", 10);
    play(&mut env, "noop", 2);
    play(&mut env, "USE", 10);
    assert_eq!((stat(&env, "seconds"), stat(&env, "uses"), stat(&env, "seen")), (4.0, 12.0, 1.0));
    assert!(stat(&env, "jumps") >= 3.0);
    // The area holds the start: in time one comes to lie under the agent's feet, and it is taken.
    let vials = |env: &Env| env.world().living().filter(|(_, thing)| thing.tid == 1).count();
    assert_eq!(stat(&env, "taken"), 2.0 * env.episode().episode_return);
    assert!((2..=3).contains(&vials(&env)));
}

#[test]
fn snapshots_and_equal_seeds_bring_equal_episodes() {
    let text = template("Again");
    let (mut one, mut other) = (env(&text, false), env(&text, false));
    one.reset(5);
    other.reset(5);
    play(&mut one, "MOVE_FORWARD+TURN_LEFT", 30);
    let kept = one.snapshot();
    play(&mut one, "MOVE_FORWARD", 30);
    play(&mut other, "MOVE_FORWARD+TURN_LEFT", 30);
    assert_eq!(other.restore(&kept), Ok(()));
    play(&mut other, "MOVE_FORWARD", 30);
    assert_eq!(one.state_hash(), other.state_hash());
    other.reset(6);
    play(&mut other, "MOVE_FORWARD+TURN_LEFT", 30);
    assert_ne!(one.state_hash(), other.state_hash());
}

#[test]
fn generated_maps_differ_by_seed_and_monsters_walk() {
    for kind in ["maze", "rooms", "columns", "platforms"] {
        let text = format!(
            "[scenario]\nname = \"Made\"\n[map]\ntile = 96\n[map.generate]\nkind = \"{kind}\"\n\
             [[spawn]]\nname = \"imps\"\nkind = \"DoomImp\"\ncount = 3\ngoal = \"wander\"\n\
             [[spawn]]\nkind = \"ArmorBonus\"\ncount = 5\n[[when]]\nevent = \"pickup\"\nof = \"ArmorBonus\"\nreward = 1.0\n\
             [[when]]\nevent = \"near\"\nof = \"imps\"\nwithin = 60\ncooldown = 35\ncost.met = 1.0\n"
        );
        let mut env = env(&text, false);
        let floors = |env: &Env| {
            env.world().sectors().map(|sector| sector.floor.floor()).collect::<Vec<_>>()
        };
        let imps = |env: &Env| {
            let living = env
                .world()
                .living()
                .filter(|(_, thing)| thing.kind == hasard_engine::world::ActorKind::DoomImp);
            living.map(|(_, thing)| (thing.x, thing.y)).collect::<Vec<_>>()
        };
        env.reset(1);
        let (first, stood) = (floors(&env), imps(&env));
        assert_eq!(stood.len(), 3, "{kind}");
        play(&mut env, "MOVE_FORWARD", 60);
        assert!(imps(&env) != stood, "{kind}: no imp has moved");
        env.reset(2);
        assert_ne!(floors(&env), first, "{kind}");
        env.reset(1);
        assert_eq!(floors(&env), first, "{kind}");
    }
}

/// What each spoiled file says, with the line that it points at.
#[test]
fn mistakes_are_named_with_their_place_and_remedy() {
    let good = template("Good");
    for (from, to, said) in [
        ("kind = \"HealthBonus\"", "kind = \"HelthBonus\"", "HealthBonus"),
        ("event = \"damage\"", "event = \"damaged\"", "damage"),
        ("by = \"lava\"", "by = \"lawa\"", "lava"),
        ("count = 12", "cuont = 12", "count"),
        ("tics = 2100", "tics = -1", "1 to 1000000"),
        ("name = \"Good\"", "name = \"Two words\"", "letters and digits"),
        ("end_on = [\"lava\"]", "end_on = [\"fire\"]", "lava"),
        ("#......#.......#\n#..~~", "#..x...#.......#\n#..~~", "no letter `x`"),
        ("\"LAVA1\"", "\"LAVA99\"", "LAVA"),
        ("reward = 1.0", "reward = \"much\"", "number"),
        ("[player]", "[playr]", "player"),
        ("tile = 64", "tile = = 64", "toml.io"),
    ] {
        let text = good.replacen(from, to, 1);
        // The line of the first letter that was changed.
        let changed = good.bytes().zip(text.bytes()).position(|(one, other)| one != other).unwrap();
        let line = text[..changed].matches('\n').count() + 1;
        assert_ne!(text, good, "{from}");
        let checked = check(&text);
        assert!(!checked.can_be_played(), "{to}");
        let first = &checked.mistakes[0];
        assert!(first.line == line && first.text.contains(said), "{to}: {first}");
        let line = register("x.toml", &text).unwrap_err().to_string();
        assert!(line.starts_with("x.toml:") && !line.contains('\n'), "{line}");
    }
}

#[test]
fn all_mistakes_are_listed_at_once_and_what_never_happens_is_warned_of() {
    let text = template("Many")
        .replace("\"HealthBonus\"", "\"Helth\"")
        .replace("\"pickup\"", "\"pick\"")
        .replace("\"TechLamp\"", "\"Lamp\"");
    let mistakes = check(&text).mistakes;
    assert_eq!(mistakes.iter().filter(|mistake| !mistake.warning).count(), 3, "{mistakes:#?}");
    let rest = "[[when]]\nevent = \"pickup\"\nof = \"Medikit\"\nreward = 1.0\n[[when]]\nevent = \"shot\"\ncount = \"shots\"\n\
                [[when]]\nevent = \"counter\"\nof = \"keys\"\nreaches = 2\nend = \"goal\"\n[[spawn]]\nkind = \"Clip\"\ncount = 0\n";
    let checked = check(&corridor(rest));
    assert!(checked.can_be_played());
    assert_eq!(
        checked.mistakes.iter().filter(|mistake| mistake.warning).count(),
        4,
        "{:#?}",
        checked.mistakes
    );
}

#[test]
fn names_of_the_benchmark_are_not_taken() {
    let text = template("RemedyRush");
    let refused = register("x.toml", &text).unwrap_err().to_string();
    assert!(refused.contains("is a scenario of the benchmark"), "{refused}");
}

/// A condition on a counter that nothing counts can never hold; without a start the agent stands
/// anywhere.
#[test]
fn conditions_that_never_hold_and_a_missing_start_are_warned_of() {
    let rest = "[[when]]\nevent = \"timer\"\nevery = 35\nreward = 1.0\ncount = \"stage\"\n\
                [[when]]\nevent = \"timer\"\nevery = 70\nif = { stge = 2 }\nreward = 1.0\n";
    let warned = |text: &str, words: &str| {
        let checked = check(text);
        assert!(checked.can_be_played(), "{:#?}", checked.mistakes);
        checked.mistakes.iter().any(|one| one.warning && one.text.contains(words))
    };
    let text = corridor(rest);
    assert!(warned(&text, "nothing counts stge"));
    assert!(!warned(&text.replace("stge", "stage"), "nothing counts"));
    assert!(!warned(&text, "no tile is a start"));
    assert!(warned(&text.replace('@', "."), "no tile is a start"));
}

#[test]
fn what_hurts_has_one_name_in_files_and_in_events() {
    let of = |name: &str| {
        corridor(&format!(
            "[[when]]\nevent = \"damage\"\nby = [\"{name}\"]\ncost = {{ hurt = 1 }}\n"
        ))
    };
    let unknown = |name: &str| {
        let mistakes = check(&of(name)).mistakes;
        mistakes.into_iter().find(|mistake| mistake.text.contains("source of damage"))
    };
    // A fall has an event of its own.
    let known = crate::DAMAGE_CAUSES.into_iter().filter(|name| *name != "fall");
    // Files from before say `rule`.
    for name in known.chain(["rule"]) {
        assert_eq!(unknown(name), None, "{name}");
    }
    assert!(unknown("wind").unwrap().text.contains("script"));
}

/// What would be read past, or read otherwise than it is written.
#[test]
fn what_would_hold_nowhere_is_refused() {
    let timer = "[[when]]\nevent = \"timer\"\nevery = 35\ncount = \"x\"\nreward = 1.0\n";
    for (rest, words) in [
        ("[zones]\nx = { area = [0, 0, -1, -1] }\n".to_owned(), "west below east"),
        ("[zones]\nx = { tags = [5, 2] }\n".to_owned(), "[2, 5]"),
        (format!("{timer}if = {{ x = [5, 2] }}\n"), "[2, 5]"),
        ("[levels.2.levels.3]\nend_on = []\n".to_owned(), "[levels] within [levels]"),
        ("[hard.rules.paper.hard]\nend_on = []\n".to_owned(), "[hard] within [hard]"),
        ("[hard.levels.2]\nend_on = []\n".to_owned(), "the levels are 1 to 1"),
        ("[levels.2.rules.peper]\nend_on = []\n".to_owned(), "paper"),
        ("[levels.2]\nscenario.name = \"X\"\n".to_owned(), "one name"),
        ("[levels.2]\n\"scenario.name\" = \"X\"\n".to_owned(), "one name"),
        ("[hard]\nscenario = { name = \"X\" }\n".to_owned(), "one name"),
        ("[levels.2]\nscenario.title = \"X\"\n".to_owned(), "one title"),
        ("[rules.tables]\nscenario.summary = \"X\"\n".to_owned(), "one summary"),
        ("[levels.2]\nscenario.budget = 3\n".to_owned(), "one budget"),
        ("[hard]\n\"scenario.budget\" = 3\n".to_owned(), "one budget"),
    ] {
        let mistakes = check(&corridor(&rest)).mistakes;
        let wrong: Vec<_> = mistakes.iter().filter(|one| !one.warning).collect();
        assert!(wrong.len() == 1 && wrong[0].text.contains(words), "{rest}: {mistakes:#?}");
    }
    for rest in [
        "[levels.2]\nscenario.name = \"Corridor\"\nscenario.tics = 70\n[levels.2.hard]\nend_on = []\n",
        "[rules.released.levels.1]\nend_on = []\n[hard.rules.paper]\nend_on = []\n",
    ] {
        let checked = check(&corridor(rest));
        assert!(checked.can_be_played(), "{rest}: {:#?}", checked.mistakes);
    }
}

/// The first level's of the paper's rules held under all rules.
#[test]
fn a_rule_set_may_have_another_budget() {
    let text = corridor("[rules.tables]\nscenario.budget = 7\n");
    let scenario = register("budgets.toml", &text).unwrap();
    let paper = scenario.safety_budget(RuleSet::Paper);
    assert_eq!((scenario.safety_budget(RuleSet::Tables), paper == 7.0), (7.0, false));
}

#[test]
fn two_maps_are_named() {
    let text = corridor("").replace("[map]\n", "[map]\nbuiltin = \"RemedyRush\"\n");
    let first = &check(&text).mistakes[0];
    assert!(first.text.contains("has both, ascii and builtin"), "{first}");
    let first = &check(&text.replace("[map]\n", "[map]\nwad = \"x.wad\"\n")).mistakes[0];
    assert!(first.text.contains("has 3, ascii and builtin and wad"), "{first}");
}

/// The agent and the places that monsters walk to are no kinds to put down.
#[test]
fn hidden_kinds_are_never_named() {
    for word in ["DoomPlayer", "PatrolPoint", "DoomPlayr", "Nothing"] {
        let text = corridor(&format!(
            "[[spawn]]\nkind = \"{word}\"\n[[when]]\nevent = \"kill\"\nof = \"{word}x\"\nreward = 1.0\n"
        ));
        let mistakes = check(&text).mistakes;
        let wrong: Vec<_> = mistakes.iter().filter(|one| !one.warning).collect();
        assert_eq!(wrong.len(), 2, "{mistakes:#?}");
        for one in wrong {
            let (_, remedy) = one.text.split_once("is unknown; ").unwrap();
            assert!(!remedy.contains("DoomPlayer") && !remedy.contains("Patrol"), "{one}");
        }
    }
}

/// A level may be drawn, made anew, or of a scenario of the benchmark, whatever the others are.
#[test]
fn a_level_may_have_another_kind_of_map() {
    let maze = "[levels.2.map.generate]\nkind = \"maze\"\ncolumns = 9\nrows = 9\n";
    let built_in = "[levels.3]\n\"map.builtin\" = \"RemedyRush\"\n";
    let checked = check(&corridor(&format!("{maze}{built_in}")));
    assert!(checked.can_be_played(), "{:#?}", checked.mistakes);
    let two = corridor("[levels.2.map]\nbuiltin = \"RemedyRush\"\nwad = \"x.wad\"\n");
    assert!(check(&two).mistakes[0].text.contains("has both, builtin and wad"));
}

#[test]
fn no_room_for_the_agent_is_warned_of() {
    let warned = |text: &str, words: &str| {
        let checked = check(text);
        assert!(checked.can_be_played(), "{:#?}", checked.mistakes);
        checked.mistakes.iter().any(|one| one.warning && one.text.contains(words))
    };
    let start = |ceiling| {
        corridor(&format!("\"@\" = {{ like = \".\", start = true, ceiling = {ceiling} }}\n"))
    };
    assert!(warned(&start(55), "55 from floor to ceiling at its start `@`"));
    assert!(!warned(&start(56), "from floor to ceiling"));
    let platforms = |high| {
        corridor(&format!("[levels.2.map.generate]\nkind = \"platforms\"\nheights = [0, {high}]\n"))
    };
    assert!(warned(&platforms(73), "below the ceiling of 128"));
    assert!(!warned(&platforms(72), "below the ceiling"));
}

#[test]
fn fields_without_effect_are_warned_of() {
    let warned = |rest: &str, words: &str| {
        let checked = check(&corridor(rest));
        assert!(checked.can_be_played(), "{:#?}", checked.mistakes);
        checked.mistakes.iter().any(|one| one.warning && one.text.contains(words))
    };
    let spawn = |rest: &str| format!("[[spawn]]\nkind = \"Clip\"\n{rest}\n");
    assert!(warned(&spawn("each = 3"), "`each` has no effect without `every`"));
    assert!(!warned(&spawn("each = 3\nevery = 35"), "no effect"));
    assert!(warned("[player]\nheight = 8\n", "`height` has no effect without `in`"));
    assert!(warned("[player]\nin = [4000, 4000, 5000, 5000]\n", "no room for the agent"));
    assert!(!warned("[player]\nin = \"goal\"\nheight = 8\n", "no effect"));
    assert!(!warned("[player]\nin = \"goal\"\nheight = 8\n", "no room"));
    let rock = "\"g\" = { like = \"#\", thing = \"Clip\", zone = \"goal\" }\n";
    let rules = "[[when]]\nevent = \"pickup\"\nof = \"Clip\"\nreward = 1\n[[when]]\nevent = \"in\"\nof = \"goal\"\nreward = 1\n";
    let walled = corridor("").replace("g = { like = \".\", zone = \"goal\" }\n", rock) + rules;
    let never = check(&walled).mistakes;
    let never = never.iter().filter(|one| one.warning && one.text.contains("this never happens"));
    assert_eq!(never.count(), 2);
    assert!(warned("[[when]]\nevent = \"jump\"\nover = 1\nreward = 1\n", "`over` is for"));
    assert!(!warned("[[when]]\nevent = \"land\"\nover = 1\nreward = 1\n", "`over` is for"));
    let both = "[[spawn]]\nkind = \"ZombieMan\"\ngoal = \"chase\"\npatrol = [\"goal\"]\n";
    let both = check(&corridor(both)).mistakes;
    assert!(both.iter().any(|one| !one.warning && one.text.contains("leave one out")), "{both:?}");
    let shot = check(&corridor("r = { like = \".\", thing = \"Rocket\" }\n")).mistakes;
    assert!(shot.iter().any(|one| !one.warning && one.text.contains("[[spawn]]")), "{shot:?}");
    assert!(warned(&spawn("health = 30"), "`health` has no effect"));
    assert!(!warned("[[spawn]]\nkind = \"ZombieMan\"\nhealth = 30\n", "no effect"));
    let maze = "[levels.2.map.generate]\nkind = \"maze\"\n";
    assert!(warned(&format!("{maze}share = 0.3\n"), "`share` has no effect here"));
    assert!(!warned(&format!("{maze}loops = 0.3\n"), "no effect"));
}

#[test]
fn a_map_too_wide_and_a_zone_called_free_are_refused_at_their_place() {
    let wide =
        corridor("").replace("[map]\n", "[map]\ntile = 512\n").replace("#####", &"#".repeat(32));
    let first = &check(&wide).mistakes[0];
    assert!(first.text.contains("at most 31 a side") && first.line > 1, "{first}");
    let free = corridor("[zones]\nfree = { area = [0, 0, 64, 64] }\n");
    let found = check(&free).mistakes;
    assert!(
        found.iter().any(|one| !one.warning && one.text.starts_with("`free` is every place")),
        "{found:#?}"
    );
}
