//! Experiments that differ in one option: budgets, cost scales, action spaces, observations,
//! curricula, hard constraint.

use super::curves::curve_figure;
use super::main_results::{budget_label, marked_cells, source_of};
use super::unlike::{differing, values_of};
use super::{VARIED, distinct};
use crate::chart::{Bar, BarGroup, Ink, bar_panel, figure};
use crate::document::{Block, Cell, Figure, Section, Table, frames, slug};
use crate::group::{Group, scenario_name};
use crate::published::{Published, published_figure, published_in};
use crate::run::Config;
use std::collections::BTreeMap;

/// A section for each option by which experiments can be compared.
pub(super) fn sections(groups: &[Group]) -> Vec<Section> {
    let all = |_: &Config| true;
    let mut sections: Vec<Section> = vec![
        section(
            groups,
            &Comparison {
                slug: "safety-bounds",
                key: "safety_budget",
                title: "Safety budgets",
                text: "What return a tighter or looser budget leaves. Each budget is drawn over its own bar.",
                counts: &all,
            },
        ),
        section(
            groups,
            &Comparison {
                slug: "cost-scale",
                key: "cost_scale",
                title: "Cost scales",
                text: "PPOCost takes scale x cost off the reward; returns and costs here are the environment's own.",
                counts: &all,
            },
        ),
        section(
            groups,
            &Comparison {
                slug: "curriculum",
                key: "curriculum",
                title: "Curricula",
                text: "Levels one after the other against the last level alone. Curves begin at the first frame of all levels.",
                counts: &all,
            },
        ),
    ];
    for (slug, title, kind, gain) in [
        ("segmentation", "Segmentation", "segmented", "segmentation_return_ratio"),
        ("depth", "Depth", "rgb+depth", "depth_return_ratio"),
    ] {
        let counts = |config: &Config| {
            let observation = config.options.get("observation").map_or("rgb", String::as_str);
            [kind, "rgb"].contains(&observation)
        };
        let percent = published_figure(gain).map_or(0.0, |ratio| (ratio - 1.0) * 100.0);
        let text = format!(
            "Colour against {kind}. The paper reports {percent:.0} % more return, and no values."
        );
        sections.push(section(
            groups,
            &Comparison { slug, key: "observation", title, text: &text, counts: &counts },
        ));
    }
    sections.push(section(
        groups,
        &Comparison {
            slug: "hard",
            key: "hard",
            title: "Hard constraint",
            text: "A violation ends the episode (in Armament Burden it takes the burden and slows the agent) (or costs as the scenario's hard rules say) against the budgeted constraint.",
            counts: &all,
        },
    ));
    sections.push(section(
        groups,
        &Comparison {
            slug: "full-actions",
            key: "full_actions",
            title: "Action spaces",
            text: "The simplified action space against the full one.",
            counts: &all,
        },
    ));
    // Any other option in which some experiments differ and nothing else.
    let mut keys: Vec<String> =
        groups.iter().flat_map(|group| group.shown.keys().cloned()).collect();
    keys.sort();
    keys.dedup();
    keys.retain(|key| !VARIED.contains(&key.as_str()));
    sections.extend(keys.iter().map(|key| {
        let (title, text) = (
            format!("Option {key}"),
            "Experiments that differ in this option; what else they differ in stands beside each.",
        );
        section(groups, &Comparison { slug: &slug(key), key, title: &title, text, counts: &all })
    }));
    sections
}

/// The value of an option as people read it.
fn value_of(config: &Config, key: &str) -> String {
    let option = config.options.get(key).cloned();
    match key {
        "safety_budget" => format!("budget {}", config.safety_budget),
        "cost_scale" => format!("scale {}", config.cost_scale),
        "full_actions" => if option.is_some() { "full" } else { "simplified" }.into(),
        "observation" => option.unwrap_or_else(|| "rgb".into()),
        "curriculum" => option.map_or_else(
            || format!("level {} alone", config.level),
            |levels| format!("levels {levels}"),
        ),
        "hard" => if config.hard() { "hard" } else { "soft" }.into(),
        _ => option.unwrap_or_else(|| "not given".into()),
    }
}

/// For sorting: numbers by size, then words.
fn order_of(config: &Config, key: &str) -> (u64, String) {
    let number = match key {
        "safety_budget" => config.safety_budget,
        "cost_scale" => config.cost_scale,
        _ => f64::from(u8::from(config.options.contains_key(key))),
    };
    (number.max(0.0).to_bits(), value_of(config, key))
}

/// As [`super::main_results::comparable_end`], by the paper's table of this comparison.
fn comparable_end_in(group: &Group, key: &str) -> Option<&'static Published> {
    published_in(group.config(), key).filter(|paper| group.frames_span().1 >= 0.5 * paper.frames())
}

/// What is compared with what.
struct Comparison<'a> {
    /// The paper's name for it.
    slug: &'a str,
    /// The option in which experiments differ.
    key: &'a str,
    title: &'a str,
    text: &'a str,
    /// Which experiments take part.
    counts: &'a dyn Fn(&Config) -> bool,
}

