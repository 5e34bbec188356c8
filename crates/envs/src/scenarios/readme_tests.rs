//! The READMEs of the scenarios held against their level tables.
//!
//! Long because each of six pages has its own table.

use crate::scenarios::common::rule_set::RuleSet;
use crate::scenarios::common::scenario::Scenario;
use crate::scenarios::{
    armament_burden, collateral_damage, detonators_dilemma, precipice_plunge, remedy_rush,
    volcanic_venture,
};
use crate::spaces::action::Controls;
use hasard_engine::math::Fixed;
use std::fmt::Display;

const PAPER: RuleSet = RuleSet::Paper;
const RELEASED: RuleSet = RuleSet::Released;
const TABLES: RuleSet = RuleSet::Tables;

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
    row(label, RuleSet::ALL.map(cell))
}

/// What a constant says, for a line by rules.
fn either<T>(constant: bool, yes: T, no: T) -> T {
    if constant { yes } else { no }
}

/// The simplified actions in a page's words.
fn actions(controls: Controls) -> String {
    let word = |group: &&[&str]| match group[0] {
        "TURN_LEFT" => "turn",
        "MOVE_FORWARD" if group.len() == 2 => "walk",
        "MOVE_FORWARD" => "forward",
        "LOOK_UP" => "look",
        "SPEED" => "speed",
        "JUMP" => "jump",
        "USE" => "use",
        other => panic!("no word for {other}"),
    };
    controls.simplified.iter().map(word).collect::<Vec<_>>().join(", ")
}

