use crate::own::check;
use crate::own::tests::corridor;

/// What a level changes can make a mistake of a line that all levels have: it says of which, once, and
/// what is wrong everywhere or written in the level itself names none.
#[test]
fn a_mistake_of_one_setting_names_it() {
    let listed = |rest: &str| -> Vec<String> {
        let lava = "[[when]]\nevent = \"damage\"\nby = \"lava\"\nreward = 1\n";
        check(&corridor(&format!("{lava}{rest}")))
            .mistakes
            .into_iter()
            .map(|one| one.text)
            .collect()
    };
    assert_eq!(listed(""), [""; 0]);
    for (rest, setting) in [
        ("[levels.2]\nmap.legend.\"~\".zone = \"water\"\n", "level 2: "),
        ("[hard]\nmap.legend.\"~\".zone = \"water\"\n", "--hard: "),
        ("[levels.2.hard]\nmap.legend.\"~\".zone = \"water\"\n", "level 2, --hard: "),
        ("[levels.1]\nmap.legend.\"~\".zone = \"water\"\n[levels.2]\n", "level 1: "),
        ("[levels.1.hard]\nmap.legend.\"~\".zone = \"water\"\n[levels.2]\n", "level 1, --hard: "),
        ("[hard]\nmap.legend.\"~\".zone = \"water\"\n[levels.2]\n", "--hard: "),
        (
            "[levels.2]\nmap.legend.\"~\".zone = \"water\"\n[levels.3]\nmap.legend.\"~\".zone = \"water\"\n",
            "levels 2, 3: ",
        ),
        ("[rules.tables]\nmap.legend.\"~\".zone = \"water\"\n", "--rules tables: "),
        ("[levels.2]\nspawn = [{ kind = \"Nothing\" }]\n", "kind of thing `Nothing`"),
    ] {
        let listed = listed(rest);
        assert_eq!(listed.len(), 1, "{rest}: {listed:?}");
        assert!(listed[0].starts_with(setting), "{rest}: {listed:?}");
    }
    let everywhere = listed("[[when]]\nevent = \"damage\"\nby = \"water\"\n[levels.2]\n");
    assert_eq!(everywhere.len(), 1, "{everywhere:?}");
    assert!(!everywhere[0].contains("level"), "{everywhere:?}");
}

/// A word that is far from all known ones names none of them; one that is cut short names the whole.
#[test]
fn only_a_word_that_is_near_is_called_the_nearest() {
    let buttons = crate::spaces::action::BUTTONS.map(|(name, _)| name);
    for (word, near) in [
        ("FLY", None),
        ("ATTAK", Some("ATTACK")),
        ("attack", Some("ATTACK")),
        ("TURN_LEF", Some("TURN_LEFT")),
        ("MOVE_FORW", Some("MOVE_FORWARD")),
        ("X", None),
        ("", None),
    ] {
        let said = super::unknown("button", word, buttons);
        match near {
            Some(near) => assert!(said.ends_with(&format!("the nearest is `{near}`")), "{said}"),
            None => assert!(said.contains("write one of"), "{said}"),
        }
    }
}
