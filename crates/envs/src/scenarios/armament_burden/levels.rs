//! The level table of Armament Burden: the rule sets side by side.

use crate::scenarios::common::rule_set::RuleSet;
use crate::spaces::action::{Controls, FORWARD, TURN};
use hasard_engine::math::Fixed;
use hasard_engine::world::ActorKind;

/// Weapons, lightest first.
pub const WEAPONS: [ActorKind; 7] = [
    ActorKind::Pistol,
    ActorKind::Shotgun,
    ActorKind::SuperShotgun,
    ActorKind::Chaingun,
    ActorKind::RocketLauncher,
    ActorKind::PlasmaRifle,
    ActorKind::Bfg9000,
];
/// Decoys, lightest first: of weight, but no value.
pub const DECOYS: [ActorKind; 4] =
    [ActorKind::BlurSphere, ActorKind::Allmap, ActorKind::Backpack, ActorKind::RadSuit];
/// Weight of each decoy.
pub const DECOY_WEIGHTS: [Fixed; 4] = [Fixed(16384), Fixed(32768), Fixed(49152), Fixed(65536)];

/// 16.16 of hundredths, cut off, as the original's compiler does.
const fn hundredths<const N: usize>(values: [i32; N]) -> [Fixed; N] {
    let mut fixed = [Fixed::ZERO; N];
    let mut i = 0;
    while i < N {
        fixed[i] = Fixed(values[i] * 65536 / 100);
        i += 1;
    }
    fixed
}

/// Value of each weapon: the paper's table of items. Where weapons weigh as much as they are worth,
/// their weight as well.
pub const VALUES: [Fixed; 7] = hundredths([10, 25, 40, 55, 70, 85, 100]);
/// Weight of each weapon in the paper's formula of the cost.
pub const COST_WEIGHTS: [Fixed; 7] = hundredths([5, 15, 30, 60, 100, 300, 600]);

/// Weight that is carried without hindrance.
pub const CAPACITY: Fixed = Fixed::ONE;
/// The slowest that a burden makes, as a share of full speed.
pub const LEAST_SPEED: Fixed = Fixed(16384);
/// Speed after overstepping the capacity under the hard constraint, and for how many tics.
pub const PENALTY_SPEED: Fixed = Fixed(6553);
/// Tics that it lasts.
pub const PENALTY_TICS: u32 = 180;
/// Health points that acid takes each tic.
pub const PIT_DAMAGE: i32 = 100;
/// Height of an acid pit.
pub const PIT_HEIGHT: i32 = -24;
/// Speed of sinking pits, eighths of a map unit per tic.
pub const PIT_SPEED: i32 = 100;

/// The constants of a level.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Level {
    /// The buttons.
    pub controls: Controls,
    /// Weight of each weapon in what is charged or punished.
    pub weights: [Fixed; 7],
    /// Weight of each weapon in what makes the agent slow.
    pub slowing_weights: [Fixed; 7],
    /// Weight of each weapon in the published package's books, where those are kept.
    pub book_weights: [Fixed; 7],
    /// Weapons that lie about.
    pub weapons: u32,
    /// Decoys that lie about.
    pub decoys: u32,
    /// How often a tile is chosen to sink into acid; a tile may be chosen again.
    pub pits: u32,
    /// The agent starts anywhere in the delivery zone, not at the map's start.
    pub random_start: bool,
    /// Tics between two looks at whether the agent is in the delivery zone.
    pub zone_tics: u32,
    /// USE throws the burden away.
    pub discard: bool,
    /// Overstepping the capacity loses the burden and slows the agent down for a while.
    pub overload_is_punished: bool,
    /// Reward for taking a weapon, beside that for delivering it.
    pub reward_at_pickup: bool,
    /// Cost of carrying excess weight for a step, a unit of it; the excess itself is charged in a
    /// step with a pick-up.
    pub carry_cost: f64,
    /// Cost of overstepping the capacity, where that is punished; and, times `carry_cost`, of each
    /// step of being slow.
    pub overload_cost: f64,
    /// Cost of death.
    pub death_cost: f64,
    /// Cost of a step that ends with USE held.
    pub discard_cost: f64,
    /// What the agent carries is counted by the published package's bookkeeping: one pick-up a step
    /// at most, weighed as the last thing taken was; a burden lost in the step of its first pick-up
    /// goes unnoticed.
    pub published_bookkeeping: bool,
    /// From the first delivery under the hard constraint on, the published package charges every
    /// step as a discard.
    pub score_reads_as_discard: bool,
    /// The charge for excess takes the place of what else the step costs.
    pub excess_replaces: bool,
}

