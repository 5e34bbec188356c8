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
