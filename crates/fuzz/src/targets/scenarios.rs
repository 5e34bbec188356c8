//! Files of own scenarios.

use super::{Target, assert_presentable, nothing_to_repair};
use hasard_envs::own;

/// TOML files, each read, and where it can be played, played for two seconds.
pub const SCENARIO: Target = Target {
    name: "scenario",
    samples: || {
        let examples = [
            include_str!("../../../../scenarios/health_gathering.toml"),
            include_str!("../../../../scenarios/my_way_home.toml"),
            include_str!("../../../../scenarios/defend_the_centre.toml"),
            include_str!("../../../../scenarios/take_cover.toml"),
            include_str!("../../../../scenarios/point_goal.toml"),
        ];
        let first = std::iter::once(own::template("Garden"));
        first.chain(examples.map(str::to_owned)).map(String::into_bytes).collect()
    },
    words: &[
        "[[spawn]]\n",
        "[[when]]\n",
        "[[light]]\n",
        "event = \"pickup\"\n",
        "event = \"near\"\n",
        "event = \"counter\"\n",
        "of = ",
        "floor = [-64, 64]\n",
        "respawn = 0\n",
        "every = 1\n",
        "count = 500\n",
        "count = \"a\"\n",
        "kind = \"Demon\"\n",
        "kind = \"platforms\"\n",
        "kind = \"rooms\"\n",
        "teleport = \"free\"\n",
        "spawn = \"vials\"\n",
        "hurt = 1000\n",
        "[levels.9]\n",
        "[levels.2]\n",
        "[hard]\n",
        "[rules.tables]\n",
        "goal = \"wander\"\n",
        "udmf = \"\"\"vertex { x = 0; y = 0; }\"\"\"\n",
        "\"\"\"",
    ],
    repair: nothing_to_repair,
    run: |bytes| {
        let text = String::from_utf8_lossy(bytes);
        let checked = own::check(&text);
        checked.mistakes.iter().for_each(|mistake| assert_presentable(&mistake.to_string()));
        if checked.can_be_played() {
            if let Err(error) = checked.rehearse(1, 3, 70) {
                assert_presentable(&error.to_string());
            }
        } else {
            assert!(
                checked.mistakes.iter().any(|mistake| !mistake.warning),
                "refused without a word"
            );
        }
        checked.can_be_played()
    },
    memory: 256 << 20,
};