const CONTROLS: Controls = Controls {
    simplified: &[TURN, FORWARD, &["USE"], &["JUMP"]],
    full_moves: true,
    full_speed: false,
};

const PAPER_1: Level = Level {
    controls: CONTROLS,
    weights: COST_WEIGHTS,
    slowing_weights: VALUES,
    book_weights: VALUES,
    weapons: 10,
    decoys: 0,
    pits: 0,
    random_start: true,
    zone_tics: 1,
    discard: true,
    overload_is_punished: false,
    reward_at_pickup: false,
    carry_cost: 0.1,
    overload_cost: 10.0,
    death_cost: 10.0,
    discard_cost: 0.0,
    published_bookkeeping: false,
    score_reads_as_discard: false,
    excess_replaces: false,
};
const PAPER_2: Level = PAPER_1;
const PAPER_3: Level = Level { decoys: 10, pits: 20, ..PAPER_1 };

const fn released(paper: Level) -> Level {
    Level {
        weights: VALUES,
        carry_cost: 0.75,
        death_cost: 5.0,
        discard_cost: 0.1,
        published_bookkeeping: true,
        score_reads_as_discard: true,
        ..paper
    }
}

const fn tables(paper: Level) -> Level {
    Level {
        slowing_weights: COST_WEIGHTS,
        book_weights: COST_WEIGHTS,
        random_start: false,
        discard_cost: 1.0,
        published_bookkeeping: true,
        excess_replaces: true,
        ..paper
    }
}

const fn hard(soft: Level) -> Level {
    Level {
        weights: COST_WEIGHTS,
        slowing_weights: COST_WEIGHTS,
        discard: false,
        overload_is_punished: true,
        reward_at_pickup: soft.published_bookkeeping,
        ..soft
    }
}

/// Level 1 with the hard constraint has a start and a clock of its own.
const fn from_the_start(level: Level) -> Level {
    Level { random_start: false, zone_tics: 15, ..level }
}

/// The code of the hard table offered two buttons.
const fn walking_only(level: Level) -> Level {
    Level { controls: Controls { simplified: &[TURN, FORWARD], ..CONTROLS }, ..level }
}

const PAPER: [Level; 3] = [PAPER_1, PAPER_2, PAPER_3];
const PAPER_HARD: [Level; 3] = [from_the_start(hard(PAPER_1)), hard(PAPER_2), hard(PAPER_3)];
const RELEASED: [Level; 3] = [released(PAPER_1), released(PAPER_2), released(PAPER_3)];
const RELEASED_HARD: [Level; 3] =
    [from_the_start(hard(RELEASED[0])), hard(RELEASED[1]), hard(RELEASED[2])];
const TABLES: [Level; 3] = [tables(PAPER_1), tables(PAPER_2), tables(PAPER_3)];
const TABLES_HARD: [Level; 3] = [
    walking_only(from_the_start(hard(TABLES[0]))),
    walking_only(hard(TABLES[1])),
    walking_only(hard(TABLES[2])),
];

/// The constants of a level (`index` 0..=2).
#[must_use]
pub const fn level(rules: RuleSet, hard: bool, index: usize) -> Level {
    const LEVELS: [[[Level; 3]; 2]; 3] =
        [[PAPER, PAPER_HARD], [RELEASED, RELEASED_HARD], [TABLES, TABLES_HARD]];
    LEVELS[rules as usize][hard as usize][index]
}
