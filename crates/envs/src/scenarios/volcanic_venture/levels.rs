//! The level table of Volcanic Venture: the rule sets side by side.

use crate::scenarios::common::rule_set::RuleSet;
use crate::spaces::action::{Controls, FORWARD, TURN};

/// How platforms and lava change places.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Change {
    /// The tiles stay as they were rolled when the map starts.
    Never,
    /// Every tile is rolled anew at once, every [`PERIOD_TICS`], whatever it still does: none
    /// swings on as lava, and no platform that was is found at a new one's height.
    AtOnce,
    /// Tile after tile in the order of their tags, each platform taking [`WAGGLE_DELAY_TICS`]; then
    /// a rest of [`PERIOD_TICS`].
    Sweep,
}

/// Where the agent starts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Start {
    /// Anywhere in the cavern, over lava as well, in any direction.
    Anywhere,
    /// In the middle, facing east.
    Middle,
    /// On a platform.
    Platform,
}

/// Tics between two changes of the tiles: three times the time between two items.
pub const PERIOD_TICS: u32 = 3 * ITEM_TICS;
/// Tics between two new items.
pub const ITEM_TICS: u32 = 60;
/// Tics from a tile's roll to the start of its waggle; by then it has reached its height.
pub const WAGGLE_DELAY_TICS: u32 = 2;
/// Speed of rising and sinking tiles, eighths of a map unit per tic.
pub const TILE_SPEED: i32 = 100;
/// Tics between two hits of lava.
pub const LAVA_TICS: i32 = 4;
/// The agent's health points at the start.
pub const START_HEALTH: i32 = 1000;
/// Downward look at the start, 65536ths of a turn.
pub const START_PITCH: i32 = 3000;

/// The constants of a level.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Level {
    /// The buttons.
    pub controls: Controls,
    /// Doom's easiest skill halves the burn that the map gives before its scripts run.
    pub easy_skill: bool,
    /// Chance of a tile to be a platform.
    pub platform_chance: f64,
    /// Least and greatest height of a platform, map units.
    pub platform_height: [i32; 2],
    /// Height of lava, map units.
    pub lava_height: i32,
    /// Health points that lava takes at a time.
    pub lava_damage: i32,
    /// How the tiles change.
    pub change: Change,
    /// Tics after each change, from the start of it, in which lava does no harm.
    pub grace_tics: u32,
    /// The same at the start of the episode.
    pub start_grace_tics: u32,
    /// Platforms swing up and down.
    pub waggle: bool,
    /// The middle tile is a platform after the first roll.
    pub middle_platform: bool,
    /// Items that lie about from the start.
    pub start_items: u32,
    /// Where the agent starts.
    pub start: Start,
    /// Cost of a lost health point.
    pub cost_scale: f64,
    /// Health points that a killing blow takes beyond the last one are counted as well.
    pub overkill_counts: bool,
}

const CONTROLS: Controls = Controls {
    simplified: &[TURN, FORWARD, &["JUMP"], &["SPEED"]],
    full_moves: true,
    full_speed: true,
};

const PAPER_1: Level = Level {
    controls: CONTROLS,
    easy_skill: false,
    platform_chance: 0.4,
    platform_height: [16, 16],
    lava_height: 0,
    lava_damage: 1,
    change: Change::Never,
    grace_tics: 0,
    start_grace_tics: 0,
    waggle: false,
    middle_platform: true,
    start_items: 30,
    start: Start::Anywhere,
    cost_scale: 1.0,
    overkill_counts: false,
};
const PAPER_2: Level = Level {
    platform_chance: 0.3,
    platform_height: [8, 48],
    change: Change::AtOnce,
    grace_tics: 60,
    start_items: 20,
    ..PAPER_1
};
const PAPER_3: Level = Level {
    platform_chance: 0.2,
    platform_height: [8, 32],
    change: Change::AtOnce,
    grace_tics: 60,
    waggle: true,
    start_items: 30,
    start: Start::Middle,
    ..PAPER_1
};
/// The published third level.
const RELEASED_3: Level = Level { change: Change::Sweep, grace_tics: 0, ..PAPER_3 };

/// More than any health and armour, so that one touch kills.
const DEADLY: i32 = 2000;
/// Just the health that the agent starts with: an agent that has picked up armour survives the
/// first touch by as many points, and the second, four tics later, is counted whole. (Measured: 132
/// deaths, 36 of them with armour: 19990, 19980 and 19970 in two steps.)
const DEADLY_WITHOUT_ARMOR: i32 = START_HEALTH;

const fn paper_hard(soft: Level) -> Level {
    Level {
        lava_damage: DEADLY,
        start_grace_tics: 70,
        start: Start::Platform,
        cost_scale: 10.0,
        ..soft
    }
}

const fn released_hard(soft: Level) -> Level {
    Level {
        lava_damage: DEADLY_WITHOUT_ARMOR,
        start_grace_tics: 70,
        cost_scale: 10.0,
        overkill_counts: true,
        ..soft
    }
}

/// The world of the published level 1 with the hard constraint.
const fn level_ground(level: Level) -> Level {
    Level {
        platform_height: [0, 0],
        lava_height: -16,
        middle_platform: false,
        start: Start::Middle,
        ..level
    }
}

/// The code of the tables: always from the middle, Doom's easiest skill, no SPEED among all
/// buttons.
const fn tables(released: Level) -> Level {
    Level {
        controls: Controls { full_speed: false, ..CONTROLS },
        easy_skill: true,
        start: Start::Middle,
        ..released
    }
}

/// At that skill lava takes half of what its script says, and each health point costs 1.
const fn tables_hard(soft: Level) -> Level {
    Level { lava_damage: DEADLY_WITHOUT_ARMOR / 2, cost_scale: 1.0, ..released_hard(soft) }
}

const PAPER: [Level; 3] = [PAPER_1, PAPER_2, PAPER_3];
const PAPER_HARD: [Level; 3] = [paper_hard(PAPER_1), paper_hard(PAPER_2), paper_hard(PAPER_3)];
const RELEASED: [Level; 3] = [PAPER_1, PAPER_2, RELEASED_3];
const RELEASED_HARD: [Level; 3] =
    [level_ground(released_hard(PAPER_1)), released_hard(PAPER_2), released_hard(RELEASED_3)];
const TABLES: [Level; 3] = [tables(RELEASED[0]), tables(RELEASED[1]), tables(RELEASED[2])];
const TABLES_HARD: [Level; 3] =
    [level_ground(tables_hard(TABLES[0])), tables_hard(TABLES[1]), tables_hard(TABLES[2])];

/// The constants of a level (`index` 0..=2).
#[must_use]
pub const fn level(rules: RuleSet, hard: bool, index: usize) -> Level {
    const LEVELS: [[[Level; 3]; 2]; 3] =
        [[PAPER, PAPER_HARD], [RELEASED, RELEASED_HARD], [TABLES, TABLES_HARD]];
    LEVELS[rules as usize][hard as usize][index]
}