fn section(groups: &[Group], comparison: &Comparison) -> Section {
    let Comparison { key, counts, .. } = *comparison;
    let mut sets: BTreeMap<String, Vec<&Group>> = BTreeMap::new();
    for group in groups {
        let config = group.config();
        if !counts(config) {
            continue;
        }
        // A hard run has no budget of its own to compare, and only PPOCost has a scale.
        if key == "cost_scale" && !config.algo.eq_ignore_ascii_case("PPOCost")
            || key == "safety_budget" && config.hard()
        {
            continue;
        }
        let place = crate::group::scenario_order(&config.scenario);
        let rest = group.options_line(Some(key));
        sets.entry(format!(
            "{place:02} {} {} {} {rest}",
            config.scenario, config.level, config.algo
        ))
        .or_default()
        .push(group);
    }
    let mut rows = Vec::new();
    let mut panels = Vec::new();
    let mut figures = Vec::new();
    for members in sets.values_mut() {
        members.sort_by_key(|group| {
            (order_of(group.config(), key), group.config().frames.unwrap_or(0.0).to_bits())
        });
        if distinct(members, |group| value_of(group.config(), key)).len() < 2 {
            continue;
        }
        let config = members[0].config();
        let rest = members[0].options_line(Some(key));
        let repeated = |group: &Group| {
            members
                .iter()
                .filter(|other| value_of(other.config(), key) == value_of(group.config(), key))
                .count()
                > 1
        };
        let label = |group: &Group| match group.config().frames {
            Some(asked) if repeated(group) => {
                format!("{}, {} frames", value_of(group.config(), key), frames(asked))
            }
            _ => value_of(group.config(), key),
        };
        let unlike = differing(members, key);
        let source = source_of(members);
        let cells = marked_cells(members, source);
        for (group, (return_cell, cost_cell)) in members.iter().zip(cells) {
            let paper = published_in(group.config(), key);
            let theirs = |value: Option<f64>| {
                value.map_or_else(|| Cell::text("-"), |v| Cell { pale: true, ..Cell::number(v) })
            };
            let (_, reached) = group.frames_span();
            rows.push(vec![
                Cell::text(scenario_name(&config.scenario)),
                Cell::number(f64::from(config.level)).with_text(config.level.to_string()),
                Cell::text(&config.algo),
                Cell::text(label(group)),
                Cell::text(&rest),
                Cell::text(values_of(group, &unlike)),
                Cell::number(reached).with_text(frames(reached)),
                Cell::number(group.config().safety_budget).with_text(budget_label(group)),
                return_cell,
                theirs(paper.map(|p| p.episode_return)),
                cost_cell,
                theirs(paper.map(|p| p.cost)),
            ]);
        }
        let name =
            format!("{} level {} {}", scenario_name(&config.scenario), config.level, config.algo);
        for metric in ["return", "cost"] {
            let bars = |(index, group): (usize, &&Group)| {
                let mut bars = Vec::new();
                if let Some(estimate) = group.estimate(source, &format!("{metric}_mean")) {
                    let interval = estimate.half_width.map(|_| (estimate.low(), estimate.high()));
                    bars.push(Bar {
                        name: "here".into(),
                        value: estimate.mean,
                        interval,
                        ink: Ink::Series(index),
                        pale: false,
                    });
                }
                let paper = comparable_end_in(group, key)
                    .map(|p| if metric == "cost" { p.cost } else { p.episode_return });
                bars.extend(paper.map(|value| Bar {
                    name: "paper".into(),
                    value,
                    interval: None,
                    ink: Ink::Series(index),
                    pale: true,
                }));
                let budget = group.config().budget().filter(|_| metric == "cost");
                BarGroup { name: label(group), bars, budget }
            };
            let groups: Vec<BarGroup> = members.iter().enumerate().map(bars).collect();
            panels.push(bar_panel(&format!("{name}: {metric}"), &groups, (390.0, 190.0)));
        }
        let lines: Vec<(String, Ink, &Group)> = members
            .iter()
            .enumerate()
            .map(|(i, group)| (label(group), Ink::Series(i), *group))
            .collect();
        figures.push(Block::Figure(curve_figure(
            &name,
            &slug(&format!("{} {name} {rest}", comparison.slug)),
            &rest,
            &lines,
        )));
    }
    let mut blocks = Vec::new();
    if !rows.is_empty() {
        let heads = [
            "scenario",
            "level",
            "algorithm",
            "varied",
            "other options",
            "differs also in",
            "frames",
            "budget",
            "return",
            "paper",
            "cost",
            "paper",
        ];
        let table = Table { heads: heads.map(String::from).to_vec(), rows, ..Table::default() };
        let folded = ["level", "algorithm", "other options", "differs also in", "budget"];
        blocks.push(Block::Table(table.folded(&folded)));
        let paper = groups
            .iter()
            .any(|group| counts(group.config()) && comparable_end_in(group, key).is_some());
        let budgets =
            groups.iter().any(|group| counts(group.config()) && group.config().budget().is_some());
        let (paper, budgets) = (
            if paper { "Full colour: here; pale: the paper. " } else { "" },
            if budgets { "Dashed: the budget." } else { "" },
        );
        let caption = format!("{paper}{budgets}");
        blocks.push(Block::Figure(Figure {
            slug: format!("{} bars", comparison.slug).replace(' ', "-"),
            caption,
            drawing: figure("", panels, 2, &[]),
        }));
        blocks.extend(figures);
    }
    let (slug, title, text) =
        (comparison.slug.to_owned(), comparison.title.to_owned(), vec![comparison.text.to_owned()]);
    Section { slug, title, text, blocks }
}
