//! Short texts of the command line: ids, policies, buttons.

use super::{Target, assert_presentable, nothing_to_repair};
use hasard_envs::{EnvId, Policy, parse_command};

/// A line of each kind of word.
pub const WORDS: Target = Target {
    name: "words",
    samples: || {
        [
            "VolcanicVentureLevel1-v0",
            "hold-after:12:MOVE_FORWARD+SPEED",
            "sticky:7",
            "TURN_LEFT_RIGHT_DELTA=-7.5+JUMP",
            "noop",
        ]
        .map(|text| text.as_bytes().to_vec())
        .to_vec()
    },
    words: &[
        "hold:",
        "sticky:",
        "hold-after:",
        "Level",
        "-v0",
        "+",
        "LOOK_UP_DOWN_DELTA=",
        "RemedyRush",
    ],
    repair: nothing_to_repair,
    run: |bytes| {
        let text = String::from_utf8_lossy(bytes);
        let results = [
            text.parse::<EnvId>()
                .map(|id| assert_eq!(id.to_string().parse(), Ok(id)))
                .map_err(|error| error.to_string()),
            text.parse::<Policy>().map(|_| ()).map_err(|error| error.to_string()),
            parse_command(&text).map(|_| ()).map_err(|error| error.to_string()),
        ];
        results
            .iter()
            .filter_map(|result| result.as_ref().err())
            .for_each(|message| assert_presentable(message));
        results.iter().any(Result::is_ok)
    },
    memory: 1 << 20,
};
