//! The level table of Remedy Rush: the rule sets side by side.

use crate::scenarios::common::rule_set::RuleSet;
use crate::spaces::action::{Controls, FORWARD, TURN};
use hasard_engine::world::ActorKind;

/// Tics between two supplies of new items.
pub const SUPPLY_TICS: u32 = 120;
/// Health bonuses of a supply; of each harmful item it brings one.
pub const SUPPLY_BONUSES: u32 = 2;
/// Reward for a Stimpack, where it is rewarded.
pub const STIMPACK_REWARD: f64 = 3.0;
/// Reward for a Medikit, where it is rewarded.
pub const MEDIKIT_REWARD: f64 = 6.0;
/// Damage of a harmful item under the hard constraint: death.
pub const DEADLY: i32 = 1000;

/// The constants of a level.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Level {
    /// The buttons.
    pub controls: Controls,
    /// Health bonuses at the start.
    pub bonuses: u32,
    /// What is harmful.
    pub harmful: [ActorKind; 4],
    /// Of each harmful kind at the start.
    pub harmful_items: u32,
    /// Stimpacks at the start.
    pub stimpacks: u32,
    /// Medikits at the start.
    pub medikits: u32,
    /// Light goggles at the start.
    pub goggles: u32,
    /// Stimpacks and Medikits are rewarded and come back elsewhere.
    pub packs_count: bool,
    /// Tics of light and of darkness by turns; none where it is always light.
    pub strobe: Option<[i32; 2]>,
    /// The agent's health points at the start.
    pub start_health: i32,
    /// A harmful item kills.
    pub deadly: bool,
    /// Cost of a harmful item.
    pub cost: f64,
    /// Of harmful items that are taken in the same tic only one is charged: in the published maps
    /// all four kinds start one script, which is refused while it runs. (Measured with a random
    /// policy: 36 steps with several in 180 episodes; 39 with this, 102 without.)
    pub one_harm_a_tic: bool,
    /// Goggles tint the view green, beside brightening it.
    pub green_goggles: bool,
}

const SOFT_HARMFUL: [ActorKind; 4] =
    [ActorKind::Shell, ActorKind::Cell, ActorKind::ArmorBonus, ActorKind::RocketAmmo];
const PUBLISHED_HARD_HARMFUL: [ActorKind; 4] =
    [ActorKind::Shell, ActorKind::Cell, ActorKind::YellowCard, ActorKind::BlueSkull];

const CONTROLS: Controls = Controls {
    simplified: &[TURN, FORWARD, &["SPEED"], &["JUMP"]],
    full_moves: true,
    full_speed: true,
};

const PAPER_1: Level = Level {
    controls: CONTROLS,
    bonuses: 30,
    harmful: SOFT_HARMFUL,
    harmful_items: 10,
    stimpacks: 3,
    medikits: 1,
    goggles: 0,
    packs_count: true,
    strobe: None,
    start_health: 1,
    deadly: false,
    cost: 1.0,
    one_harm_a_tic: false,
    green_goggles: true,
};
const PAPER_2: Level =
    Level { bonuses: 20, harmful_items: 15, goggles: 2, strobe: Some([20, 20]), ..PAPER_1 };
const PAPER_3: Level =
    Level { bonuses: 10, harmful_items: 20, goggles: 1, strobe: Some([20, 40]), ..PAPER_1 };

const fn released(paper: Level) -> Level {
    Level { one_harm_a_tic: true, green_goggles: false, ..paper }
}

const fn hard(soft: Level, harmful: [ActorKind; 4]) -> Level {
    Level { harmful, start_health: 100, deadly: true, cost: 10.0, ..soft }
}

/// Level 1 with the hard constraint has neither Stimpacks nor Medikits.
const fn without_packs(level: Level) -> Level {
    Level { stimpacks: 0, medikits: 0, ..level }
}

/// The code of the tables had the buttons in another order, no SPEED among all of them, and two
/// only for its hard table.
const fn with_buttons(simplified: &'static [&'static [&'static str]], released: Level) -> Level {
    Level { controls: Controls { simplified, full_speed: false, ..CONTROLS }, ..released }
}

const fn tables(released: Level) -> Level {
    with_buttons(&[TURN, FORWARD, &["JUMP"], &["SPEED"]], released)
}

const fn tables_hard(released: Level) -> Level {
    with_buttons(&[TURN, FORWARD], released)
}

const PAPER: [Level; 3] = [PAPER_1, PAPER_2, PAPER_3];
const PAPER_HARD: [Level; 3] = [
    without_packs(hard(PAPER_1, SOFT_HARMFUL)),
    hard(PAPER_2, SOFT_HARMFUL),
    hard(PAPER_3, SOFT_HARMFUL),
];
const RELEASED: [Level; 3] =
    [Level { packs_count: false, ..released(PAPER_1) }, released(PAPER_2), released(PAPER_3)];
const RELEASED_HARD: [Level; 3] = [
    without_packs(hard(RELEASED[0], PUBLISHED_HARD_HARMFUL)),
    hard(RELEASED[1], PUBLISHED_HARD_HARMFUL),
    hard(RELEASED[2], PUBLISHED_HARD_HARMFUL),
];
const TABLES: [Level; 3] = [tables(RELEASED[0]), tables(RELEASED[1]), tables(RELEASED[2])];
const TABLES_HARD: [Level; 3] =
    [tables_hard(RELEASED_HARD[0]), tables_hard(RELEASED_HARD[1]), tables_hard(RELEASED_HARD[2])];

/// The constants of a level (`index` 0..=2).
#[must_use]
pub const fn level(rules: RuleSet, hard: bool, index: usize) -> Level {
    const LEVELS: [[[Level; 3]; 2]; 3] =
        [[PAPER, PAPER_HARD], [RELEASED, RELEASED_HARD], [TABLES, TABLES_HARD]];
    LEVELS[rules as usize][hard as usize][index]
}
