//! The READMEs of the scenarios held against their level tables.

use super::{armament_burden, collateral_damage, detonators_dilemma, precipice_plunge, remedy_rush, volcanic_venture};
use crate::{RuleSet, Scenario};
use hasard_engine::math::Fixed;
use std::fmt::Display;

const PAPER: RuleSet = RuleSet::Paper;
const RELEASED: RuleSet = RuleSet::Released;

/// A line of a table.
fn row<T: Display>(label: &str, cells: impl IntoIterator<Item = T>) -> String {
    cells.into_iter().fold(format!("| {label} |"), |line, cell| format!("{line} {cell} |"))
}

/// A line with a cell for each level.
fn by_level<T: Display>(label: &str, cell: impl Fn(usize) -> T) -> String {
    row(label, (0..3).map(cell))
}

/// A line with a cell for each rule set.
fn by_rules<T: Display>(label: &str, cell: impl Fn(RuleSet) -> T) -> String {
    row(label, [PAPER, RELEASED].map(cell))
}

fn hundredths(values: &[Fixed]) -> Vec<String> {
    values.iter().map(|value| format!("{:.2}", value.to_f64())).collect()
}

fn holds(readme: &str, lines: &[String]) {
    for line in lines {
        assert!(readme.lines().any(|found| found == line), "the table lacks\n{line}");
    }
}

#[test]
fn armament_burden_says_what_it_does() {
    use armament_burden::levels::{DECOY_WEIGHTS, HARD_WEIGHTS, VALUES, level};
    let soft = |index| level(PAPER, false, index);
    let up_to = |n: u32| if n == 0 { "0".to_string() } else { format!("up to {n}") };
    assert!(
        (0..3).all(|i| (soft(i).weapons, soft(i).decoys) == (level(RELEASED, true, i).weapons, level(RELEASED, true, i).decoys))
    );
    let lines = [
        by_level("weapons lying about", |i| soft(i).weapons),
        by_level("decoys (weight, no value)", |i| soft(i).decoys),
        by_level("tiles that sink into acid, which kills", |i| up_to(soft(i).pits)),
        row("value, and weight", hundredths(&VALUES)),
        row("weight, hard constraint", hundredths(&HARD_WEIGHTS)),
        row("weight", hundredths(&DECOY_WEIGHTS)),
        by_rules("of any other step that ends over capacity: the excess times", |rules| level(rules, false, 0).carry_cost),
        by_rules("of death", |rules| level(rules, false, 0).death_cost),
        by_rules("of a step that ends with USE held", |rules| level(rules, false, 0).discard_cost),
        by_rules("budget", |rules| Scenario::ArmamentBurden.safety_budget(rules)),
    ];
    holds(include_str!("armament_burden/README.md"), &lines);
}

#[test]
fn collateral_damage_says_what_it_does() {
    use collateral_damage::levels::level;
    let soft = |index| level(PAPER, false, index);
    assert!((0..3).all(|i| soft(i) == level(RELEASED, false, i)));
    let hard = level(RELEASED, true, 0);
    assert_eq!((hard.agent_x, level(PAPER, true, 0).targets), (soft(2).agent_x, soft(0).targets));
    let lines = [
        by_level("targets", |i| soft(i).targets),
        by_level("their speed, map units a step", |i| soft(i).target_speed),
        by_level("passers-by", |i| soft(i).neutrals),
        by_level("their health points", |i| soft(i).neutral_health),
        // The line of the walkers lies 0 to 200 east of the middle.
        by_level("distance to their line, map units", |i| format!("{} to {}", -soft(i).agent_x, 200 - soft(i).agent_x)),
        by_rules("a killed passer-by", |rules| format!("costs {} and ends the episode", level(rules, true, 1).cost)),
        row(
            "level 1",
            ["as above", &format!("{} targets of speed {}, at the distance of level 3", hard.targets, hard.target_speed)],
        ),
    ];
    holds(include_str!("collateral_damage/README.md"), &lines);
}

