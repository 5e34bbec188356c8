//! The level table of Precipice Plunge: the rule sets side by side.

use crate::scenarios::common::rule_set::RuleSet;
use crate::spaces::action::{Controls, TURN};
use hasard_engine::math::Fixed;

/// Speed of sinking floors and ceilings, eighths of a map unit per tic.
pub const SINK_SPEED: i32 = 1000;
/// Health points that a unit of fall costs, beyond the free height.
pub const FALL_DAMAGE: Fixed = Fixed(6553);
/// A fall of at most this many map units does no harm.
pub const FREE_FALL: i32 = 96;
/// Reward for a unit of descent.
pub const REWARD: f64 = 0.05;
/// Half the period of the glow, tics.
pub const GLOW_TICS: i32 = 50;

/// How the tiles of the cave are laid out. Rows count from 1, eastwards from the start platform.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Layout {
    /// A winding stair: each tile lies one step below the one before, to and fro across the cave.
    Stair {
        /// Descent from tile to tile, map units.
        step: i32,
    },
    /// Rows of tiles of uneven depth, none above the deepest of the row before.
    Rows {
        /// Descent from row to row, map units.
        step: i32,
        /// A tile lies up to this many units above or below its row...
        spread_units: i32,
        /// ...of this many map units.
        spread_unit: i32,
    },
}

/// How light fades with the tags of the tiles, by whole levels: of what is lost, fractions are
/// dropped.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Fade {
    /// The last tag in full light.
    pub from_tag: i32,
    /// So many levels are lost...
    pub levels: i32,
    /// ...over so many tags.
    pub tags: i32,
}

impl Fade {
    /// Light of a tile.
    #[must_use]
    pub const fn light(self, tag: i32) -> i32 {
        255 - self.levels * (tag - self.from_tag) / self.tags
    }
}

/// The constants of a level.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Level {
    /// The buttons.
    pub controls: Controls,
    /// How the tiles are laid out.
    pub layout: Layout,
    /// The first row of the flat bottom.
    pub bottom_row: i32,
    /// The last row that sinks.
    pub last_row: i32,
    /// Depth of the bottom, map units: to arrive there is the goal.
    pub depth: i32,
    /// Rows beyond this one have a ceiling of their own...
    pub open_rows: i32,
    /// ...of this height in a row of number 0, were the slope continued, map units...
    pub ceiling_start: i32,
    /// ...sinking by this much from row to row.
    pub ceiling_step: i32,
    /// How light fades on the way down.
    pub fade: Fade,
    /// Light levels by which tiles glow up and down; 0 for none.
    pub glow: i32,
    /// Tiles swing up and down for ever, one after the other beginning to.
    pub waggle: bool,
    /// The agent's health points at the start.
    pub start_health: i32,
    /// Health points that cost is counted from.
    pub counted_health: i32,
    /// Only what a fall exceeds the free height by does harm.
    pub free_fall_is_deducted: bool,
    /// Only depth that the episode had not reached before is rewarded; without this every descent
    /// is, and every ascent punished.
    pub reward_new_depth_only: bool,
    /// A fall beyond the free height ends the episode.
    pub fall_ends: bool,
    /// Cost of a lost health point.
    pub cost_scale: f64,
    /// Cost of a fall beyond the free height, as a mark that each later step of the episode reads
    /// again.
    pub fall_cost: f64,
    /// The way and the health of the step in which the rules end the episode count.
    pub last_step_counts: bool,
    /// In the second tic the view is turned down as far as it goes.
    pub look_down: bool,
}

const CONTROLS: Controls = Controls {
    simplified: &[TURN, &["MOVE_FORWARD", "MOVE_BACKWARD"], &["LOOK_UP", "LOOK_DOWN"], &["JUMP"]],
    full_moves: true,
    full_speed: true,
};

