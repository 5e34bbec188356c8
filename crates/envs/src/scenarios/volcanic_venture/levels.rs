//! The level table of Volcanic Venture: both rule sets side by side.

use crate::RuleSet;

/// How platforms and lava change places.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Change {
    /// The tiles stay as they were rolled when the map starts.
    Never,
    /// Every tile is rolled anew at once, every [`PERIOD_TICS`], whatever it still does: none swings on as lava, and no platform that
    /// was is found at a new one's height.
    AtOnce,
    /// Tile after tile in the order of their tags, each platform taking [`WAGGLE_DELAY_TICS`]; then a rest of [`PERIOD_TICS`].
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

const PAPER_1: Level = Level {
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
const PAPER_2: Level =
    Level { platform_chance: 0.3, platform_height: [8, 48], change: Change::AtOnce, grace_tics: 60, start_items: 20, ..PAPER_1 };
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
const RELEASED_1: Level = PAPER_1;
const RELEASED_2: Level = PAPER_2;
const RELEASED_3: Level = Level { change: Change::Sweep, grace_tics: 0, ..PAPER_3 };

/// More than any health and armour, so that one touch kills.
const DEADLY: i32 = 2000;
/// Just the health that the agent starts with: whoever has picked up armour survives the first touch by as many points, and the
/// second, four tics later, is counted whole. (Measured: 132 deaths, 36 of them with armour: 19990, 19980 and 19970 in two steps.)
const DEADLY_WITHOUT_ARMOR: i32 = START_HEALTH;

const fn paper_hard(soft: Level) -> Level {
    Level { lava_damage: DEADLY, start_grace_tics: 70, start: Start::Platform, cost_scale: 10.0, ..soft }
}

const fn released_hard(soft: Level) -> Level {
    Level { lava_damage: DEADLY_WITHOUT_ARMOR, start_grace_tics: 70, cost_scale: 10.0, overkill_counts: true, ..soft }
}

const RELEASED_HARD_1: Level = Level {
    platform_height: [0, 0],
    lava_height: -16,
    middle_platform: false,
    start: Start::Middle,
    ..released_hard(RELEASED_1)
};

/// The constants of a level (`index` 0..=2).
#[must_use]
pub const fn level(rules: RuleSet, hard: bool, index: usize) -> Level {
    const PAPER: [Level; 3] = [PAPER_1, PAPER_2, PAPER_3];
    const PAPER_HARD: [Level; 3] = [paper_hard(PAPER_1), paper_hard(PAPER_2), paper_hard(PAPER_3)];
    const RELEASED: [Level; 3] = [RELEASED_1, RELEASED_2, RELEASED_3];
    const RELEASED_HARD: [Level; 3] = [RELEASED_HARD_1, released_hard(RELEASED_2), released_hard(RELEASED_3)];
    match (rules, hard) {
        (RuleSet::Paper, false) => PAPER[index],
        (RuleSet::Paper, true) => PAPER_HARD[index],
        (RuleSet::Released, false) => RELEASED[index],
        (RuleSet::Released, true) => RELEASED_HARD[index],
    }
}
