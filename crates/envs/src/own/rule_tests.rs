//! What rules of a file do, and what of a rule is refused.

use super::check;
use super::tests::{corridor, env, play, stat};

/// Two zones that send the agent to each other send it once a tic.
#[test]
fn a_rule_moves_the_agent_once_a_tic() {
    let portals = "[[when]]\nevent = \"enter\"\nof = \"lava\"\nteleport = \"goal\"\ncount = \"there\"\n\
                   [[when]]\nevent = \"enter\"\nof = \"goal\"\nteleport = \"lava\"\ncount = \"back\"\n";
    for start in ["", "[player]\nin = \"lava\"\n"] {
        let mut env = env(&corridor(&format!("{portals}{start}")), false);
        play(&mut env, "MOVE_FORWARD", 30);
        let (there, back) = (stat(&env, "there"), stat(&env, "back"));
        assert!((1.0..=4.0).contains(&there) && (1.0..=4.0).contains(&back), "{there} {back}");
    }
}

/// What a rule does to the agent is an event like any other.
#[test]
fn a_rule_that_hurts_raises_damage_and_death() {
    let text = corridor(
        "[[when]]\nevent = \"timer\"\nfirst = 40\nhurt = 5\n[[when]]\nevent = \"timer\"\nfirst = 80\nhurt = 500\n\
         [[when]]\nevent = \"damage\"\nby = \"script\"\ncount = \"blows\"\nflat = true\n\
         [[when]]\nevent = \"death\"\nreward = -10\ncount = \"deaths\"\n",
    );
    let mut env = env(&text, false);
    let command = crate::parse_command("").unwrap();
    let (mut total, mut steps) = (0.0, 0);
    loop {
        let step = env.step_buttons(command);
        (total, steps) = (total + step.reward, steps + 1);
        if step.ended() {
            break;
        }
    }
    assert_eq!((stat(&env, "blows"), stat(&env, "deaths"), total), (2.0, 1.0, -10.0));
    assert!(steps < 30, "{steps} steps");
}

/// The published scenarios pass over what happens before the first step; a file's rules do not.
#[test]
fn what_a_file_pays_at_the_start_counts_in_the_first_step() {
    let text = corridor(
        "[[when]]\nevent = \"start\"\nreward = 10\ncost.begin = 3\n[[when]]\nevent = \"timer\"\nfirst = 1\nreward = 0.5\n",
    );
    let mut env = env(&text, false);
    for seed in [1, 2] {
        env.reset(seed);
        let command = crate::parse_command("").unwrap();
        let (first, second) = (env.step_buttons(command), env.step_buttons(command));
        assert_eq!((first.reward, first.cost), (10.5, 3.0));
        assert_eq!((second.reward, second.cost), (0.0, 0.0));
    }
}

/// What would be left out without a word is a mistake, and a counter does not take the name of what
/// every episode has.
#[test]
fn lists_that_are_too_long_and_names_that_are_taken_are_mistakes() {
    let nine = ["\"vials\""; 9].join(", ");
    let many = ["{ of = \"goal\", to = 0 }"; 17].join(", ");
    let vials = "[[spawn]]\nname = \"vials\"\nkind = \"HealthBonus\"\ncount = 0\nin = \"goal\"\n";
    for (rest, named) in [
        (format!("{vials}[[when]]\nevent = \"jump\"\nspawn = [{nine}]\n"), "at most 8 spawns"),
        (format!("[[when]]\nevent = \"jump\"\nfloor = [{many}]\n"), "`floor` has 17 entries"),
        (format!("[[when]]\nevent = \"jump\"\nlight = [{many}]\n"), "`light` has 17 entries"),
        ("[[when]]\nevent = \"jump\"\ncount = \"return\"\n".into(), "`return` is said of every"),
        ("[[when]]\nevent = \"jump\"\ncount = \"cost_lava\"\n".into(), "`cost_lava` is said"),
    ] {
        let checked = check(&corridor(&rest));
        let found = checked.mistakes.iter().any(|one| one.to_string().contains(named));
        assert!(found && !checked.can_be_played(), "{named}: {:?}", checked.mistakes);
    }
}

