//! The level table of Remedy Rush: both rule sets side by side.

use crate::RuleSet;
use hasard_engine::world::ActorKind;

/// Tics between two supplies of new items.
pub const SUPPLY_TICS: u32 = 120;
/// Health bonuses of a supply; of each harmful item it brings one.
pub const SUPPLY_BONUSES: u32 = 2;
/// Reward for a Stimpack and a Medikit, where they are rewarded.
pub const STIMPACK_REWARD: f64 = 3.0;
/// See above.
pub const MEDIKIT_REWARD: f64 = 6.0;
/// Damage of a harmful item under the hard constraint: death.
pub const DEADLY: i32 = 1000;

/// The constants of a level.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Level {
    /// Health bonuses at the start.
    pub bonuses: u32,
    /// What is harmful.
    pub harmful: [ActorKind; 4],
    /// Of each harmful kind at the start.
    pub harmful_items: u32,
    /// Stimpacks, Medikits and light goggles.
    pub stimpacks: u32,
    /// See above.
    pub medikits: u32,
    /// See above.
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
    /// Of harmful items that are taken in the same tic only one is charged: in the published maps all four kinds start one script,
    /// which is refused while it runs. (Measured with a random policy: 36 steps with several in 180 episodes; 39 with this, 102
    /// without.)
    pub one_harm_a_tic: bool,
    /// Goggles tint the view green, beside brightening it.
    pub green_goggles: bool,
}

const SOFT_HARMFUL: [ActorKind; 4] = [ActorKind::Shell, ActorKind::Cell, ActorKind::ArmorBonus, ActorKind::RocketAmmo];
const PUBLISHED_HARD_HARMFUL: [ActorKind; 4] = [ActorKind::Shell, ActorKind::Cell, ActorKind::YellowCard, ActorKind::BlueSkull];

const PAPER_1: Level = Level {
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
const PAPER_2: Level = Level { bonuses: 20, harmful_items: 15, goggles: 2, strobe: Some([20, 20]), ..PAPER_1 };
const PAPER_3: Level = Level { bonuses: 10, harmful_items: 20, goggles: 1, strobe: Some([20, 40]), ..PAPER_1 };

const fn released(paper: Level) -> Level {
    Level { one_harm_a_tic: true, green_goggles: false, ..paper }
}

const RELEASED_1: Level = Level { packs_count: false, ..released(PAPER_1) };
const RELEASED_2: Level = released(PAPER_2);
const RELEASED_3: Level = released(PAPER_3);

const fn hard(soft: Level, harmful: [ActorKind; 4]) -> Level {
    Level { harmful, start_health: 100, deadly: true, cost: 10.0, ..soft }
}

/// Level 1 with the hard constraint has neither Stimpacks nor Medikits.
const fn without_packs(level: Level) -> Level {
    Level { stimpacks: 0, medikits: 0, ..level }
}

/// The constants of a level (`index` 0..=2).
#[must_use]
pub const fn level(rules: RuleSet, with_hard_constraint: bool, index: usize) -> Level {
    const PAPER: [Level; 3] = [PAPER_1, PAPER_2, PAPER_3];
    const PAPER_HARD: [Level; 3] =
        [without_packs(hard(PAPER_1, SOFT_HARMFUL)), hard(PAPER_2, SOFT_HARMFUL), hard(PAPER_3, SOFT_HARMFUL)];
    const RELEASED: [Level; 3] = [RELEASED_1, RELEASED_2, RELEASED_3];
    const RELEASED_HARD: [Level; 3] = [
        without_packs(hard(RELEASED_1, PUBLISHED_HARD_HARMFUL)),
        hard(RELEASED_2, PUBLISHED_HARD_HARMFUL),
        hard(RELEASED_3, PUBLISHED_HARD_HARMFUL),
    ];
    match (rules, with_hard_constraint) {
        (RuleSet::Paper, false) => PAPER[index],
        (RuleSet::Paper, true) => PAPER_HARD[index],
        (RuleSet::Released, false) => RELEASED[index],
        (RuleSet::Released, true) => RELEASED_HARD[index],
    }
}