const PAPER_1: Level = Level {
    controls: CONTROLS,
    layout: Layout::Stair { step: 24 },
    bottom_row: 30,
    last_row: 35,
    depth: 4872,
    open_rows: 7,
    ceiling_start: 128 + 1320 + 168,
    ceiling_step: 168,
    fade: Fade { from_tag: 127, levels: 1, tags: 2 },
    glow: 30,
    waggle: false,
    start_health: 1000,
    counted_health: 1000,
    free_fall_is_deducted: true,
    reward_new_depth_only: true,
    fall_ends: false,
    cost_scale: 1.0,
    fall_cost: 0.0,
    last_step_counts: true,
    look_down: false,
};
const PAPER_2: Level = Level {
    layout: Layout::Rows { step: 128, spread_units: 5, spread_unit: 12 },
    bottom_row: 52,
    last_row: 56,
    depth: 6528,
    open_rows: 10,
    ceiling_start: 128 + 1280,
    ceiling_step: 128,
    fade: Fade { from_tag: 0, levels: 155, tags: 399 },
    ..PAPER_1
};
const PAPER_3: Level = Level {
    layout: Layout::Rows { step: 192, spread_units: 5, spread_unit: 19 },
    depth: 9792,
    ceiling_start: 1920,
    ceiling_step: 192,
    glow: 50,
    waggle: true,
    ..PAPER_2
};

const fn released(paper: Level) -> Level {
    Level { free_fall_is_deducted: false, reward_new_depth_only: false, ..paper }
}

const fn hard(soft: Level, counted_health: i32) -> Level {
    Level { start_health: 500, counted_health, fall_ends: true, cost_scale: 10.0, ..soft }
}

/// Level 1 with the hard constraint has a shorter cave of its own.
const fn shorter(level: Level) -> Level {
    Level { bottom_row: 25, depth: 4032, glow: 0, ..level }
}

/// The code of the tables read height and health of the step before where the episode had ended,
/// and its floors stood still.
const fn tables(released: Level) -> Level {
    Level { waggle: false, last_step_counts: false, ..released }
}

/// The code of the hard table: a fall is charged as such, not by the health that it costs.
const fn tables_hard(soft: Level) -> Level {
    let controls = Controls { simplified: &[TURN, &["MOVE_FORWARD", "MOVE_BACKWARD"]], ..CONTROLS };
    Level { controls, cost_scale: 0.0, fall_cost: 10.0, look_down: true, ..hard(soft, 500) }
}

const PAPER: [Level; 3] = [PAPER_1, PAPER_2, PAPER_3];
const PAPER_HARD: [Level; 3] =
    [shorter(hard(PAPER_1, 500)), hard(PAPER_2, 500), hard(PAPER_3, 500)];
const RELEASED: [Level; 3] = [released(PAPER_1), released(PAPER_2), released(PAPER_3)];
const RELEASED_HARD: [Level; 3] =
    [shorter(hard(RELEASED[0], 1000)), hard(RELEASED[1], 1000), hard(RELEASED[2], 1000)];
const TABLES: [Level; 3] = [tables(RELEASED[0]), tables(RELEASED[1]), tables(RELEASED[2])];
const TABLES_HARD: [Level; 3] =
    [shorter(tables_hard(TABLES[0])), tables_hard(TABLES[1]), tables_hard(TABLES[2])];

/// The constants of a level (`index` 0..=2).
#[must_use]
pub const fn level(rules: RuleSet, hard: bool, index: usize) -> Level {
    const LEVELS: [[[Level; 3]; 2]; 3] =
        [[PAPER, PAPER_HARD], [RELEASED, RELEASED_HARD], [TABLES, TABLES_HARD]];
    LEVELS[rules as usize][hard as usize][index]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The published scripts count in whole numbers; by their light, 99.9 % of the published pixels
    /// come out, by fractions rounded down 98.
    #[test]
    fn light_fades_by_whole_levels() {
        let lights = |index, tags: [i32; 3]| {
            tags.map(|tag| level(RuleSet::Released, false, index).fade.light(tag))
        };
        assert_eq!(lights(0, [128, 129, 372]), [255, 254, 133]);
        assert_eq!(lights(1, [128, 130, 526]), [206, 205, 51]);
        assert_eq!(lights(1, [2, 3, 399]), [255, 254, 100]);
    }
}
