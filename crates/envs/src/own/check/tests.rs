use crate::own::check;
use crate::own::tests::corridor;

/// Whether a corridor with these lines warns in these words; it can be played in any case.
fn warned(rest: &str, words: &str) -> bool {
    warned_of(&corridor(rest), words)
}

fn warned_of(text: &str, words: &str) -> bool {
    let checked = check(text);
    assert!(checked.can_be_played(), "{:#?}", checked.mistakes);
    checked.mistakes.iter().any(|one| one.warning && one.text.contains(words))
}

/// A thing of a kind in the world and a rule about it.
fn rule_about(event: &str, kind: &str) -> String {
    format!(
        "[[spawn]]\nkind = \"{kind}\"\n[[when]]\nevent = \"{event}\"\nof = \"{kind}\"\nreward = 1\n"
    )
}

#[test]
fn what_nobody_can_take_or_shoot_is_named() {
    for (event, kind, possible) in [
        ("pickup", "TechLamp", false),
        ("pickup", "ZombieMan", false),
        ("pickup", "HealthBonus", true),
        ("pickup", "Shotgun", true),
        ("kill", "HealthBonus", false),
        ("kill", "ZombieMan", true),
        ("hit", "TechLamp", false),
        ("hit", "ExplosiveBarrel", true),
        ("near", "TechLamp", true),
    ] {
        let rest = rule_about(event, kind);
        assert_eq!(warned(&rest, "this never happens: nobody can"), !possible, "{event} {kind}");
    }
    let of_a_map = corridor("").replace("#.@.#", "#.@l#")
        + "l = { like = \".\", thing = \"TechLamp\" }\n[[when]]\nevent = \"pickup\"\nof = \"TechLamp\"\nreward = 1\n";
    assert!(warned_of(&of_a_map, "nobody can pick up such a thing"));
    let absent = "[[when]]\nevent = \"kill\"\nof = \"ZombieMan\"\nreward = 1\n";
    assert!(warned(absent, "no such thing ever appears"));
}

#[test]
fn a_shot_needs_a_weapon() {
    let shot = |player: &str| {
        corridor(&format!("{player}[[when]]\nevent = \"shot\"\nreward = 1\n"))
            .replace("[\"USE\"]", "[\"ATTACK\"]")
    };
    assert!(warned_of(&shot(""), "the agent has no weapon"));
    assert!(!warned_of(&shot("[player]\nweapons = [\"Pistol\"]\n"), "never happens"));
    assert!(!warned_of(&shot("[[spawn]]\nkind = \"Shotgun\"\n"), "never happens"));
    assert!(warned("[[when]]\nevent = \"shot\"\nreward = 1\n", "no action is ATTACK"));
}

/// The corridor is 5 tiles of 64 wide and 6 high, with rock around it; episodes have 700 tics.
#[test]
fn places_off_the_map_and_times_after_the_end_are_named() {
    let zone = |area: &str, rule: &str| {
        format!("[zones]\nfar = {{ area = [{area}] }}\n[[when]]\n{rule}\nreward = 1\n")
    };
    let enter = "event = \"enter\"\nof = \"far\"";
    let within = "event = \"jump\"\nin = \"far\"";
    for rule in [enter, within] {
        for (area, somewhere) in [
            ("4000, 0, 5000, 64", false),
            ("-500, -500, -10, -10", false),
            ("0, 0, 320, 64", false),
            ("0, 0, 320, 65", true),
        ] {
            let said = warned(&zone(area, rule), "zone far is a rectangle without ground");
            assert_eq!(said, !somewhere, "{area}: {rule}");
        }
    }
    let timer = |rest: &str| format!("[[when]]\nevent = \"timer\"\n{rest}\nreward = 1\n");
    assert!(warned(&timer("first = 701"), "its first time is tic 701, and an episode has 700"));
    assert!(warned(&timer("every = 2000"), "its first time is tic 2000"));
    assert!(!warned(&timer("first = 700"), "never happens"));
    // In one of the levels it happens.
    let longer = timer("first = 701") + "[levels.2]\nscenario.tics = 1400\n";
    assert!(!warned(&longer, "never happens"));
}

#[test]
fn costs_that_stay_zero_and_a_budget_without_costs_are_warned_of() {
    let timer = |rest: &str| format!("[[when]]\nevent = \"timer\"\nevery = 35\nreward = 1\n{rest}");
    assert!(warned(&timer("cost.time = 0\n"), "cost term time is always 0"));
    assert!(!warned(&timer("cost.time = 0.5\n"), "cost term"));
    assert!(warned("[costs.time]\n", "cost term time is charged by no [[when]]"));
    let budget = |rest: &str| corridor(rest).replace("tics = 700\n", "tics = 700\nbudget = 5\n");
    assert!(warned_of(&budget(&timer("")), "every episode keeps the budget of 5"));
    assert!(!warned_of(&budget(&timer("cost.time = 1\n")), "budget"));
    assert!(!warned(&timer(""), "budget"));
}

#[test]
fn what_a_map_does_not_ask_for_is_warned_of() {
    let built_in = "[scenario]\nname = \"T\"\n[map]\nbuiltin = \"RemedyRush\"\ntile = 32\nlegend.x.floor = 8\n";
    assert!(warned_of(built_in, "`tile` has no effect here"));
    assert!(warned_of(built_in, "`legend` has no effect here"));
    assert!(warned_of(&corridor("").replace("[map]\n", "[map]\nlevel = 2\n"), "`level` has no"));
    let maze = "[scenario]\nname = \"T\"\n[map]\ntile = 96\n[map.generate]\nkind = \"maze\"\n\
                [map.legend]\n\".\" = { light = 99 }\n\"#\" = { wall = \"BIGBRIK1\" }\nx = { thing = \"Clip\" }\n";
    assert!(warned_of(maze, "`x` has no effect here: it is for maps that are drawn"));
    assert!(!warned_of(&maze.replace("x = { thing = \"Clip\" }\n", ""), "no effect"));
    // The first level is drawn: there the tiles and letters count.
    assert!(!warned("[levels.2.map.generate]\nkind = \"maze\"\n", "no effect"));
    assert!(warned("[levels.3]\nscenario.tics = 70\n", "there is no [levels.2]"));
    assert!(!warned("[levels.2]\nscenario.tics = 70\n", "there is no [levels"));
}

/// What is wrong with a value says what was given, and a zone that nobody drew how to draw one.
#[test]
fn a_number_in_quotes_and_a_zone_of_nothing_have_their_remedy() {
    let first = |text: &str| check(text).mistakes.into_iter().next().unwrap().text;
    let text = |tics: &str| corridor("").replace("tics = 700", &format!("tics = {tics}"));
    assert!(first(&text("\"700\"")).ends_with("1 to 1000000, without quotes"));
    assert!(first(&text("[700]")).ends_with("1 to 1000000, not a list"));
    assert!(first(&text("0")).ends_with("1 to 1000000"));
    let bare = "[scenario]\nname = \"T\"\n[map]\nascii = \"#@#\"\n[[when]]\nevent = \"in\"\nof = \"lava\"\nreward = 1\n";
    assert!(first(bare).ends_with("give its letter of the legend zone = \"lava\""));
}