/// Soft, and hard where that is another.
fn actions_of(controls: impl Fn(bool) -> Controls) -> String {
    let [soft, hard] = [false, true].map(|hard| actions(controls(hard)));
    if soft == hard { soft } else { format!("{soft}; hard: {hard}") }
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
fn pages_name_every_statistic_and_cost_term() {
    for (scenario, readme) in [
        ("ArmamentBurden", include_str!("armament_burden/README.md")),
        ("CollateralDamage", include_str!("collateral_damage/README.md")),
        ("DetonatorsDilemma", include_str!("detonators_dilemma/README.md")),
        ("PrecipicePlunge", include_str!("precipice_plunge/README.md")),
        ("RemedyRush", include_str!("remedy_rush/README.md")),
        ("VolcanicVenture", include_str!("volcanic_venture/README.md")),
    ] {
        let env = crate::Env::new(&format!("{scenario}Level1-v0"), &crate::EnvOptions::default())
            .unwrap();
        let names = env
            .stats()
            .into_iter()
            .map(|stat| stat.0)
            .chain(env.cost_terms().iter().map(|term| term.name));
        let missing: Vec<&str> =
            names.filter(|name| !readme.contains(&format!("`{name}`"))).collect();
        assert!(missing.is_empty(), "the page of {scenario} lacks {missing:?}");
    }
}

#[test]
fn armament_burden_says_what_it_does() {
    use armament_burden::levels::{COST_WEIGHTS, DECOY_WEIGHTS, VALUES, level};
    let soft = |index| level(PAPER, false, index);
    let weight =
        |weights: [Fixed; 7]| either(weights == COST_WEIGHTS, "the formula's", "the lesser");
    let up_to = |n: u32| if n == 0 { "0".to_string() } else { format!("up to {n}") };
    for (rules, i) in RuleSet::ALL.into_iter().flat_map(|rules| (0..3).map(move |i| (rules, i))) {
        let hard = level(rules, true, i);
        assert_eq!(
            (soft(i).weapons, soft(i).decoys, soft(i).pits),
            (hard.weapons, hard.decoys, hard.pits)
        );
        assert_eq!(hard.weights, COST_WEIGHTS);
        assert_eq!(hard.reward_at_pickup, rules != PAPER);
        assert_eq!(hard.score_reads_as_discard, rules == RELEASED);
    }
    let lines = [
        by_level("weapons lying about", |i| soft(i).weapons),
        by_level("decoys (weight, no value)", |i| soft(i).decoys),
        by_level("tiles that sink into acid, which kills", |i| up_to(soft(i).pits)),
        row("value, and the lesser weight", hundredths(&VALUES)),
        row("the formula's weight", hundredths(&COST_WEIGHTS)),
        by_rules("weight that is charged", |rules| weight(level(rules, false, 0).weights)),
        by_rules("weight that makes slow", |rules| weight(level(rules, false, 0).slowing_weights)),
        by_rules("a charge for excess", |rules| {
            either(
                level(rules, false, 0).excess_replaces,
                "takes their place",
                "comes on top of these",
            )
        }),
        by_rules("what is carried", |rules| {
            let books = level(rules, false, 0).published_bookkeeping;
            either(books, "by the published bookkeeping, see below", "counted as it is")
        }),
        by_rules("agent starts", |rules| {
            either(
                level(rules, false, 0).random_start,
                "anywhere in the strip",
                "in the middle of the strip",
            )
        }),
        by_rules("simplified actions", |rules| actions_of(|hard| level(rules, hard, 0).controls)),
        row("weight", hundredths(&DECOY_WEIGHTS)),
        by_rules("of any other step that ends over capacity: the excess times", |rules| {
            level(rules, false, 0).carry_cost
        }),
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
    for (i, hard) in (0..3).flat_map(|i| [(i, false), (i, true)]) {
        // But for the clock and the dead, the tables' levels are the published ones.
        let (published, tables) = (level(RELEASED, hard, i), level(TABLES, hard, i));
        assert_eq!(
            tables,
            collateral_damage::levels::Level {
                end_tic: tables.end_tic,
                dead_vanish: false,
                ..published
            }
        );
    }
    let hard = level(RELEASED, true, 0);
    let published_hard = format!(
        "{} targets of speed {}, at the distance of level 3",
        hard.targets, hard.target_speed
    );
    let dead = |vanish| either(vanish, "vanish", "stay lying, and stop nobody");
    assert_eq!((hard.agent_x, level(PAPER, true, 0).targets), (soft(2).agent_x, soft(0).targets));
    let lines = [
        by_level("targets", |i| soft(i).targets),
        by_level("their speed, map units a step", |i| soft(i).target_speed),
        by_level("passers-by", |i| soft(i).neutrals),
        by_level("their health points", |i| soft(i).neutral_health),
        // The line of the walkers lies 0 to 200 east of the middle.
        by_level("distance to their line, map units", |i| {
            format!("{} to {}", -soft(i).agent_x, 200 - soft(i).agent_x)
        }),
        by_rules("a killed passer-by", |rules| {
            format!("costs {} and ends the episode", level(rules, true, 1).cost)
        }),
        row("level 1", ["as above", &published_hard, &published_hard]),
        by_rules("the dead", |rules| dead(level(rules, false, 0).dead_vanish)),
        by_rules("the dead", |rules| dead(level(rules, true, 0).dead_vanish)),
        by_rules("steps of an episode", |rules| {
            (level(rules, false, 0).end_tic - collateral_damage::levels::START_TIC).div_ceil(4)
        }),
    ];
    holds(include_str!("collateral_damage/README.md"), &lines);
}

#[test]
fn detonators_dilemma_says_what_it_does() {
    use detonators_dilemma::levels::{CREATURE_HEALTH, CREATURES, early_creatures, level};
    assert!((0..3).all(|i| level(RELEASED, false, i).of_each == level(TABLES, false, i).of_each));
    let early = early_creatures(TABLES, false, 0).expect("the first runs met others");
    let names = CREATURES
        .iter()
        .enumerate()
        .filter(|(i, _)| early & (1 << i) != 0)
        .map(|(_, kind)| format!("a {kind:?}"));
    assert_eq!(names.collect::<Vec<_>>(), ["a LostSoul", "a ChaingunGuy", "a Revenant"]);
    let cast = |index| {
        let bits = level(PAPER, false, index).creatures;
        let named: Vec<String> = CREATURES
            .iter()
            .enumerate()
            .filter(|(i, _)| bits & (1 << i) != 0)
            .map(|(_, kind)| format!("{kind:?}"))
            .collect();
        if named.len() == CREATURES.len() { "all seven".to_string() } else { named.join(", ") }
    };
    let near = |rules| if level(rules, false, 2).push { "shy away" } else { "stay" };
    let lines = [
        by_rules("barrels within 48 map units of the agent", near),
        by_level("barrels", |i| level(PAPER, false, i).barrels),
        by_level("creatures", cast),
        by_level("of each, `paper`", |i| level(PAPER, false, i).of_each),
        by_rules("mass of a barrel in level 1", |rules| {
            level(rules, false, 0).barrel_mass.unwrap_or(100)
        }),
        by_rules("killed soldiers", |rules| {
            match (level(rules, false, 0).drops, level(rules, false, 0).pistol_only) {
                (false, _) => "leave nothing",
                (true, false) => "drop what they carried, and it can be used",
                (true, true) => "drop what they carried, and it can be taken, not used",
            }
        }),
        by_rules("the dead", |rules| {
            either(level(rules, false, 0).dead_vanish, "vanish", "stay lying, and stop nobody")
        }),
        by_rules("health lost in the step in which death or the rules end the episode", |rules| {
            either(level(rules, false, 0).last_step_counts, "costs", "costs nothing")
        }),
        by_rules("creatures without a goal until the next choice", |rules| {
            either(level(rules, false, 0).goals == 7, "none", "one in eight")
        }),
        by_level("of each, `released` and `tables`", |i| level(RELEASED, false, i).of_each),
        by_level("their speed, map units a step", |i| {
            level(PAPER, false, i).speed.expect("the soft levels set it")
        }),
        row("creature", CREATURES.map(|kind| format!("{kind:?}"))),
        row("health points", CREATURE_HEALTH),
        by_rules("a killed creature", |rules| {
            format!("costs {} and ends the episode", level(rules, true, 0).cost)
        }),
        by_rules(
            "level 1: barrels, creatures of each of all seven kinds, their health points",
            |rules| {
                let hard = level(rules, true, 0);
                format!("{}, {}, {}", hard.barrels, hard.of_each, hard.health.expect("one for all"))
            },
        ),
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
            Layout::Stair { step } => {
                format!("a winding stair, each tile {step} below the one before")
            }
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
        by_rules("hard constraint: cost of a fall beyond 96 as such", |rules| {
            hard(rules).fall_cost
        }),
        by_rules("hard constraint: view", |rules| {
            either(
                hard(rules).look_down,
                "as far down as it goes, from the second tic on",
                "straight ahead",
            )
        }),
        by_rules("hard constraint: simplified actions", |rules| actions(hard(rules).controls)),
        by_rules("health points that a fall beyond 96 costs", |rules| {
            let less = level(rules, false, 0).free_fall_is_deducted;
            either(
                less,
                "a tenth of what exceeds 96, rounded down",
                "a tenth of all of it, rounded down",
            )
        }),
        by_rules("the step in which the rules end the episode", |rules| {
            either(
                level(rules, false, 0).last_step_counts,
                "counts",
                "adds neither reward nor lost health",
            )
        }),
    ];
    holds(readme, &lines);
    assert_eq!(RuleSet::ALL.map(|rules| level(rules, false, 2).waggle), [true, true, false]);
    assert!(
        RuleSet::ALL
            .iter()
            .all(|&rules| level(rules, false, 0).fall_cost == 0.0
                && !level(rules, false, 0).look_down)
    );
    let shorter = level(PAPER, true, 0);
    assert_eq!(shorter.glow, 0);
    assert!(readme.contains(&format!("ends at {} and does not glow", shorter.depth)));
}

#[test]
fn remedy_rush_says_what_it_does() {
    use remedy_rush::levels::level;
    let soft = |index| level(PAPER, false, index);
    let starts = |rules| {
        format!("{}; {}", level(rules, false, 0).start_health, level(rules, true, 0).start_health)
    };
    let lines = [
        by_level("health bonuses (+1) at the start", |i| soft(i).bonuses),
        by_level("Stimpacks (+3), Medikits (+6)", |i| {
            format!("{}, {}", soft(i).stimpacks, soft(i).medikits)
        }),
        by_level("harmful: shells, cells, armour bonuses, rockets, of each", |i| {
            soft(i).harmful_items
        }),
        by_level("light goggles", |i| soft(i).goggles),
        by_level("light: tics lit, tics dark", |i| {
            soft(i).strobe.map_or("always lit".to_string(), |[lit, dark]| format!("{lit}, {dark}"))
        }),
        by_rules("harmful items taken in the same tic", |rules| {
            if level(rules, false, 1).one_harm_a_tic { "cost 1" } else { "cost 1 each" }
        }),
        by_rules("health points at the start; hard constraint", starts),
        by_rules("hard constraint: a harmful item", |rules| {
            format!("costs {} and kills", level(rules, true, 0).cost)
        }),
        by_rules("simplified actions", |rules| actions_of(|hard| level(rules, hard, 0).controls)),
        by_rules("SPEED among the full actions", |rules| {
            either(level(rules, false, 0).controls.full_speed, "yes", "no")
        }),
        by_rules("Stimpacks and Medikits of level 1", |rules| {
            either(level(rules, false, 0).packs_count, "rewarded, come back", "neither")
        }),
        by_rules("goggles", |rules| {
            either(
                level(rules, false, 0).green_goggles,
                "brighten the view and tint it green",
                "brighten the view",
            )
        }),
    ];
    holds(include_str!("remedy_rush/README.md"), &lines);
}

#[test]
fn volcanic_venture_says_what_it_does() {
    use volcanic_venture::levels::{Start, level};
    let soft = |index| level(PAPER, false, index);
    let height = |i| {
        let ([low, high], swing) =
            (soft(i).platform_height, if soft(i).waggle { ", swinging" } else { "" });
        if low == high { format!("{low}{swing}") } else { format!("{low} to {high}{swing}") }
    };
    let start = |level: volcanic_venture::levels::Level| match level.start {
        Start::Anywhere => "anywhere",
        Start::Middle => "in the middle",
        Start::Platform => "on a platform",
    };
    for i in 0..3 {
        let [published, tables] = [RELEASED, TABLES].map(|rules| level(rules, false, i));
        assert_eq!((published.change, published.grace_tics), (tables.change, tables.grace_tics));
        assert_eq!(published.start, soft(i).start);
    }
    let lines = [
        by_level("chance of a tile to be a platform", |i| soft(i).platform_chance),
        by_level("height of platforms, map units", height),
        by_level("tics after a change without cost, `paper`", |i| soft(i).grace_tics),
        by_level("tics after a change without cost, `released` and `tables`", |i| {
            level(RELEASED, false, i).grace_tics
        }),
        by_level("agent starts, `paper` and `released`", |i| start(soft(i))),
        by_level("agent starts, `tables`", |i| start(level(TABLES, false, i))),
        by_rules("SPEED among the full actions", |rules| {
            either(level(rules, true, 0).controls.full_speed, "yes", "no")
        }),
        by_level("items at the start", |i| soft(i).start_items),
        by_rules("health points that lava takes, after the first 70 tics", |rules| {
            level(rules, true, 0).lava_damage
        }),
        by_rules("cost of a health point", |rules| level(rules, true, 0).cost_scale),
    ];
    holds(include_str!("volcanic_venture/README.md"), &lines);
    assert!(
        RuleSet::ALL
            .iter()
            .all(|&rules| (0..3).all(|i| level(rules, true, i).start_grace_tics == 70))
    );
}