#[test]
fn detonators_dilemma_says_what_it_does() {
    use detonators_dilemma::levels::{CREATURE_HEALTH, CREATURES, level};
    let cast = |index| {
        let bits = level(PAPER, false, index).creatures;
        let named: Vec<String> =
            CREATURES.iter().enumerate().filter(|(i, _)| bits & (1 << i) != 0).map(|(_, kind)| format!("{kind:?}")).collect();
        if named.len() == CREATURES.len() { "all seven".to_string() } else { named.join(", ") }
    };
    let near = |rules| if level(rules, false, 2).push { "shy away" } else { "stay" };
    let lines = [
        by_rules("barrels within 48 map units of the agent", near),
        by_level("barrels", |i| level(PAPER, false, i).barrels),
        by_level("creatures", cast),
        by_level("of each, `paper`", |i| level(PAPER, false, i).of_each),
        by_level("of each, `released`", |i| level(RELEASED, false, i).of_each),
        by_level("their speed, map units a step", |i| level(PAPER, false, i).speed.expect("the soft levels set it")),
        row("creature", CREATURES.map(|kind| format!("{kind:?}"))),
        row("health points", CREATURE_HEALTH),
        by_rules("a killed creature", |rules| format!("costs {} and ends the episode", level(rules, true, 0).cost)),
        by_rules("level 1: barrels, creatures of each of all seven kinds, their health points", |rules| {
            let hard = level(rules, true, 0);
            format!("{}, {}, {}", hard.barrels, hard.of_each, hard.health.expect("one for all"))
        }),
    ];
    holds(include_str!("detonators_dilemma/README.md"), &lines);
}

#[test]
fn precipice_plunge_says_what_it_does() {
    use precipice_plunge::levels::{Layout, level};
    let soft = |index| level(PAPER, false, index);
    let floor = |i| {
        let swing = if soft(i).waggle { ", swinging for ever" } else { "" };
        match soft(i).layout {
            Layout::Stair { step } => format!("a winding stair, each tile {step} below the one before"),
            Layout::Rows { step, spread_units, spread_unit } => {
                format!("rows {step} apart, tiles up to {} off{swing}", spread_units * spread_unit)
            }
        }
    };
    let hard = |rules| level(rules, true, 1);
    let readme = include_str!("precipice_plunge/README.md");
    let lines = [
        by_level("floor", floor),
        by_level("bottom, map units", |i| soft(i).depth),
        by_level("light", |i| format!("darker with depth, glowing by {}", soft(i).glow)),
        by_rules("hard constraint: health points at the start, and counted from", |rules| {
            format!("{}, {}", hard(rules).start_health, hard(rules).counted_health)
        }),
        by_rules("hard constraint: cost of a health point", |rules| hard(rules).cost_scale),
    ];
    holds(readme, &lines);
    let shorter = level(PAPER, true, 0);
    assert_eq!(shorter.glow, 0);
    assert!(readme.contains(&format!("ends at {} and does not glow", shorter.depth)));
}

#[test]
fn remedy_rush_says_what_it_does() {
    use remedy_rush::levels::level;
    let soft = |index| level(PAPER, false, index);
    let starts = |rules| format!("{}; {}", level(rules, false, 0).start_health, level(rules, true, 0).start_health);
    let lines = [
        by_level("health bonuses (+1) at the start", |i| soft(i).bonuses),
        by_level("Stimpacks (+3), Medikits (+6)", |i| format!("{}, {}", soft(i).stimpacks, soft(i).medikits)),
        by_level("harmful: shells, cells, armour bonuses, rockets, of each", |i| soft(i).harmful_items),
        by_level("light goggles", |i| soft(i).goggles),
        by_level("light: tics lit, tics dark", |i| {
            soft(i).strobe.map_or("always lit".to_string(), |[lit, dark]| format!("{lit}, {dark}"))
        }),
        by_rules("harmful items taken in the same tic", |rules| {
            if level(rules, false, 1).one_harm_a_tic { "cost 1" } else { "cost 1 each" }
        }),
        by_rules("health points at the start; hard constraint", starts),
        by_rules("hard constraint: a harmful item", |rules| format!("costs {} and kills", level(rules, true, 0).cost)),
    ];
    holds(include_str!("remedy_rush/README.md"), &lines);
}

#[test]
fn volcanic_venture_says_what_it_does() {
    use volcanic_venture::levels::level;
    let soft = |index| level(PAPER, false, index);
    let height = |i| {
        let ([low, high], swing) = (soft(i).platform_height, if soft(i).waggle { ", swinging" } else { "" });
        if low == high { format!("{low}{swing}") } else { format!("{low} to {high}{swing}") }
    };
    let lines = [
        by_level("chance of a tile to be a platform", |i| soft(i).platform_chance),
        by_level("height of platforms, map units", height),
        by_level("tics after a change without harm, `paper`", |i| soft(i).grace_tics),
        by_level("tics after a change without harm, `released`", |i| level(RELEASED, false, i).grace_tics),
        by_level("items at the start", |i| soft(i).start_items),
        by_rules("health points that lava takes, after the first 70 tics", |rules| level(rules, true, 0).lava_damage),
        by_rules("cost of a health point", |rules| level(rules, true, 0).cost_scale),
    ];
    holds(include_str!("volcanic_venture/README.md"), &lines);
    assert!((0..3).all(|i| level(PAPER, true, i).start_grace_tics == 70 && level(RELEASED, true, i).start_grace_tics == 70));
}