/// A rectangle has no floor of its own to move, and what lies below it may hurt.
#[test]
fn rectangles_are_no_doors_and_may_lie_over_what_hurts() {
    let zone = "[zones]\npool = { area = [0, 0, 320, 448] }\n";
    for rest in [
        "[[when]]\nevent = \"start\"\nfloor = { of = \"pool\", to = 0 }\n",
        "[[when]]\nevent = \"start\"\nlight = { of = \"pool\", to = 0 }\n",
        "[[light]]\nin = \"pool\"\n",
    ] {
        let checked = check(&corridor(&format!("{zone}{rest}")));
        let found = checked.mistakes.iter().any(|one| one.to_string().contains("is a rectangle"));
        assert!(found, "{rest}: {:?}", checked.mistakes);
    }
    let burns = "[[when]]\nevent = \"damage\"\nby = \"pool\"\nreward = -1\ncost.burn = 1\n";
    assert_eq!(check(&corridor(&format!("{zone}{burns}"))).mistakes, []);
}

/// A counter comes to a number from above too, by counting; to be set back is no arrival.
#[test]
fn counters_count_down() {
    let text = corridor(
        "[[when]]\nevent = \"start\"\nset = { lives = 3, laps = 0 }\n\
         [[when]]\nevent = \"timer\"\nevery = 35\ncount = { lives = -1, laps = 2 }\n\
         [[when]]\nevent = \"counter\"\nof = \"laps\"\nreaches = 3\nset = { laps = 0 }\ncount = \"rounds\"\n\
         [[when]]\nevent = \"counter\"\nof = \"lives\"\nreaches = 0\nreward = -10\nend = \"goal\"\n",
    );
    let mut env = env(&text, false);
    play(&mut env, "", 60);
    let episode = env.episode();
    assert!(episode.terminated && env.world().tic < 115, "{} tics", env.world().tic);
    // Laps come to 3 or more once, at the second count; that they are set from 4 to 0 is no round.
    assert_eq!((episode.episode_return, stat(&env, "rounds")), (-10.0, 1.0));
}

/// A rule of a policy step that finishes the episode is paid once.
#[test]
fn a_steps_cost_that_ends_the_episode_is_paid_once() {
    let text =
        corridor("[[when]]\nevent = \"step\"\ncost.slow = 1.0\n[hard]\nend_on = [\"slow\"]\n");
    let mut env = env(&text, true);
    play(&mut env, "", 10);
    let episode = env.episode();
    assert!(episode.terminated);
    assert_eq!(episode.cost, 1.0);
}

/// `most` counts a spawn's own things, whatever others of their kind there are.
#[test]
fn a_spawn_counts_its_own_things() {
    let both = |first: &str, second: &str| corridor(&format!("{first}{second}"));
    let bad = "[[spawn]]\nname = \"bad\"\nkind = \"Clip\"\ncount = 4\n";
    let good = "[[spawn]]\nname = \"good\"\nkind = \"Clip\"\ncount = 3\nevery = 35\nmost = 5\n";
    for text in [both(bad, good), both(good, bad)] {
        let mut env = env(&text, false);
        play(&mut env, "", 100);
        let clips = env
            .world()
            .living()
            .filter(|(_, thing)| thing.kind == hasard_engine::world::ActorKind::Clip);
        assert_eq!(clips.count(), 9);
    }
}

#[test]
fn what_would_be_taken_for_another_rule_is_refused() {
    let first = |rest: &str| {
        let found = check(&corridor(rest)).mistakes;
        let mut wrong = found.iter().filter(|one| !one.warning);
        let first = wrong.next().unwrap_or_else(|| panic!("{rest}: nothing")).text.clone();
        (first, wrong.count())
    };
    for (rest, words) in [
        ("event = \"damage\"\nof = \"lava\"\ncost.x = 1\n", "by = \"lava\""),
        ("event = \"step\"\nend = \"goal\"\n", "event = \"timer\""),
        ("event = \"start\"\nfloor = { to = 5 }\n", "floor needs a zone"),
        ("event = \"start\"\nlight = { to = 5 }\n", "light needs a zone"),
        ("event = \"timer\"\nfirst = 0\nreward = 1\n", "from 1"),
        // And one mistake is one line, whatever else hangs on it.
        ("event = \"timr\"\nevery = 35\nfirst = 3\nreward = 1\n", "timer"),
        ("event = \"start\"\nreward = \"much\"\n", "reward"),
        ("event = \"start\"\ncost.lava = \"1.0\"\n", "a cost"),
    ] {
        let (text, more) = first(&format!("[[when]]\n{rest}"));
        assert!(text.contains(words), "{rest}: {text}");
        assert_eq!(more, 0, "{rest}: {text}");
    }
    let doubtful = check(&corridor("[[when]]\nevent = \"start\"\nreward = \"much\"\n"));
    assert!(!doubtful.mistakes.iter().any(|one| one.text.contains("does nothing")), "{doubtful:?}");
}
